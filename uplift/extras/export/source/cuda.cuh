/* CUDA, and C++ on the host. ${stem}.bin has the ${size} numbers (float32, little-endian) of the table. Its CRC-32 is
   ${checksum}. */
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
#else
#define UP_FUNCTION static inline
#endif
#define UP_EXPANDED UP_FUNCTION
#define UP_VECTORISE
#define UP_READS const float *table,
#define UP_TABLE table,
#define UP_ROW(name, index) const float *name = table + (index) * UP_STRIDE
${constants}

UP_FUNCTION float up_number(const float *table, int index)
{
    return table[index];
}
#include "host.c"
${program}
#endif
