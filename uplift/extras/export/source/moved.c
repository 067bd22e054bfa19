/* The argument x of a reflectance 1/2 + deviation(x), at least a distance away from 0 and 1. */
UP_FUNCTION float up_linear(float reflectance, float away)
{
    float middle = reflectance - 0.5f;
    float size = UP_ABS(middle) < 0.5f - away ? UP_ABS(middle) : 0.5f - away;
#if UP_SIGMOIDS
    float x = size / UP_SQRT((0.5f - size) * (0.5f + size));
#else
    float x = up_sine_of_turn(size) / up_sine_of_turn(0.5f - size);
#endif
    return UP_COPYSIGN(x, middle);
}

/* The requested colour; one that is not well inside the colours of reflectances moves there, towards its grey. */
UP_FUNCTION void up_realise(UP_READS UP_OUT float rgb[3])
{
    UP_ARRAY(chroma, 3);
    float grey = 0.0f, size = UP_MARGIN, reach = 2.0f;
    for (int axis = 0; axis < 3; ++axis) grey += up_number(UP_TABLE UP_LUMINANCE + axis) * rgb[axis];
    grey = UP_MARGIN + (1.0f - 2.0f * UP_MARGIN) * up_clip((grey - UP_MARGIN) / (1.0f - 2.0f * UP_MARGIN));
    for (int axis = 0; axis < 3; ++axis) {
        chroma[axis] = rgb[axis] - grey;
        size = UP_ABS(chroma[axis]) > size ? UP_ABS(chroma[axis]) : size;
    }
    for (int facet = UP_FACETS; facet < UP_FACETS + 4 * UP_FACET_COUNT; facet += 4) {
        float along = 0.0f, speed = 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
            float normal = up_number(UP_TABLE facet + axis);
            along += normal * (grey - 0.5f);
            speed += normal * chroma[axis];
        }
        float room = up_number(UP_TABLE facet + 3) - (speed > 0.0f ? along : -along);
        room = room > 0.0f ? room : 0.0f;
        if (UP_ABS(speed) * reach > room) reach = room / UP_ABS(speed);
    }
    reach -= UP_MARGIN / size;
    if (reach < 1.0f)
        for (int axis = 0; axis < 3; ++axis) rgb[axis] = grey + (reach > 0.0f ? reach : 0.0f) * chroma[axis];
}

/* Set the residual, three numbers, and the derivative of the colour, six, of arguments that move by `change`. */
UP_FUNCTION void up_residual(
    UP_READS UP_IN float given[UP_SAMPLE_ROOM], UP_IN UP_FINE goal[3], UP_IN UP_FINE change[3], UP_OUT UP_FINE found[9])
{
    for (int k = 0; k < 9; ++k) found[k] = k < 3 ? goal[k] : UP_EXACT(0.0f);
    for (int row = 0; row < UP_SAMPLES; ++row) {
        int at = UP_PULL + 6 * row;
        UP_FINES(weight, 3);
        UP_FINES(shape, 3);
        UP_FINE x = UP_EXACT(given[row]);
        for (int k = 0; k < 3; ++k) {
            weight[k] = UP_EXACT(up_number(UP_TABLE at + k));
            shape[k] = UP_EXACT(up_number(UP_TABLE at + 3 + k));
            x += shape[k] * change[k];
        }
#if UP_SIGMOIDS
        UP_FINE root = UP_SQUARE_ROOT(1.0f + x * x);
        UP_FINE value = 0.5f + 0.5f * x / root, slope = 0.5f / (root * root * root);
#else
        UP_FINE value = 0.5f + UP_TURN(x), slope = UP_EXACT(0.318309886f) / (1.0f + x * x);
#endif
        for (int a = 0; a < 3; ++a) {
            found[a] -= weight[a] * value;
            for (int b = 0; b <= a; ++b) found[3 + a * (a + 1) / 2 + b] += weight[a] * slope * shape[b];
        }
    }
}

/* Newton's step of residual and derivative. */
UP_FUNCTION void up_step(UP_IN UP_FINE found[9], UP_OUT UP_FINE change[3])
{
    UP_FINE least = UP_TINY * (found[3] + found[5] + found[8]);
    UP_FINE d0 = found[3] > least ? found[3] : least, l1 = found[4] / d0, l2 = found[6] / d0;
    UP_FINE d1 = found[5] - l1 * found[4], d2, l3;
    d1 = d1 > least ? d1 : least;
    l3 = (found[7] - l2 * found[4]) / d1;
    d2 = found[8] - l2 * found[6] - l3 * l3 * d1;
    d2 = d2 > least ? d2 : least;
    change[1] = found[1] - l1 * found[0];
    change[2] = (found[2] - l2 * found[0] - l3 * change[1]) / d2;
    change[1] = change[1] / d1 - l3 * change[2];
    change[0] = found[0] / d0 - l1 * change[1] - l2 * change[2];
}

/* Take a part of a step, less if arguments x, which have moved by `change`, would move farther than UP_REACH (1 + |x|). */
UP_FUNCTION UP_FINE up_shorten(
    UP_READS UP_IN float given[UP_SAMPLE_ROOM], UP_IN UP_FINE change[3], UP_FINE part, UP_OUT UP_FINE move[3])
{
    UP_FINE kept = part;
    for (int row = 0; row < UP_SAMPLES; ++row) {
        UP_FINE x = UP_EXACT(given[row]), by = UP_EXACT(0.0f);
        for (int k = 0; k < 3; ++k) {
            UP_FINE shape = UP_EXACT(up_number(UP_TABLE UP_PULL + 6 * row + 3 + k));
            x += shape * change[k];
            by += shape * move[k];
        }
        x = x > 0.0f ? x : -x;
        by = by > 0.0f ? by : -by;
        if (kept * by > UP_REACH * (1.0f + x)) kept = UP_REACH * (1.0f + x) / by;
    }
    for (int k = 0; k < 3; ++k) move[k] *= kept;
    return kept;
}

