/* float rgb[3] = {0.8f, 0.2f, 0.1f}, wavelengths[4] = {450, 500, 550, 600}, reflectances[4];
   up_reflectances(rgb, wavelengths, 4, reflectances);

   Functions and the sizes of their arrays, which are of float; numbers of a colour follow those of the one before:

   up_reflectances(rgb[3], wavelengths[count], count, reflectances[count])
   up_reflectances_n(rgb[n * 3], n, wavelengths[count], count, reflectances[n * count])
   up_evaluate(multipliers[UP_COUNT], wavelengths[count], count, reflectances[count])
   up_tabulate(wavelengths[UP_WIDTH], basis[UP_COUNT * UP_WIDTH])
   up_evaluate_block(multipliers[UP_COUNT], basis[UP_COUNT * UP_WIDTH], reflectances[UP_WIDTH])

   in mode moments also

   up_coefficients(rgb[3], coefficients[UP_COUNT])
   up_multipliers(coefficients[UP_COUNT], multipliers[UP_COUNT])
   up_multipliers_n(coefficients[n * UP_COUNT], n, multipliers[n * UP_COUNT])

   and up_load(path) before all others, if the numbers are in a file. */
/* Reflectances of the multipliers of a place, mixed with those of an entry unless it is negative, at wavelengths in nm. */
UP_FUNCTION void up_mix_all(
    UP_READS_CUBE const float multipliers[UP_COUNT], const float place[UP_PLACE], int entry, const float *wavelengths, int count,
    float *reflectances)
{
    int start;
    for (start = 0; start + UP_WIDTH <= count; start += UP_WIDTH) {
        up_mix(UP_CUBE multipliers, place[3], entry, wavelengths + start, reflectances + start);
#if UP_INEXACT
        up_move(UP_CUBE place, wavelengths + start, reflectances + start);
#endif
    }
    if (start < count) {
        float block[UP_WIDTH] = {0}, found[UP_WIDTH];
        memcpy(block, wavelengths + start, UP_CAST(size_t, count - start) * sizeof *block);
        up_mix(UP_CUBE multipliers, place[3], entry, block, found);
#if UP_INEXACT
        up_move(UP_CUBE place, block, found);
#endif
        memcpy(reflectances + start, found, UP_CAST(size_t, count - start) * sizeof *found);
    }
}

/* Reflectances of stored multipliers at wavelengths in nm. */
UP_FUNCTION void up_evaluate(
    UP_READS_CUBE const float multipliers[UP_COUNT], const float *wavelengths, int count, float *reflectances)
{
    const float place[UP_PLACE] = {0, 0, 0, 1};
    up_mix_all(UP_CUBE multipliers, place, -1, wavelengths, count, reflectances);
}

#if UP_SPECTRA

/* Reflectances of linear RGB at wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
UP_FUNCTION void up_reflectances(UP_READS_CUBE const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    float place[UP_PLACE];
    int start, entry = up_find(UP_CUBE rgb, place);
    for (start = 0; start + UP_WIDTH <= count; start += UP_WIDTH)
        up_answer(UP_CUBE place, entry, wavelengths + start, reflectances + start);
    if (start < count) {
        float block[UP_WIDTH] = {0}, found[UP_WIDTH];
        memcpy(block, wavelengths + start, UP_CAST(size_t, count - start) * sizeof *block);
        up_answer(UP_CUBE place, entry, block, found);
        memcpy(reflectances + start, found, UP_CAST(size_t, count - start) * sizeof *found);
    }
}

/* The same of n colours at the same wavelengths. */
UP_FUNCTION void up_reflectances_n(
    UP_READS_CUBE const float *rgb, int n, const float *wavelengths, int count, float *reflectances)
{
    for (int i = 0; i < n; ++i, rgb += 3, reflectances += count) up_reflectances(UP_CUBE rgb, wavelengths, count, reflectances);
}

#else

/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
UP_FUNCTION void up_coefficients(const float rgb[3], float coefficients[UP_COUNT])
{
    float place[UP_PLACE];
    int entry = up_locate(UP_CUBE rgb, place);
    up_sum_coefficients(UP_CUBE place, entry, coefficients);
}

