/* A spectral uplifting cube: linear RGB in, reflectances out, in single precision.

   Written by uplift ${version} from the cube ${digest}.
   RGB is linear ${space} under ${illuminant} for the ${observer}; ${entries} atlas entries. Mode ${mode}.
   CUDA, and C++ on the host. ${stem}.bin has the ${size} numbers (float32, little-endian) of the table. Its CRC-32
   is ${checksum}.

       float rgb[3] = {0.8f, 0.2f, 0.1f}, wavelengths[${NAME}_WIDTH] = {450, 500, 550, 600}, found[${NAME}_WIDTH];
       ${name}_reflectances(table, rgb, wavelengths, found);
*/
#ifndef ${NAME}_UPLIFT_CUBE_H
#define ${NAME}_UPLIFT_CUBE_H

#include <math.h>

#ifdef __CUDACC__
#define ${NAME}_FUNCTION static __host__ __device__ inline
#else
#define ${NAME}_FUNCTION static inline
#endif
#ifndef ${NAME}_WIDTH
#define ${NAME}_WIDTH 4
#endif
${constants}

${access}
${kernel}
/* Reflectances of stored multipliers at wavelengths in nm. */
${NAME}_FUNCTION void ${name}_evaluate(
    const float multipliers[${NAME}_COUNT], const float wavelengths[${NAME}_WIDTH], float reflectances[${NAME}_WIDTH])
{
    float basis[${NAME}_COUNT * ${NAME}_WIDTH];
    ${name}_tabulate(wavelengths, basis);
    ${name}_evaluate_block(multipliers, basis, reflectances);
}

/* Reflectances of linear RGB at wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
${NAME}_FUNCTION void ${name}_reflectances(
    const float *table, const float rgb[3], const float wavelengths[${NAME}_WIDTH], float reflectances[${NAME}_WIDTH])
{
    float place[4];
    int entry = ${name}_locate(table, rgb, place);
    ${name}_answer(table, place, entry, wavelengths, reflectances);
}

${wrappers}
#endif
