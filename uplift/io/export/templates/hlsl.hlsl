/* A spectral uplifting cube: linear RGB in, reflectances out, in single precision.

   Written by uplift ${version} from the cube ${digest}.
   RGB is linear ${space} under ${illuminant} for the ${observer}; ${entries} atlas entries. Mode ${mode}.
   HLSL, shader model 5. The comment on the table below states how to load it.

       float4 reflectances = ${name}_reflectances(float3(0.8, 0.2, 0.1), float4(450, 500, 550, 600));
*/
#define ${NAME}_WIDTH 4
${constants}

${access}
${kernel}
/* Reflectances of stored multipliers at four wavelengths in nm. */
float4 ${name}_evaluate(float multipliers[${NAME}_COUNT], float4 wavelengths)
{
    float lanes[4];
    float basis[${NAME}_COUNT * 4];
    float total[4];
    for (int w = 0; w < 4; ++w) { lanes[w] = wavelengths[w]; total[w] = 0.0; }
    for (int k = 0; k < ${NAME}_COUNT * 4; ++k) basis[k] = 0.0;
    ${name}_tabulate(lanes, basis);
    ${name}_evaluate_block(multipliers, basis, total);
    return float4(total[0], total[1], total[2], total[3]);
}

/* Reflectances of linear RGB at four wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
float4 ${name}_reflectances(float3 rgb, float4 wavelengths)
{
    float colour[3];
    float place[4];
    float lanes[4];
    float total[4];
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    for (int w = 0; w < 4; ++w) { lanes[w] = wavelengths[w]; total[w] = 0.0; place[w] = 0.0; }
    int entry = ${name}_locate(colour, place);
    ${name}_answer(place, entry, lanes, total);
    return float4(total[0], total[1], total[2], total[3]);
}

${wrappers}