/* HLSL, shader model 5. ${stem}.bin: ${rows} rows of ${columns} float4 (little-endian). Load it as a structured buffer.
   UP_REGISTER, the register of the buffer, may be defined before. */
#define UP_BITS_OF asuint
#define UP_VEC3 float3
#define UP_VEC4 float4
#ifndef UP_REGISTER
#define UP_REGISTER t0
#endif
StructuredBuffer<float4> up_table : register(UP_REGISTER);

float4 up_texel(int index)
{
    return up_table[index];
}

#include "shader.glsl"
${program}
