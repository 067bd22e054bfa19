/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
void ${name}_coefficients(float3 rgb, inout float coefficients[${NAME}_COUNT])
{
    float colour[3];
    float place[4];
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    for (int k = 0; k < 4; ++k) place[k] = 0.0;
    int entry = ${name}_locate(colour, place);
    ${name}_sum_coefficients(place, entry, coefficients);
}
