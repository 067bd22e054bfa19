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

/* Multipliers of the coefficients of up to ${NAME}_LANES colours, in one pass. Returns how many have no spectrum. */
static inline int ${name}_multipliers_of_lanes(const float *coefficients, int colours, float *multipliers)
{
    float given[${NAME}_COUNT * ${NAME}_LANES] = {0}, found[${NAME}_COUNT * ${NAME}_LANES], valid[${NAME}_LANES];
    int lane, k, failed = 0;
    for (lane = 0; lane < colours; ++lane)
        for (k = 0; k < ${NAME}_COUNT; ++k) given[${NAME}_LANES * k + lane] = coefficients[${NAME}_COUNT * lane + k];
    ${name}_duals(given, found, valid);
    for (lane = 0; lane < colours; ++lane) {
        float *own = multipliers + ${NAME}_COUNT * lane;
        if (valid[lane] > 0)
            for (k = 0; k < ${NAME}_COUNT; ++k) own[k] = found[${NAME}_LANES * k + lane];
        else
            failed += !${name}_multipliers_of(coefficients + ${NAME}_COUNT * lane, own);
    }
    return failed;
}

/* Multipliers of the coefficients of n colours: faster than one by one. Returns how many have no spectrum. */
static inline int ${name}_multipliers_n(const float *coefficients, int n, float *multipliers)
{
    int start, failed = 0;
    for (start = 0; start < n; start += ${NAME}_LANES) {
        size_t first = (size_t)${NAME}_COUNT * start;
        int colours = n - start < ${NAME}_LANES ? n - start : ${NAME}_LANES;
        failed += ${name}_multipliers_of_lanes(coefficients + first, colours, multipliers + first);
    }
    return failed;
}

/* Reflectances of linear RGB at wavelengths in nm; their colour is this RGB, approximately. Clips RGB to [0, 1]. */
static inline void ${name}_reflectances(
    const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    float place[4], coefficients[${NAME}_COUNT], multipliers[${NAME}_COUNT];
    int entry = ${name}_locate(rgb, place);
    ${name}_sum_nodes(place, coefficients);
    ${name}_multipliers_of(coefficients, multipliers);
    ${name}_mix_all(multipliers, place[3], entry, wavelengths, count, reflectances);
}

/* The same of n colours, each at count wavelengths of its own: faster than one by one. */
static inline void ${name}_reflectances_n(
    const float *rgb, const float *wavelengths, int count, int n, float *reflectances)
{
    int start, lane;
    for (start = 0; start < n; start += ${NAME}_LANES) {
        float places[4 * ${NAME}_LANES], numbers[${NAME}_COUNT * ${NAME}_LANES], multipliers[${NAME}_COUNT * ${NAME}_LANES];
        int entries[${NAME}_LANES], colours = n - start < ${NAME}_LANES ? n - start : ${NAME}_LANES;
        for (lane = 0; lane < colours; ++lane) {
            entries[lane] = ${name}_locate(rgb + 3 * (start + lane), places + 4 * lane);
            ${name}_sum_nodes(places + 4 * lane, numbers + ${NAME}_COUNT * lane);
        }
        ${name}_multipliers_of_lanes(numbers, colours, multipliers);
        for (lane = 0; lane < colours; ++lane) {
            size_t first = (size_t)count * (start + lane);
            ${name}_mix_all(
                multipliers + ${NAME}_COUNT * lane, places[4 * lane + 3], entries[lane], wavelengths + first, count,
                reflectances + first);
        }
    }
}
