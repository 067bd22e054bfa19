/* Reflectances of linear RGB at four wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
vec4 ${name}_reflectances(vec3 rgb, vec4 wavelengths)
{
    float colour[3];
    float place[4];
    float lanes[4];
    float total[4];
    float basis[${NAME}_COUNT * 4];
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    for (int w = 0; w < 4; ++w) { lanes[w] = wavelengths[w]; total[w] = 0.0; place[w] = 0.0; }
    for (int k = 0; k < ${NAME}_COUNT * 4; ++k) basis[k] = 0.0;
    int entry = ${name}_locate(colour, place);
    ${name}_tabulate(lanes, basis);
    ${name}_add_nodes(place, entry, basis, total);
    return vec4(total[0], total[1], total[2], total[3]);
}
