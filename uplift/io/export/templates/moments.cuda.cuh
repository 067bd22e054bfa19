/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
${NAME}_FUNCTION void ${name}_coefficients(const float *table, const float rgb[3], float coefficients[${NAME}_COUNT])
{
    float place[4];
    int entry = ${name}_locate(table, rgb, place);
    ${name}_sum_coefficients(table, place, entry, coefficients);
}
