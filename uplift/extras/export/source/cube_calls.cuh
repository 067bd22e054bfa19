/* float rgb[3] = {0.8f, 0.2f, 0.1f}, wavelengths[UP_WIDTH] = {450, 500, 550, 600}, reflectances[UP_WIDTH];
   up_reflectances(table, rgb, wavelengths, reflectances);

   Functions and the sizes of their arrays, which are of float:

   up_reflectances(table, rgb[3], wavelengths[UP_WIDTH], reflectances[UP_WIDTH])
   up_evaluate(multipliers[UP_COUNT], wavelengths[UP_WIDTH], reflectances[UP_WIDTH])
   up_coefficients(table, rgb[3], coefficients[UP_COUNT]), in mode moments */
/* Reflectances of stored multipliers at wavelengths in nm. */
UP_FUNCTION void up_evaluate(
    const float multipliers[UP_COUNT], const float wavelengths[UP_WIDTH], float reflectances[UP_WIDTH])
{
    float basis[UP_COUNT];
    UP_EACH
    for (int w = 0; w < UP_WIDTH; ++w) {
        up_powers(up_abscissa(up_warp(wavelengths[w])), 0, 1, basis);
        up_spectrum(multipliers, basis, 1, reflectances + w);
    }
}

/* Reflectances of linear RGB at wavelengths in nm. Clips RGB to [0, 1]. */
UP_FUNCTION void up_reflectances(
    const float *table, const float rgb[3], const float wavelengths[UP_WIDTH], float reflectances[UP_WIDTH])
{
    float place[UP_PLACE];
    UP_SHAPE(shape);
    int entry = up_find(table, rgb, place, shape);
    UP_EACH
    for (int w = 0; w < UP_WIDTH; ++w) reflectances[w] = up_answer(table, shape, place, entry, wavelengths[w]);
}

#if !UP_SPECTRA

/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
UP_FUNCTION void up_coefficients(const float *table, const float rgb[3], float coefficients[UP_COUNT])
{
    int nodes[4];
    float place[UP_PLACE];
    int entry = up_locate(table, rgb, nodes, place);
    up_sum_coefficients(table, nodes, place, entry, coefficients);
}

#endif
