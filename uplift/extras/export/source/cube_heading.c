/* A spectral uplifting cube: linear RGB in, reflectances out, in single precision.

   Written by uplift ${version} from the cube ${digest}.
   RGB is linear ${space} under ${illuminant} for the ${observer}; ${entries} atlas entries. Mode ${mode}.

   ${overview} */
