/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
fn ${name}_coefficients(rgb: vec3f, coefficients: ptr<function, array<f32, ${NAME}_COUNT>>) {
    var colour = array<f32, 3>(rgb.x, rgb.y, rgb.z);
    var place: array<f32, 4>;
    let entry = ${name}_locate(&colour, &place);
    ${name}_sum_coefficients(&place, entry, coefficients);
}
