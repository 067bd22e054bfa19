/* Reflectances of linear RGB at wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
static inline void ${name}_reflectances(
    const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    float place[4];
    int start, entry = ${name}_locate(rgb, place);
    for (start = 0; start + ${NAME}_WIDTH <= count; start += ${NAME}_WIDTH)
        ${name}_answer(place, entry, wavelengths + start, reflectances + start);
    if (start < count) {
        float block[${NAME}_WIDTH] = {0}, found[${NAME}_WIDTH];
        memcpy(block, wavelengths + start, (count - start) * sizeof *block);
        ${name}_answer(place, entry, block, found);
        memcpy(reflectances + start, found, (count - start) * sizeof *found);
    }
}

/* The same of n colours, each at count wavelengths of its own. */
static inline void ${name}_reflectances_n(
    const float *rgb, const float *wavelengths, int count, int n, float *reflectances)
{
    int i;
    for (i = 0; i < n; ++i)
        ${name}_reflectances(rgb + 3 * i, wavelengths + (size_t)count * i, count, reflectances + (size_t)count * i);
}
