
float ${name}_tag(int index)
{
    return ${name}_number(index * ${NAME}_STRIDE + ${NAME}_COUNT);
}

void ${name}_load_row(int index, inout float row[${NAME}_STRIDE])
{
    for (int t = 0; t < ${texels}; ++t) {
        vec4 texel = ${name}_texel(index * ${texels} + t);
        for (int c = 0; c < 4; ++c) row[4 * t + c] = texel[c];
    }
}
