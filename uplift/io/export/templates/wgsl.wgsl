/* A spectral uplifting cube: linear RGB in, reflectances out, in single precision.

   Written by uplift ${version} from the cube ${digest}.
   RGB is linear ${space} under ${illuminant} for the ${observer}; ${entries} atlas entries. Mode ${mode}.
   WGSL. The comment on the table below states how to load it.

       let reflectances = ${name}_reflectances(vec3f(0.8, 0.2, 0.1), vec4f(450, 500, 550, 600));
*/
const ${NAME}_WIDTH: i32 = 4;
${constants}

${access}
${kernel}
/* Reflectances of stored multipliers at four wavelengths in nm. */
fn ${name}_evaluate(multipliers: ptr<function, array<f32, ${NAME}_COUNT>>, wavelengths: vec4f) -> vec4f {
    var lanes = array<f32, 4>(wavelengths.x, wavelengths.y, wavelengths.z, wavelengths.w);
    var basis: array<f32, (${NAME}_COUNT * ${NAME}_WIDTH)>;
    var total: array<f32, 4>;
    ${name}_tabulate(&lanes, &basis);
    ${name}_evaluate_block(multipliers, &basis, &total);
    return vec4f(total[0], total[1], total[2], total[3]);
}

/* Reflectances of linear RGB at four wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
fn ${name}_reflectances(rgb: vec3f, wavelengths: vec4f) -> vec4f {
    var colour = array<f32, 3>(rgb.x, rgb.y, rgb.z);
    var lanes = array<f32, 4>(wavelengths.x, wavelengths.y, wavelengths.z, wavelengths.w);
    var place: array<f32, 4>;
    var total: array<f32, 4>;
    let entry = ${name}_locate(&colour, &place);
    ${name}_answer(&place, entry, &lanes, &total);
    return vec4f(total[0], total[1], total[2], total[3]);
}

${wrappers}