/* Direction from white in u'v', from 0 to 4 counterclockwise from the first knot: 1 per quarter turn, by |u| + |v|. */
UP_FUNCTION float up_angle(float u, float v)
{
    float length = UP_ABS(u) + UP_ABS(v);
    float slope = length > 0.0f ? u / length : 1.0f;
    float turned = (v < 0.0f ? 3.0f + slope : 1.0f - slope) - up_number(UP_WHITE + 2);
    return turned < 0.0f ? turned + 4.0f : turned;
}

/* Index of the knot before a direction, by bisection. */
UP_FUNCTION int up_sector(float u, float v)
{
    float sought = up_angle(u, v);
    int low = 0, high = UP_KNOTS;
    while (low + 1 < high) {
        int middle = (low + high) / 2;
        if (up_number(UP_ANGLES + middle) <= sought) low = middle;
        else high = middle;
    }
    return low;
}

/* Share of an offset from white that the first or the second spoke of a sector has. */
UP_FUNCTION float up_along(int knot, float u, float v, int which)
{
    int row = UP_INVERSES + 4 * knot + 2 * which;
    float share = up_number(row) * u + up_number(row + 1) * v;
    return share > 0.0f ? share : 0.0f;
}

/* Set the offset in u'v' from white and the size X + 15 Y + 3 Z of a light. NaN and infinity become 0; a colour that no
   light has moves towards white of the same luminance. */
UP_FUNCTION void up_clip(UP_IN float rgb[3], UP_OUT float offset[4])
{
    for (int row = 0; row < 4; ++row) {
        offset[row] = 0.0f;
        for (int column = 0; column < 3; ++column) {
            UP_BITS(bits, rgb[column]); /* compilers may be told that nothing is NaN */
            float finite = (bits & 0x7fffffffu) < 0x7149f2cau ? rgb[column] : 0.0f; /* 1e30 */
            offset[row] += up_number(UP_MATRIX + 3 * row + column) * finite;
        }
    }
    int knot = up_sector(offset[0], offset[1]);
    float share = up_along(knot, offset[0], offset[1], 0) + up_along(knot, offset[0], offset[1], 1);
    float size = offset[2];
    if (size <= 0.0f || share > size) {
        float white = offset[3] > 0.0f ? offset[3] : 0.0f;
        float reach = share + white - size;
        float step = reach > 0.0f ? white / reach : 0.0f;
        size = step * share;
        offset[0] *= step;
        offset[1] *= step;
    }
    offset[0] = size > 0.0f ? offset[0] / size : 0.0f;
    offset[1] = size > 0.0f ? offset[1] / size : 0.0f;
    offset[2] = size;
}

/* Find the lamp in whose disc a chromaticity lies, or -1; set the share of the lamp, and move to the circle. */
UP_FUNCTION int up_lamp_at(UP_OUT float offset[4], UP_OUT float spot[5])
{
    float u = offset[0] + up_number(UP_WHITE), v = offset[1] + up_number(UP_WHITE + 1);
    int column = UP_INT(u * UP_REAL(UP_BIN_COUNT)), row = UP_INT(v * UP_REAL(UP_BIN_COUNT));
    column = column < UP_BIN_COUNT - 1 ? column : UP_BIN_COUNT - 1;
    row = row < UP_BIN_COUNT - 1 ? row : UP_BIN_COUNT - 1;
    int listed = UP_INT(up_number(UP_BINS + row * UP_BIN_COUNT + column));
    int last = listed + UP_INT(up_number(UP_BINS + listed));
    int found = -1;
    while (listed < last) {
        listed += 1;
        int candidate = UP_INT(up_number(UP_BINS + listed));
        int lamp = UP_LAMPS + 3 * candidate;
        float away_u = u - up_number(lamp), away_v = v - up_number(lamp + 1), radius = up_number(lamp + 2);
        float distance = UP_SQRT(away_u * away_u + away_v * away_v);
        if (distance < radius) {
            found = candidate;
            spot[3] = 1.0f - distance / radius;
            float reach = distance > 0.0f ? radius / distance : 0.0f;
            float turn = distance > 0.0f ? 0.0f : radius;
            offset[0] = up_number(lamp) + away_u * reach + turn - up_number(UP_WHITE);
            offset[1] = up_number(lamp + 1) + away_v * reach - up_number(UP_WHITE + 1);
            listed = last;
        }
    }
    return found;
}

/* Set positions in the cell between two knots and two rings, size, share of the lamp and its number, or -1; return the
   index of the spectrum of the lowest corner. */
UP_FUNCTION int up_locate(UP_IN float rgb[3], UP_OUT float spot[5])
{
    UP_ARRAY(offset, 4);
    up_clip(rgb, offset);
    spot[2] = offset[2];
    spot[3] = 0.0f;
    spot[4] = UP_REAL(up_lamp_at(offset, spot));
    int knot = up_sector(offset[0], offset[1]);
    float second = up_along(knot, offset[0], offset[1], 1);
    float share = up_along(knot, offset[0], offset[1], 0) + second;
    spot[0] = share > 0.0f ? second / share : 0.0f;
    share = share < 1.0f ? share : 1.0f;
    int ring = 0;
    while (ring < UP_RINGS - 2 && share >= up_number(UP_RING_SHARES + ring + 1)) ring += 1;
    float first = up_number(UP_RING_SHARES + ring);
    spot[1] = (share - first) / (up_number(UP_RING_SHARES + ring + 1) - first);
    return (knot * UP_RINGS + ring) * UP_SAMPLES;
}

/* Interpolate between a sample of a spectrum and the next. */
UP_FUNCTION float up_sample(int row, float share)
{
    float first = up_number(row);
    return first + share * (up_number(row + 1) - first);
}

/* Power at wavelengths in nm; linear between samples, constant outside. */
UP_FUNCTION void up_answer(
    UP_IN float spot[5], int corner, UP_IN float wavelengths[UP_WIDTH], UP_OUT float total[UP_WIDTH])
{
    int lamp = UP_INT(spot[4]);
    for (int w = 0; w < UP_WIDTH; ++w) {
        float place = (wavelengths[w] - UP_START) / UP_STEP;
        place = place > 0.0f ? place : 0.0f;
        int low = place < UP_REAL(UP_SAMPLES - 1) ? UP_INT(place) : UP_SAMPLES - 2;
        float share = place < UP_REAL(UP_SAMPLES - 1) ? place - UP_REAL(low) : 1.0f;
        int at = corner + low, next = at + UP_RINGS * UP_SAMPLES;
        float inner = up_sample(at, share);
        float before = inner + spot[1] * (up_sample(at + UP_SAMPLES, share) - inner);
        inner = up_sample(next, share);
        float after = inner + spot[1] * (up_sample(next + UP_SAMPLES, share) - inner);
        float power = before + spot[0] * (after - before);
        if (lamp >= 0) power += spot[3] * (up_sample(UP_LAMP_SPECTRA + lamp * UP_SAMPLES + low, share) - power);
        total[w] = spot[2] * power;
    }
}

