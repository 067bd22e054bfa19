/* Reflectances of linear RGB at four wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
fn ${name}_reflectances(rgb: vec3f, wavelengths: vec4f) -> vec4f {
    var colour = array<f32, 3>(rgb.x, rgb.y, rgb.z);
    var lanes = array<f32, 4>(wavelengths.x, wavelengths.y, wavelengths.z, wavelengths.w);
    var place: array<f32, 4>;
    var total: array<f32, 4>;
    var basis: array<f32, (${NAME}_COUNT * ${NAME}_WIDTH)>;
    let entry = ${name}_locate(&colour, &place);
    ${name}_tabulate(&lanes, &basis);
    ${name}_add_nodes(&place, entry, &basis, &total);
    return vec4f(total[0], total[1], total[2], total[3]);
}
