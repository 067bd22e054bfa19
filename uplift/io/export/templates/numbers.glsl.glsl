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
