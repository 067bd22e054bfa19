/* UP_VEC4 reflectances = up_reflectances(UP_VEC3(0.8, 0.2, 0.1), UP_VEC4(450.0, 500.0, 550.0, 600.0));

   Functions, each at four wavelengths in nm:

   UP_VEC4 up_reflectances(UP_VEC3 rgb, UP_VEC4 wavelengths)
   UP_VEC4 up_evaluate(float multipliers[UP_COUNT], UP_VEC4 wavelengths)
   up_coefficients(UP_VEC3 rgb, float coefficients[UP_COUNT]), in mode moments */
/* Reflectances of stored multipliers at four wavelengths in nm. */
UP_VEC4 up_evaluate(float multipliers[UP_COUNT], UP_VEC4 wavelengths)
{
    UP_ARRAY(lanes, 4);
    UP_ARRAY(basis, UP_COUNT * 4);
    UP_ARRAY(total, 4);
    for (int w = 0; w < 4; ++w) lanes[w] = wavelengths[w];
    up_tabulate(lanes, basis);
    up_evaluate_block(multipliers, basis, total);
    return UP_VEC4(total[0], total[1], total[2], total[3]);
}

/* Reflectances of linear RGB at four wavelengths in nm. Clips RGB to [0, 1]. */
UP_VEC4 up_reflectances(UP_VEC3 rgb, UP_VEC4 wavelengths)
{
    UP_ARRAY(colour, 3);
    UP_ARRAY(place, UP_PLACE);
    UP_ARRAY(lanes, 4);
    UP_ARRAY(total, 4);
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    for (int w = 0; w < 4; ++w) lanes[w] = wavelengths[w];
    int entry = up_find(colour, place);
    up_answer(place, entry, lanes, total);
    return UP_VEC4(total[0], total[1], total[2], total[3]);
}

#if !UP_SPECTRA

/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
void up_coefficients(UP_VEC3 rgb, inout float coefficients[UP_COUNT])
{
    UP_ARRAY(colour, 3);
    UP_ARRAY(place, UP_PLACE);
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    int entry = up_locate(colour, place);
    up_sum_coefficients(place, entry, coefficients);
}

#endif
