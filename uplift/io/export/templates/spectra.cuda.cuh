/* Reflectances of linear RGB at wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
${NAME}_FUNCTION void ${name}_reflectances(
    const float *table, const float rgb[3], const float wavelengths[${NAME}_WIDTH], float reflectances[${NAME}_WIDTH])
{
    float basis[${NAME}_COUNT * ${NAME}_WIDTH], place[4];
    int entry = ${name}_locate(table, rgb, place);
    ${name}_tabulate(wavelengths, basis);
    for (int w = 0; w < ${NAME}_WIDTH; ++w) reflectances[w] = 0;
    ${name}_add_nodes(table, place, entry, basis, reflectances);
}
