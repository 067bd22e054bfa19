/* A spectral uplifting table of lights: linear RGB of any brightness in, spectral power out, in single precision.

   Written by uplift ${version} from the table ${digest}.
   RGB is linear ${space} for the ${observer}; ${lamps} lamps. Power 1 at all wavelengths has luminance 1, as has RGB (1, 1, 1).
   C99 and C++. The table is static: include this file in one source file.

       float rgb[3] = {8000.0f, 5000.0f, 900.0f}, wavelengths[4] = {450, 500, 550, 600}, power[4];
       ${name}_power(rgb, wavelengths, 4, power);
*/
#ifndef ${NAME}_UPLIFT_LIGHTS_H
#define ${NAME}_UPLIFT_LIGHTS_H

#include <math.h>
#include <string.h>

#ifndef ${NAME}_WIDTH
#define ${NAME}_WIDTH 4
#endif
#define ${NAME}_VECTORISE
${constants}

${access}
static inline float ${name}_number(int index)
{
    return ${name}_table[index];
}

${kernel}
/* Power of linear RGB at wavelengths in nm; its colour is exactly this RGB. Colours that no light has move towards
   white of the same luminance. */
static inline void ${name}_power(const float rgb[3], const float *wavelengths, int count, float *power)
{
    float spot[5];
    int start, corner = ${name}_locate(rgb, spot);
    for (start = 0; start + ${NAME}_WIDTH <= count; start += ${NAME}_WIDTH)
        ${name}_answer(spot, corner, wavelengths + start, power + start);
    if (start < count) {
        float block[${NAME}_WIDTH] = {0}, found[${NAME}_WIDTH];
        memcpy(block, wavelengths + start, (count - start) * sizeof *block);
        ${name}_answer(spot, corner, block, found);
        memcpy(power + start, found, (count - start) * sizeof *found);
    }
}

#endif
