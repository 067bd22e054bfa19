/* CUDA, and C++ on the host. ${stem}.bin has the ${size} numbers (float32, little-endian) of the table. Its CRC-32 is
   ${checksum}. */
#ifndef UP_UPLIFT_H
#define UP_UPLIFT_H

#include <math.h>

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
#define UP_IN const
#define UP_OUT
#define UP_ARRAY(name, size) float name[size]
#define UP_ROW(name, index) const float *name = table + (index) * UP_STRIDE
#define UP_BOOL int
#define UP_INT(x) ((int)(x))
#define UP_REAL(x) ((float)(x))
#define UP_ABS fabsf
#define UP_SQRT sqrtf
#define UP_TANH tanhf
#define UP_COPYSIGN copysignf
/* Moving a colour takes a few steps in double precision. */
#define UP_FINE double
#define UP_FINES(name, size) double name[size]
#define UP_EXACT(x) ((double)(x))
#define UP_TURN(x) (atan(x) * 0.31830988618379067)
#define UP_SQUARE_ROOT sqrt
#define UP_TINY 1e-18
#define UP_TOLERANCE 1e-7
#define UP_STEPS 60
${constants}

UP_FUNCTION float up_number(const float *table, int index)
{
    return table[index];
}
