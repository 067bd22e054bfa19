/* CUDA, and C++ on the host. ${stem}.bin has the ${size} numbers (float32, little-endian) of the table. Its CRC-32 is
   ${checksum}. On the device it is aligned to 16 bytes, as by cudaMalloc. */
#ifndef UP_UPLIFT_H
#define UP_UPLIFT_H

#include <math.h>
#include <string.h>

#define UP_CAST(type, x) static_cast<type>(x)
#ifndef UP_WIDTH
#define UP_WIDTH ${width}
#endif
#ifdef __CUDACC__
#define UP_FUNCTION static __host__ __device__ inline
#define UP_SELDOM static __host__ __device__ __noinline__
#define UP_EACH _Pragma("unroll")
#else
#define UP_FUNCTION static inline
#define UP_SELDOM UP_FUNCTION
#define UP_EACH
#endif
#define UP_EXPANDED UP_FUNCTION
#define UP_VECTORISE
#define UP_READS const float *table,
#define UP_TABLE table,
${constants}
#include "host.c"

UP_FUNCTION float up_number(const float *table, int index)
{
    return table[index];
}

#define UP_TEXEL up_texel_type
struct up_texel_type {
    float x, y, z, w;
};

UP_FUNCTION up_texel_type up_texel(const float *table, int index)
{
#ifdef __CUDA_ARCH__
    const float4 texel = __ldg(reinterpret_cast<const float4 *>(table) + index);
    return {texel.x, texel.y, texel.z, texel.w};
#else
    up_texel_type texel;
    memcpy(&texel, table + 4 * index, sizeof texel);
    return texel;
#endif
}

${program}
#endif
