/* float rgb[3] = {8000.0f, 5000.0f, 900.0f}, wavelengths[4] = {450, 500, 550, 600}, power[4];
   up_power(rgb, wavelengths, 4, power);

   The only function is up_power(rgb[3], wavelengths[count], count, power[count]). */
/* Power of linear RGB at wavelengths in nm; its colour is exactly this RGB. Colours that no light has move towards
   white of the same luminance. */
UP_FUNCTION void up_power(const float rgb[3], const float *wavelengths, int count, float *power)
{
    float spot[5];
    int start, corner = up_locate(rgb, spot);
    for (start = 0; start + UP_WIDTH <= count; start += UP_WIDTH)
        up_answer(spot, corner, wavelengths + start, power + start);
    if (start < count) {
        float block[UP_WIDTH] = {0}, found[UP_WIDTH];
        memcpy(block, wavelengths + start, UP_CAST(size_t, count - start) * sizeof *block);
        up_answer(spot, corner, block, found);
        memcpy(power + start, found, UP_CAST(size_t, count - start) * sizeof *found);
    }
}

