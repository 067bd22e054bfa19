/* A spectral uplifting table of lights: linear RGB of any brightness in, spectral power out, in single precision.

   Written by uplift ${version} from the table ${digest}.
   RGB is linear ${space} for the ${observer}; ${lamps} lamps. Power 1 at all wavelengths has luminance 1, as has RGB (1, 1, 1).

   ${overview} */
