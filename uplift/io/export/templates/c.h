/* A spectral uplifting cube: linear RGB in, reflectances out, in single precision.

   Written by uplift ${version} from the cube ${digest}.
   RGB is linear ${space} under ${illuminant} for the ${observer}; ${entries} atlas entries.
   C99 and C++. The table is static: include this file in one source file. Mode ${mode}.

       float rgb[3] = {0.8f, 0.2f, 0.1f}, wavelengths[4] = {450, 500, 550, 600}, reflectances[4];
       ${name}_reflectances(rgb, wavelengths, 4, reflectances);

   ${name}_reflectances_n takes many colours in one call.
   ${NAME}_WIDTH wavelengths are evaluated at a time. Loops over them vectorise: cc -O3 -march=x86-64-v3.
*/
#ifndef ${NAME}_UPLIFT_CUBE_H
#define ${NAME}_UPLIFT_CUBE_H

#include <math.h>
#include <string.h>

#ifndef ${NAME}_WIDTH
#define ${NAME}_WIDTH 16
#endif
#define ${NAME}_LANES 16
/* Loops over wavelengths and lanes are vectorised, not unrolled. */
#if defined(__clang__)
#define ${NAME}_VECTORISE _Pragma("clang loop vectorize(enable) interleave_count(1)")
#elif defined(__GNUC__)
#define ${NAME}_VECTORISE _Pragma("GCC ivdep") _Pragma("GCC unroll 1")
#else
#define ${NAME}_VECTORISE
#endif
#if defined(__GNUC__)
#define ${NAME}_EXPANDED inline __attribute__((always_inline))
#else
#define ${NAME}_EXPANDED inline
#endif
${constants}

${access}
static inline float ${name}_number(int index)
{
    return ${name}_table[index];
}

static inline float ${name}_tag(int index)
{
    return ${name}_table[index * ${NAME}_STRIDE + ${NAME}_COUNT];
}

static inline void ${name}_load_row(int index, float row[${NAME}_STRIDE])
{
    const float *stored = ${name}_table + index * ${NAME}_STRIDE;
    int k;
    for (k = 0; k < ${NAME}_STRIDE; ++k) row[k] = stored[k];
}

${kernel}
/* Reflectances of multipliers, mixed with those of an entry unless it is negative, at wavelengths in nm. */
static inline void ${name}_mix_all(
    const float multipliers[${NAME}_COUNT], float lattice_weight, int entry, const float *wavelengths, int count,
    float *reflectances)
{
    int start;
    for (start = 0; start + ${NAME}_WIDTH <= count; start += ${NAME}_WIDTH)
        ${name}_mix(multipliers, lattice_weight, entry, wavelengths + start, reflectances + start);
    if (start < count) {
        float block[${NAME}_WIDTH] = {0}, found[${NAME}_WIDTH];
        memcpy(block, wavelengths + start, (count - start) * sizeof *block);
        ${name}_mix(multipliers, lattice_weight, entry, block, found);
        memcpy(reflectances + start, found, (count - start) * sizeof *found);
    }
}

/* Reflectances of stored multipliers at wavelengths in nm. */
static inline void ${name}_evaluate(
    const float multipliers[${NAME}_COUNT], const float *wavelengths, int count, float *reflectances)
{
    ${name}_mix_all(multipliers, 1, -1, wavelengths, count, reflectances);
}

${wrappers}
#endif
