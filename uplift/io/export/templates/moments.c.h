/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
static inline void ${name}_coefficients(const float rgb[3], float coefficients[${NAME}_COUNT])
{
    float place[4];
    int entry = ${name}_locate(rgb, place);
    ${name}_sum_coefficients(place, entry, coefficients);
}

/* Multipliers of coefficients, once per texel. Returns 0 for numbers that are the coefficients of no spectrum. */
static inline int ${name}_multipliers(
    const float coefficients[${NAME}_COUNT], float multipliers[${NAME}_COUNT])
{
    return ${name}_multipliers_of(coefficients, multipliers);
}
