/* UP_VEC4 reflectances = up_reflectances(UP_VEC3(0.8, 0.2, 0.1), UP_VEC4(450.0, 500.0, 550.0, 600.0));

   Functions, each at four wavelengths in nm:

   UP_VEC4 up_reflectances(UP_VEC3 rgb, UP_VEC4 wavelengths)
   UP_VEC4 up_evaluate(float multipliers[UP_COUNT], UP_VEC4 wavelengths)
   up_coefficients(UP_VEC3 rgb, float coefficients[UP_COUNT]), in mode moments */
/* Reflectance of multipliers at a wavelength in nm. */
float up_evaluate_at(UP_SHAPE(multipliers), float wavelength)
{
    UP_ARRAY(basis, UP_COUNT);
    UP_ARRAY(total, 1);
    up_powers(up_abscissa(up_warp(wavelength)), 0, 1, basis);
    up_spectrum(multipliers, basis, 1, total);
    return total[0];
}

/* Reflectances of stored multipliers at four wavelengths in nm. */
UP_VEC4 up_evaluate(float multipliers[UP_COUNT], UP_VEC4 wavelengths)
{
    UP_ARRAY(copy, UP_ROOM);
    for (int k = 0; k < UP_COUNT; ++k) copy[k] = multipliers[k];
    return UP_VEC4(
        up_evaluate_at(copy, wavelengths.x), up_evaluate_at(copy, wavelengths.y),
        up_evaluate_at(copy, wavelengths.z), up_evaluate_at(copy, wavelengths.w));
}

/* Reflectances of linear RGB at four wavelengths in nm. Clips RGB to [0, 1]. */
UP_VEC4 up_reflectances(UP_VEC3 rgb, UP_VEC4 wavelengths)
{
    UP_ARRAY(colour, 3);
    UP_ARRAY(place, UP_PLACE);
    UP_ARRAY(shape, UP_ROOM);
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    int entry = up_find(colour, place, shape);
    return UP_VEC4(
        up_answer(shape, place, entry, wavelengths.x), up_answer(shape, place, entry, wavelengths.y),
        up_answer(shape, place, entry, wavelengths.z), up_answer(shape, place, entry, wavelengths.w));
}

#if !UP_SPECTRA

/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
void up_coefficients(UP_VEC3 rgb, inout float coefficients[UP_COUNT])
{
    UP_ARRAY(colour, 3);
    UP_ARRAY(place, UP_PLACE);
    UP_INTS(nodes, 4);
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    int entry = up_locate(colour, nodes, place);
    up_sum_coefficients(nodes, place, entry, coefficients);
}

#endif
