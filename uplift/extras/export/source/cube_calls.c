/* float rgb[3] = {0.8f, 0.2f, 0.1f}, wavelengths[4] = {450, 500, 550, 600}, reflectances[4];
   up_reflectances(rgb, wavelengths, 4, reflectances);

   Functions and the sizes of their arrays, which are of float; numbers of a colour follow those of the one before:

   up_reflectances(rgb[3], wavelengths[count], count, reflectances[count])
   up_reflectances_n(rgb[n * 3], n, wavelengths[count], count, reflectances[n * count])
   up_evaluate(multipliers[UP_COUNT], wavelengths[count], count, reflectances[count])

   in mode moments also

   up_coefficients(rgb[3], coefficients[UP_COUNT])
   up_multipliers(coefficients[UP_COUNT], multipliers[UP_COUNT])
   up_multipliers_n(coefficients[n * UP_COUNT], n, multipliers[n * UP_COUNT])

   and up_load(path) before all others, if the numbers are in a file. */
/* Tabulate powers at up to `width` wavelengths in nm; `width` is a constant where this is expanded. */
UP_EXPANDED void up_tabulate_block(UP_READS_CUBE const float *wavelengths, int count, int width, float *basis)
{
    float padded[UP_WIDTH];
    if (count < width || UP_WARPED != 0) {
        for (int w = 0; w < width; ++w) padded[w] = w < count ? up_warp(UP_CUBE wavelengths[w]) : 0.0f;
        wavelengths = padded;
    }
    UP_VECTORISE
    for (int w = 0; w < width; ++w) up_powers(up_abscissa(UP_CUBE wavelengths[w]), w, width, basis);
}

/* Write the reflectances of a block. */
UP_EXPANDED void up_write(const float total[UP_WIDTH], int count, int width, float *reflectances)
{
    if (count >= width) memcpy(reflectances, total, UP_CAST(size_t, width) * sizeof *total);
    else memcpy(reflectances, total, UP_CAST(size_t, count) * sizeof *total);
}

/* Tabulate powers at up to UP_CHUNK wavelengths, in wide blocks, the last few in narrow ones; return how many they are. */
UP_FUNCTION int up_tabulate(UP_READS_CUBE const float *wavelengths, int count, float basis[UP_COUNT * UP_CHUNK])
{
    int some = count < UP_CHUNK ? count : UP_CHUNK, at = 0;
    for (; some - at > UP_NARROW; at += UP_WIDTH)
        up_tabulate_block(UP_CUBE wavelengths + at, some - at, UP_WIDTH, basis + UP_COUNT * at);
    for (; at < some; at += UP_NARROW)
        up_tabulate_block(UP_CUBE wavelengths + at, some - at, UP_NARROW, basis + UP_COUNT * at);
    return some;
}

/* Reflectances of a colour that is found at up to `width` tabulated wavelengths. */
UP_EXPANDED void up_answer_block(
    UP_READS_CUBE UP_IN UP_SHAPE(shape), const float place[UP_PLACE], int entry, const float *wavelengths, int count, int width,
    const float *basis, float *reflectances)
{
    float total[UP_WIDTH];
    up_blend(UP_CUBE shape, place, entry, basis, width, total);
#if UP_INEXACT
    if (place[8] > 0.0f)
        for (int w = 0; w < count && w < width; ++w) total[w] = up_move(UP_CUBE place, wavelengths[w], total[w]);
#else
    UP_CAST(void, wavelengths);
#endif
    up_write(total, count, width, reflectances);
}

/* Reflectances of a colour that is found at all tabulated wavelengths. */
UP_FUNCTION void up_answer_all(
    UP_READS_CUBE UP_IN UP_SHAPE(shape), const float place[UP_PLACE], int entry, const float *wavelengths, int count,
    const float *basis, float *reflectances)
{
    int at = 0;
    for (; count - at > UP_NARROW; at += UP_WIDTH)
        up_answer_block(
            UP_CUBE shape, place, entry, wavelengths + at, count - at, UP_WIDTH, basis + UP_COUNT * at, reflectances + at);
    for (; at < count; at += UP_NARROW)
        up_answer_block(
            UP_CUBE shape, place, entry, wavelengths + at, count - at, UP_NARROW, basis + UP_COUNT * at, reflectances + at);
}

