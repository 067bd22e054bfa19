/* ${stem}.bin: ${rows} rows of ${columns} RGBA texels (float32, little-endian). Load it as a texture of the format RGBA32F,
   filter NEAREST. */
uniform highp sampler2D ${name}_table;

vec4 ${name}_texel(int index)
{
    return texelFetch(${name}_table, ivec2(index % ${columns}, index / ${columns}), 0);
}

float ${name}_number(int index)
{
    return ${name}_texel(index / 4)[index % 4];
}

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
