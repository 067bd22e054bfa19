/* Weighted coefficients of the four nodes of a colour that is located. Where answers are moved, place[9] is set to the share
   that moves: 1 in cells with points that have not their own colours, less in those around them. */
UP_FUNCTION void up_sum_nodes(
    UP_READS UP_IN int nodes[4], UP_OUT float place[UP_PLACE], UP_OUT float coefficients[UP_COUNT])
{
    for (int k = 0; k < UP_COUNT; ++k) coefficients[k] = 0.0f;
#if UP_INEXACT
    place[9] = 0.0f;
#endif
    for (int node = 0; node < 4; ++node) {
        UP_VALUES(values, nodes[node]);
        for (int k = 0; k < UP_COUNT; ++k) coefficients[k] += place[node] * values[k];
#if UP_INEXACT
        float tag = UP_ABS(values[UP_COUNT]);
        place[9] += 2.0f * place[node] * (tag - UP_REAL(UP_INT(tag)));
#endif
    }
#if UP_INEXACT
    place[9] = up_clip(place[9]);
#endif
}

/* Weighted coefficients of the lattice and of an entry, in as many coefficients. */
UP_FUNCTION void up_sum_coefficients(
    UP_READS UP_IN int nodes[4], UP_OUT float place[UP_PLACE], int entry, UP_OUT float coefficients[UP_COUNT])
{
    up_sum_nodes(UP_TABLE nodes, place, coefficients);
    if (entry >= 0)
        for (int k = 0; k < UP_COUNT; ++k) {
            float value = up_number(UP_TABLE (UP_LATTICE + entry) * UP_STRIDE + k);
            coefficients[k] = place[4] * coefficients[k] + (1.0f - place[4]) * value;
        }
}

#if UP_SIGMOIDS

/* Coefficients of sigmoids are their multipliers: always true. */
UP_FUNCTION UP_BOOL up_dual(UP_IN float coefficients[UP_COUNT], UP_OUT float multipliers[UP_COUNT])
{
    for (int k = 0; k < UP_COUNT; ++k) multipliers[k] = coefficients[k];
    return UP_COUNT > 0;
}

#else

/* Multipliers of moments by Schur's algorithm [Schur 1917, see uplift.models.duality]; false where it breaks down.
   No branches, so that compilers compute several colours side by side. */