/* Reflectances of multipliers at up to `width` wavelengths. */
UP_EXPANDED void up_evaluate_block(
    UP_READS_CUBE const float multipliers[UP_COUNT], const float *wavelengths, int count, int width, float *reflectances)
{
    float basis[UP_COUNT * UP_WIDTH], total[UP_WIDTH];
    up_tabulate_block(UP_CUBE wavelengths, count, width, basis);
    up_spectrum(multipliers, basis, width, total);
    up_write(total, count, width, reflectances);
}

/* Reflectances of stored multipliers at wavelengths in nm. */
UP_FUNCTION void up_evaluate(
    UP_READS_CUBE const float multipliers[UP_COUNT], const float *wavelengths, int count, float *reflectances)
{
    int at = 0;
    for (; count - at > UP_NARROW; at += UP_WIDTH)
        up_evaluate_block(UP_CUBE multipliers, wavelengths + at, count - at, UP_WIDTH, reflectances + at);
    for (; at < count; at += UP_NARROW)
        up_evaluate_block(UP_CUBE multipliers, wavelengths + at, count - at, UP_NARROW, reflectances + at);
}

#if UP_SPECTRA

/* Reflectances of n colours in linear RGB at the same wavelengths in nm: faster than one by one. */
UP_FUNCTION void up_reflectances_n(
    UP_READS_CUBE const float *rgb, int n, const float *wavelengths, int count, float *reflectances)
{
    float place[UP_PLACE], basis[UP_COUNT * UP_CHUNK];
    UP_SHAPE(shape);
    for (int start = 0; start < count; start += UP_CHUNK) {
        int some = up_tabulate(UP_CUBE wavelengths + start, count - start, basis);
        float *found = reflectances + start;
        for (int i = 0; i < n; ++i, found += count) {
            int entry = up_find(UP_CUBE rgb + 3 * i, place, shape);
            up_answer_all(UP_CUBE shape, place, entry, wavelengths + start, some, basis, found);
        }
    }
}

/* The same of one colour; its colour is exactly this RGB. Clips RGB to [0, 1]. */
UP_FUNCTION void up_reflectances(UP_READS_CUBE const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    up_reflectances_n(UP_CUBE rgb, 1, wavelengths, count, reflectances);
}

#else

/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
UP_FUNCTION void up_coefficients(const float rgb[3], float coefficients[UP_COUNT])
{
    int nodes[4];
    float place[UP_PLACE];
    int entry = up_locate(rgb, nodes, place);
    up_sum_coefficients(nodes, place, entry, coefficients);
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
UP_FUNCTION void up_reflectances(const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    float place[UP_PLACE], basis[UP_COUNT * UP_CHUNK];
    UP_SHAPE(shape);
    int entry = up_find(rgb, place, shape);
    for (int start = 0; start < count; start += UP_CHUNK) {
        int some = up_tabulate(wavelengths + start, count - start, basis);
        up_answer_all(shape, place, entry, wavelengths + start, some, basis, reflectances + start);
    }
}

/* The same of n colours at the same wavelengths: faster than one by one. */
UP_FUNCTION void up_reflectances_n(const float *rgb, int n, const float *wavelengths, int count, float *reflectances)
{
    int nodes[4], entries[UP_LANES];
    float places[UP_PLACE * UP_LANES], numbers[UP_COUNT * UP_LANES], multipliers[UP_COUNT * UP_LANES], basis[UP_COUNT * UP_CHUNK];
    for (; n > 0; n -= UP_LANES) {
        int colours = n < UP_LANES ? n : UP_LANES;
        for (int lane = 0; lane < colours; ++lane, rgb += 3) {
            entries[lane] = up_locate(rgb, nodes, places + UP_PLACE * lane);
            up_sum_nodes(nodes, places + UP_PLACE * lane, numbers + UP_COUNT * lane);
#if UP_INEXACT
            up_settle(rgb, places + UP_PLACE * lane);
#endif
        }
        up_multipliers_of_lanes(numbers, colours, multipliers);
        for (int start = 0; start < count; start += UP_CHUNK) {
            int some = up_tabulate(wavelengths + start, count - start, basis);
            for (int lane = 0; lane < colours; ++lane)
                up_answer_all(
                    multipliers + UP_COUNT * lane, places + UP_PLACE * lane, entries[lane], wavelengths + start, some, basis,
                    reflectances + lane * count + start);
        }
        reflectances += colours * count;
    }
}

#endif
