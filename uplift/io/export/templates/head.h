/* A spectral uplifting cube: linear RGB in, reflectance spectra out.

   Written by uplift ${version} from the cube ${digest}.
   RGB is linear ${space} under ${illuminant} for the ${observer}; ${entries} atlas entries.
   C99 and C++. The tables are static: include it in one source file.

       double coefficients[${NAME}_COEFFICIENTS], multipliers[${NAME}_COEFFICIENTS], rgb[3] = {0.8, 0.2, 0.1};
       ${name}_fetch(rgb, coefficients);               linear in the spectrum: can be filtered and averaged
       ${name}_multipliers(coefficients, multipliers); once per colour
       ${name}_evaluate(multipliers, 550.0);           reflectance in [0, 1] at a wavelength in nm
*/
#ifndef ${NAME}_UPLIFT_CUBE_H
#define ${NAME}_UPLIFT_CUBE_H

#include <math.h>

#define ${NAME}_DIM ${dim}
#define ${NAME}_COEFFICIENTS ${count}

