/* Reflectances of a colour that is located at ${NAME}_WIDTH wavelengths in nm. */
static inline void ${name}_at_wavelengths(
    const float place[4], int entry, const float wavelengths[${NAME}_WIDTH], float reflectances[${NAME}_WIDTH])
{
    float basis[${NAME}_COUNT * ${NAME}_WIDTH], total[${NAME}_WIDTH] = {0};
    ${name}_tabulate(wavelengths, basis);
    ${name}_add_nodes(place, entry, basis, total);
    memcpy(reflectances, total, sizeof total);
}

/* Reflectances of linear RGB at wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
static inline void ${name}_reflectances(
    const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    float place[4];
    int start, entry = ${name}_locate(rgb, place);
    for (start = 0; start + ${NAME}_WIDTH <= count; start += ${NAME}_WIDTH)
        ${name}_at_wavelengths(place, entry, wavelengths + start, reflectances + start);
    if (start < count) {
        float block[${NAME}_WIDTH] = {0}, found[${NAME}_WIDTH];
        memcpy(block, wavelengths + start, (count - start) * sizeof *block);
        ${name}_at_wavelengths(place, entry, block, found);
        memcpy(reflectances + start, found, (count - start) * sizeof *found);
    }
}
