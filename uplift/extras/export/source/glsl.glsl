/* GLSL 3.30 and GLSL ES 3.00. ${stem}.bin: ${rows} rows of ${columns} RGBA texels (float32, little-endian). Load it as a
   texture of the format RGBA32F, filter NEAREST. */
#ifdef GL_ES
precision highp float;
precision highp int;
#endif
#define UP_BITS_OF floatBitsToUint
#define UP_VEC3 vec3
#define UP_VEC4 vec4
#define UP_ROW(name, index) float name[UP_STRIDE]; up_load_row(index, name)
uniform highp sampler2D up_table;

vec4 up_texel(int index)
{
    return texelFetch(up_table, ivec2(index % ${columns}, index / ${columns}), 0);
}

#include "shader.glsl"
${program}
