/* HLSL, shader model 5. ${stem}.bin: ${rows} rows of ${columns} float4 (little-endian). Load it as a structured buffer. */
#define UP_BITS_OF asuint
#define UP_VEC3 float3
#define UP_VEC4 float4
#define UP_ROW(name, index) UP_ARRAY(name, UP_STRIDE); up_load_row(index, name)
StructuredBuffer<float4> up_table : register(t0);

float4 up_texel(int index)
{
    return up_table[index];
}

#include "shader.glsl"
${program}