UP_EXPANDED UP_BOOL up_dual(UP_IN float moments[UP_COUNT], UP_OUT float multipliers[UP_COUNT])
{
    float middle = moments[0] - 0.5f, nearest = middle < 0.0f ? moments[0] : 1.0f - moments[0]; /* the middle rounds */
    float sine = up_sine_of_turn(nearest), cosine = -up_sine_of_turn(middle);
    UP_ARRAY(slope, UP_COUNT);
    UP_ARRAY(even, UP_COUNT);
    UP_ARRAY(odd, UP_COUNT);
    UP_ARRAY(upper, UP_COUNT);
    UP_ARRAY(lower, UP_COUNT);
    UP_ARRAY(first, UP_COUNT);
    UP_ARRAY(second, UP_COUNT);
    /* Power series of the exponential function of the moments: its odd and its even part. */
    UP_UNROLL
    for (int k = 0; k < UP_COUNT; ++k) {
        slope[k] = 3.14159265f * UP_REAL(k) * moments[k];
        odd[k] = slope[k];
        even[k] = first[k] = second[k] = k == 0 ? 1.0f : 0.0f;
    }
    UP_UNROLL
    for (int order = 1; order < UP_COUNT; ++order) {
        even[order] *= 1.0f / UP_REAL(order);
        odd[order] *= 1.0f / UP_REAL(order);
        UP_UNROLL
        for (int k = order + 1; k < UP_COUNT; ++k) {
            even[k] -= slope[k - order] * odd[order];
            odd[k] += slope[k - order] * even[order];
        }
    }
    UP_UNROLL
    for (int k = 0; k < UP_COUNT - 1; ++k) {
        upper[k] = odd[k + 1];
        lower[k] = sine * even[k] + cosine * odd[k];
    }
    /* Schur's steps: the reflection coefficients g, and the orthogonal polynomials of both kinds by their recurrence. */
    float room = 0.25f - middle * middle, scale = 2.0f;
    UP_UNROLL
    for (int order = 0; order < UP_COUNT - 1; ++order) {
        float g = upper[0] / lower[0], rest = 1.0f - g * g;
        room = rest < room ? rest : room;
        scale *= rest;
        UP_UNROLL
        for (int k = 0; k < UP_COUNT - 2 - order; ++k) {
            float held = upper[k + 1] - g * lower[k + 1];
            lower[k] -= g * upper[k];
            upper[k] = held;
        }
        UP_UNROLL
        for (int k = 0; k < order / 2 + 1; ++k) {
            float held = first[k];
            first[k] += g * first[order + 1 - k];
            first[order + 1 - k] += g * held;
            held = second[k];
            second[k] -= g * second[order + 1 - k];
            second[order + 1 - k] -= g * held;
        }
        if (order % 2 == 1) {
            first[(order + 1) / 2] *= 1.0f + g;
            second[(order + 1) / 2] *= 1.0f - g;
        }
    }
    /* Multipliers: weighted autocorrelations of both polynomials. */
    float opposite = cosine > 0.0f ? sine : 1.0f - cosine, adjacent = cosine > 0.0f ? 1.0f + cosine : sine;
    float first_weight = opposite / (adjacent * scale), second_weight = adjacent / (opposite * scale);
    UP_UNROLL
    for (int lag = 0; lag < UP_COUNT; ++lag) {
        float first_sum = first[0] * first[lag], second_sum = second[0] * second[lag];
        UP_UNROLL
        for (int k = 1; k < UP_COUNT - lag; ++k) {
            first_sum += first[k] * first[k + lag];
            second_sum += second[k] * second[k + lag];
        }
        multipliers[lag] = first_weight * first_sum - second_weight * second_sum;
    }
    return room > 0.0f && scale > 1e-30f;
}

#endif

/* Multipliers, with as little grey as necessary; false, and those of a grey, if no spectrum fits. */
UP_FUNCTION UP_BOOL up_multipliers_of(UP_IN float coefficients[UP_COUNT], UP_OUT float multipliers[UP_COUNT])
{
    UP_ARRAY(mixed, UP_COUNT);
    float share = 0.0f;
    int attempt = 0;
    UP_BOOL valid;
    do {
        for (int k = 0; k < UP_COUNT; ++k) mixed[k] = coefficients[k] * (1.0f - share);
        mixed[0] += 0.5f * share;
        valid = up_dual(mixed, multipliers);
        share = attempt == 0 ? 0.0000001f : share * 10.0f;
        attempt += 1;
    } while (!valid && attempt < 5);
    if (!valid)
        for (int k = 0; k < UP_COUNT; ++k) multipliers[k] = 0.0f;
    return valid;
}

/* Find the entry in whose box a colour lies, or -1, its place, and the shape of the lattice there. */
UP_FUNCTION int up_seek(UP_READS UP_IN float rgb[3], UP_OUT float place[UP_PLACE], UP_OUT UP_SHAPE(shape))
{
    UP_INTS(nodes, 4);
    UP_ARRAY(coefficients, UP_COUNT);
    UP_ARRAY(multipliers, UP_COUNT);
    int entry = up_locate(UP_TABLE rgb, nodes, place);
    up_sum_nodes(UP_TABLE nodes, place, coefficients);
    up_multipliers_of(coefficients, multipliers);
    for (int k = 0; k < UP_COUNT; ++k) shape[k] = multipliers[k];
    return entry;
}

#define up_lattice(shape, place, basis, width, total) up_spectrum(shape, basis, width, total)
