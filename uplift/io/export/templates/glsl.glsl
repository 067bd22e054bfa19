/* A spectral uplifting cube: linear RGB in, reflectances out, in single precision.

   Written by uplift ${version} from the cube ${digest}.
   RGB is linear ${space} under ${illuminant} for the ${observer}; ${entries} atlas entries. Mode ${mode}.
   GLSL 3.30 and GLSL ES 3.00. The comment on the table below states how to load it.

       vec4 reflectances = ${name}_reflectances(vec3(0.8, 0.2, 0.1), vec4(450.0, 500.0, 550.0, 600.0));
*/
#ifdef GL_ES
precision highp float;
precision highp int;
#endif
#define ${NAME}_WIDTH 4
${constants}

${access}
${kernel}
/* Reflectances of stored multipliers at four wavelengths in nm. */
vec4 ${name}_evaluate(float multipliers[${NAME}_COUNT], vec4 wavelengths)
{
    float lanes[4];
    float basis[${NAME}_COUNT * 4];
    float total[4];
    for (int w = 0; w < 4; ++w) { lanes[w] = wavelengths[w]; total[w] = 0.0; }
    for (int k = 0; k < ${NAME}_COUNT * 4; ++k) basis[k] = 0.0;
    ${name}_tabulate(lanes, basis);
    ${name}_evaluate_block(multipliers, basis, total);
    return vec4(total[0], total[1], total[2], total[3]);
}

/* Reflectances of linear RGB at four wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
vec4 ${name}_reflectances(vec3 rgb, vec4 wavelengths)
{
    float colour[3];
    float place[4];
    float lanes[4];
    float total[4];
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    for (int w = 0; w < 4; ++w) { lanes[w] = wavelengths[w]; total[w] = 0.0; place[w] = 0.0; }
    int entry = ${name}_locate(colour, place);
    ${name}_answer(place, entry, lanes, total);
    return vec4(total[0], total[1], total[2], total[3]);
}

${wrappers}