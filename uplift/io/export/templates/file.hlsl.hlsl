/* ${stem}.bin: ${rows} rows of ${columns} float4 (little-endian). Load it as a structured buffer. */
StructuredBuffer<float4> ${name}_table : register(t0);

float4 ${name}_texel(int index)
{
    return ${name}_table[index];
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
        float4 texel = ${name}_texel(index * ${texels} + t);
        for (int c = 0; c < 4; ++c) row[4 * t + c] = texel[c];
    }
}
