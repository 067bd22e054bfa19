/* GLSL 3.30 and GLSL ES 3.00, and GLSL 4.50 for Vulkan, where UP_SET and UP_BINDING may be defined before. ${stem}.bin:
   ${rows} rows of ${columns} RGBA texels (float32, little-endian). Load it as a texture of the format RGBA32F, filter
   NEAREST. */
#ifdef GL_ES
precision highp float;
precision highp int;
#endif
#define UP_BITS_OF floatBitsToUint
#define UP_VEC3 vec3
#define UP_VEC4 vec4
#ifdef VULKAN
#ifndef UP_SET
#define UP_SET 0
#endif
#ifndef UP_BINDING
#define UP_BINDING 0
#endif
layout(set = UP_SET, binding = UP_BINDING)
#endif
uniform highp sampler2D up_table;

vec4 up_texel(int index)
{
    return texelFetch(up_table, ivec2(index % ${columns}, index / ${columns}), 0);
}

#include "shader.glsl"
${program}
