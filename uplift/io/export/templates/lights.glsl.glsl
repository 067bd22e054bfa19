/* A spectral uplifting table of lights: linear RGB of any brightness in, spectral power out, in single precision.

   Written by uplift ${version} from the table ${digest}.
   RGB is linear ${space} for the ${observer}; ${lamps} lamps. Power 1 at all wavelengths has luminance 1, as has RGB (1, 1, 1).
   GLSL 3.30 and GLSL ES 3.00. The comment on the table below states how to load it.

       vec4 power = ${name}_power(vec3(8000.0, 5000.0, 900.0), vec4(450.0, 500.0, 550.0, 600.0));
*/
#ifdef GL_ES
precision highp float;
precision highp int;
#endif
#define ${NAME}_WIDTH 4
${constants}

${access}
${kernel}
/* Power of linear RGB at four wavelengths in nm; its colour is exactly this RGB. Colours that no light has move towards
   white of the same luminance. */
vec4 ${name}_power(vec3 rgb, vec4 wavelengths)
{
    float colour[3];
    float spot[5];
    float lanes[4];
    float total[4];
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    for (int k = 0; k < 5; ++k) spot[k] = 0.0;
    for (int w = 0; w < 4; ++w) { lanes[w] = wavelengths[w]; total[w] = 0.0; }
    int corner = ${name}_locate(colour, spot);
    ${name}_answer(spot, corner, lanes, total);
    return vec4(total[0], total[1], total[2], total[3]);
}
