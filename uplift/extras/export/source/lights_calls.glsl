/* UP_VEC4 power = up_power(UP_VEC3(8000.0, 5000.0, 900.0), UP_VEC4(450.0, 500.0, 550.0, 600.0)); */
/* Power of linear RGB at four wavelengths in nm; its colour is exactly this RGB. Colours that no light has move towards
   white of the same luminance. */
UP_VEC4 up_power(UP_VEC3 rgb, UP_VEC4 wavelengths)
{
    UP_ARRAY(colour, 3);
    UP_ARRAY(spot, 5);
    UP_ARRAY(lanes, 4);
    UP_ARRAY(total, 4);
    for (int axis = 0; axis < 3; ++axis) colour[axis] = rgb[axis];
    for (int w = 0; w < 4; ++w) lanes[w] = wavelengths[w];
    int corner = up_locate(colour, spot);
    up_answer(spot, corner, lanes, total);
    return UP_VEC4(total[0], total[1], total[2], total[3]);
}
