/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
${NAME}_FUNCTION void ${name}_coefficients(const float *table, const float rgb[3], float coefficients[${NAME}_COUNT])
{
    float place[4];
    int entry = ${name}_locate(table, rgb, place);
    ${name}_sum_coefficients(table, place, entry, coefficients);
}

/* Reflectances of linear RGB at wavelengths in nm. */
${NAME}_FUNCTION void ${name}_reflectances(
    const float *table, const float rgb[3], const float wavelengths[${NAME}_WIDTH], float reflectances[${NAME}_WIDTH])
{
    float coefficients[${NAME}_COUNT], multipliers[${NAME}_COUNT];
    ${name}_coefficients(table, rgb, coefficients);
    ${name}_multipliers_of(coefficients, multipliers);
    ${name}_evaluate(multipliers, wavelengths, reflectances);
}