/* Multipliers of coefficients, once per texel. Returns 0 for numbers that are the coefficients of no spectrum. */
UP_FUNCTION int up_multipliers(const float coefficients[UP_COUNT], float multipliers[UP_COUNT])
{
    return up_multipliers_of(coefficients, multipliers);
}

/* Multipliers of UP_LANES colours side by side, in the lanes of vector registers: moment k of colour i is
   moments[k * UP_LANES + i]; `valid` is 0 where the algorithm breaks down. */
UP_FUNCTION void up_duals(
    const float moments[UP_COUNT * UP_LANES], float multipliers[UP_COUNT * UP_LANES], float valid[UP_LANES])
{
    UP_VECTORISE
    for (int lane = 0; lane < UP_LANES; ++lane) {
        float given[UP_COUNT], found[UP_COUNT];
        UP_UNROLL
        for (int k = 0; k < UP_COUNT; ++k) given[k] = moments[k * UP_LANES + lane];
        valid[lane] = up_dual(given, found) ? 1.0f : 0.0f;
        UP_UNROLL
        for (int k = 0; k < UP_COUNT; ++k) multipliers[k * UP_LANES + lane] = found[k];
    }
}

/* Multipliers of the coefficients of up to UP_LANES colours, in one pass. Returns how many have no spectrum. */
UP_FUNCTION int up_multipliers_of_lanes(const float *coefficients, int colours, float *multipliers)
{
    float given[UP_COUNT * UP_LANES] = {0}, found[UP_COUNT * UP_LANES], valid[UP_LANES];
    int failed = 0;
    for (int lane = 0; lane < colours; ++lane)
        for (int k = 0; k < UP_COUNT; ++k) given[UP_LANES * k + lane] = coefficients[UP_COUNT * lane + k];
    up_duals(given, found, valid);
    for (int lane = 0; lane < colours; ++lane) {
        float *own = multipliers + UP_COUNT * lane;
        if (valid[lane] > 0)
            for (int k = 0; k < UP_COUNT; ++k) own[k] = found[UP_LANES * k + lane];
        else
            failed += !up_multipliers_of(coefficients + UP_COUNT * lane, own);
    }
    return failed;
}

/* Multipliers of the coefficients of n colours: faster than one by one. Returns how many have no spectrum. */
UP_FUNCTION int up_multipliers_n(const float *coefficients, int n, float *multipliers)
{
    int failed = 0;
    for (; n > 0; n -= UP_LANES, coefficients += UP_COUNT * UP_LANES, multipliers += UP_COUNT * UP_LANES)
        failed += up_multipliers_of_lanes(coefficients, n < UP_LANES ? n : UP_LANES, multipliers);
    return failed;
}

/* Reflectances of linear RGB at wavelengths in nm; their colour is this RGB, approximately. Clips RGB to [0, 1]. */
UP_FUNCTION void up_reflectances(UP_READS_CUBE const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    float place[UP_PLACE], coefficients[UP_COUNT], multipliers[UP_COUNT];
    int entry = up_find(UP_CUBE rgb, place);
    up_sum_nodes(UP_CUBE place, coefficients);
    up_multipliers_of(coefficients, multipliers);
    up_mix_all(UP_CUBE multipliers, place, entry, wavelengths, count, reflectances);
}

/* The same of n colours at the same wavelengths: faster than one by one. */
UP_FUNCTION void up_reflectances_n(
    UP_READS_CUBE const float *rgb, int n, const float *wavelengths, int count, float *reflectances)
{
    for (; n > 0; n -= UP_LANES) {
        float places[UP_PLACE * UP_LANES], numbers[UP_COUNT * UP_LANES], multipliers[UP_COUNT * UP_LANES];
        int entries[UP_LANES], colours = n < UP_LANES ? n : UP_LANES;
        for (int lane = 0; lane < colours; ++lane, rgb += 3) {
            entries[lane] = up_find(UP_CUBE rgb, places + UP_PLACE * lane);
            up_sum_nodes(UP_CUBE places + UP_PLACE * lane, numbers + UP_COUNT * lane);
        }
        up_multipliers_of_lanes(numbers, colours, multipliers);
        for (int lane = 0; lane < colours; ++lane, reflectances += count)
            up_mix_all(
                UP_CUBE multipliers + UP_COUNT * lane, places + UP_PLACE * lane, entries[lane], wavelengths, count, reflectances);
    }
}

#endif