/* Set the change y by which arguments move along the curves of the sensor, so that the answer to a colour has it: the
   minimum of a convex function [uplift.lookup.refine]. change[3] is how far from 0 and 1 they start, 0 if they do not move. */
UP_SELDOM void up_pull(UP_READS UP_IN float rgb[3], UP_OUT float change[4])
{
    UP_ARRAY(place, UP_PLACE);
    UP_SHAPE(shape);
    UP_ARRAY(colour, 3);
    UP_ARRAY(given, UP_SAMPLE_ROOM);
    UP_FINES(goal, 3);
    UP_FINES(y, 3);
    UP_FINES(trial, 3);
    UP_FINES(move, 3);
    UP_FINES(found, 9);
    UP_FINES(after, 9);
    UP_FINE part = UP_EXACT(1.0f), off = UP_EXACT(1.0f);
    int entry = up_seek(UP_TABLE rgb, place, shape);
    for (int row = 0; row < UP_SAMPLES; ++row)
        given[row] = up_blend_at(UP_TABLE shape, place, entry, UP_FIRST + UP_STEP * UP_REAL(row));
    for (int axis = 0; axis < 3; ++axis) colour[axis] = up_component(rgb, axis);
    up_realise(UP_TABLE colour);
    for (int axis = 0; axis < 3; ++axis) {
        goal[axis] = y[axis] = UP_EXACT(0.0f);
        for (int k = 0; k < 3; ++k)
            goal[axis] += UP_EXACT(up_number(UP_TABLE UP_SCALES + 3 * axis + k)) * colour[k];
    }
    change[3] = 0.0f;
    for (int k = 0; k < 3; ++k) {
        float rest = UP_REAL(goal[k]);
        for (int row = 0; row < UP_SAMPLES; ++row) rest -= up_number(UP_TABLE UP_PULL + 6 * row + k) * given[row];
        change[3] = UP_ABS(rest) > change[3] ? UP_ABS(rest) : change[3];
    }
    float least = 1e-6f + UP_STEEP * change[3];
    change[3] = UP_LEAST + UP_SLOPE * change[3];
    change[3] = change[3] < least ? change[3] : least;
    change[3] = change[3] < UP_MOST ? change[3] : UP_MOST;
    for (int row = 0; row < UP_SAMPLES; ++row) given[row] = up_linear(given[row], change[3]);
    up_residual(UP_TABLE given, goal, y, found);
    for (int turn = 0; turn < UP_STEPS && off > UP_TOLERANCE; ++turn) {
        UP_FINE before = UP_EXACT(0.0f), beyond = UP_EXACT(0.0f);
        up_step(found, move);
        part = up_shorten(UP_TABLE given, y, part, move);
        for (int k = 0; k < 3; ++k) trial[k] = y[k] + move[k];
        up_residual(UP_TABLE given, goal, trial, after);
        for (int k = 0; k < 3; ++k) {
            before += found[k] * move[k];
            beyond += after[k] * move[k];
        }
        if (beyond >= -0.5f * before && after[3] + after[5] + after[8] >= 0.01f * (found[3] + found[5] + found[8])) {
            for (int k = 0; k < 3; ++k) y[k] = trial[k];
            for (int k = 0; k < 9; ++k) found[k] = after[k];
            part = part < 0.25f ? 4.0f * part : UP_EXACT(1.0f);
        } else {
            part *= 0.25f;
        }
        off = UP_EXACT(0.0f);
        for (int k = 0; k < 3; ++k) {
            UP_FINE size = found[k] > 0.0f ? found[k] : -found[k];
            off = size > off ? size : off;
        }
    }
    for (int k = 0; k < 3; ++k) change[k] = UP_REAL(y[k]);
    if (change[0] == 0.0f && change[1] == 0.0f && change[2] == 0.0f) change[3] = 0.0f;
}

/* Replace the tag of a place by the change of answers there. */
UP_FUNCTION void up_settle(UP_READS UP_IN float rgb[3], UP_OUT float place[UP_PLACE])
{
    UP_ARRAY(change, 4);
    float tag = place[5];
    for (int k = 0; k < 4; ++k) place[5 + k] = 0.0f;
    if (tag < 0.0f) {
        up_pull(UP_TABLE rgb, change);
        for (int k = 0; k < 4; ++k) place[5 + k] = change[k];
    }
}

/* Move a reflectance by what `up_settle` set. */
UP_FUNCTION float up_move(UP_READS UP_IN float place[UP_PLACE], float wavelength, float reflectance)
{
    float position = up_clip((wavelength - UP_FIRST) / (UP_STEP * UP_REAL(UP_SAMPLES - 1))) * UP_REAL(UP_SAMPLES - 1);
    int row = UP_INT(position) < UP_SAMPLES - 1 ? UP_INT(position) : UP_SAMPLES - 2;
    float share = position - UP_REAL(row), x = up_linear(reflectance, place[8]);
    for (int k = 0; k < 3; ++k) {
        int shape = UP_PULL + 6 * row + 3 + k;
        x += place[5 + k] * ((1.0f - share) * up_number(UP_TABLE shape) + share * up_number(UP_TABLE shape + 6));
    }
    float moved = 0.5f + up_deviation(1.0f, x);
#if UP_SPECTRA
    return moved;
#else
    return (1.0f - place[9]) * reflectance + place[9] * moved;
#endif
}
