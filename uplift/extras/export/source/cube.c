/* Position of the list of entries whose boxes touch the cell above a lattice point, 0 for none; it is negative where
   answers in the cell are moved. Its fraction is 1/2 at points where coefficients are moved, 0 at others. */
UP_FUNCTION float up_tag(UP_READS int index)
{
    return up_number(UP_TABLE UP_ROW_OF(index) * UP_STRIDE + UP_COUNT);
}

/* Spectra are 1/2 + deviation(x), where x(lambda) is a polynomial with the multipliers as coefficients. */
#if UP_SIGMOIDS

/* Weighted x / (2 sqrt(1 + x^2)): the sigmoid around 1/2. */
UP_FUNCTION float up_deviation(float weight, float x)
{
    return weight * 0.5f * x / UP_SQRT(1.0f + x * x);
}

/* Wavelength scaled from the range to [-1, 1]; differences of magnitudes clip it. */
UP_FUNCTION float up_scaled(UP_READS_CUBE float wavelength)
{
    float x = (2.0f * wavelength - (UP_START + UP_END)) / (UP_END - UP_START);
    return 0.5f * (UP_ABS(x + 1.0f) - UP_ABS(x - 1.0f));
}

/* x = c_0 s^2 + c_1 s + c_2 of the multipliers from an index in the table. */
UP_FUNCTION float up_argument(UP_READS int first, float wavelength)
{
    float s = up_scaled(UP_CUBE wavelength);
    return (up_number(UP_TABLE first) * s + up_number(UP_TABLE first + 1)) * s
        + up_number(UP_TABLE first + 2);
}

/* Tabulate s^2, s, 1 at wavelengths in nm. */
UP_FUNCTION void up_tabulate(UP_READS_CUBE UP_IN float wavelengths[UP_WIDTH], UP_OUT float basis[UP_COUNT * UP_WIDTH])
{
    UP_VECTORISE
    for (int w = 0; w < UP_WIDTH; ++w) {
        float s = up_scaled(UP_CUBE wavelengths[w]);
        basis[w] = s * s;
        basis[UP_WIDTH + w] = s;
        basis[2 * UP_WIDTH + w] = 1.0f;
    }
}

#else

/* sin(pi x) for x in [-1/2, 1/2], to 6e-8 of the value. */
UP_FUNCTION float up_sine_of_turn(float x)
{
    float u = x * x;
    float series = 2.55006973f + u * (-0.59824213f + u * 0.07756039f);
    return x * (3.14159264f + u * (-5.16770968f + u * series));
}

/* Weighted arctan(x) / pi, to 6e-7, by arctan |x| = pi/4 + arctan t: conditions would keep loops from vectorising. To
   6e-8 where answers are moved, which magnifies errors. */
UP_FUNCTION float up_deviation(float weight, float x)
{
    float size = UP_ABS(x);
    float t = (size - 1.0f) / (size + 1.0f);
    float u = t * t;
#if UP_INEXACT
    float high = -0.045208186f + u * (0.0338578399f + u * (-0.0238587439f
        + u * (0.0135560565f + u * (-0.00509455944f + u * 0.000902110684f))));
    return UP_COPYSIGN(weight, x) * (0.25f + t * (0.318309881f + u * (-0.106102447f + u * (0.0636380517f + u * high))));
#else
    float high = 0.0616058142f + u * -0.0370596857f + u * u * (0.0167581496f + u * -0.0037303064f);
    return UP_COPYSIGN(weight, x) * (0.25f + t * (0.318302635f + u * -0.105877136f + u * u * high));
#endif
}

/* Wavelengths, evenly or as the eye distinguishes them. */
UP_FUNCTION float up_warp(UP_READS_CUBE float wavelength)
{
#if UP_WARPED
    float low = UP_WARP_0 * UP_TANH(UP_WARP_1 * (wavelength - UP_WARP_2));
    return low + UP_WARP_3 * UP_TANH(UP_WARP_4 * (wavelength - UP_WARP_5));
#else
    return wavelength;
#endif
}

/* Phase phi in turns, [-1/2, 1/2]; differences of magnitudes clip it to the range. */
UP_FUNCTION float up_phase(UP_READS_CUBE float wavelength)
{
    float turn = (up_warp(UP_CUBE wavelength) - UP_LOW) * UP_SCALE - 0.5f;
    return 0.5f * (UP_ABS(turn + 0.5f) - UP_ABS(turn - 0.5f));
}

/* x = p_0 + 2 p_1 cos(phi) + 2 p_2 cos(2 phi) + ... of the multipliers from an index in the table, by Chebyshev's
   2 cos(k + 1)phi = 2 cos(phi) 2 cos(k phi) - 2 cos(k - 1)phi. */
UP_FUNCTION float up_argument(UP_READS int first, float wavelength)
{
    float cosine = 2.0f * up_sine_of_turn(up_phase(UP_CUBE wavelength)), before = 2.0f, now = cosine;
    float x = up_number(UP_TABLE first);
    for (int k = 1; k < UP_ENTRY_COUNT; ++k) {
        float held = now;
        x += now * up_number(UP_TABLE first + k);
        now = cosine * now - before;
        before = held;
    }
    return x;
}

/* Tabulate 1, 2 cos(phi), ..., 2 cos(m phi) at wavelengths in nm, order by order:
   2 cos(j phi) 2 cos(k phi) = 2 cos(j + k)phi + 2 cos(j - k)phi. */
UP_FUNCTION void up_tabulate(UP_READS_CUBE UP_IN float wavelengths[UP_WIDTH], UP_OUT float basis[UP_COUNT * UP_WIDTH])
{
    UP_VECTORISE
    for (int w = 0; w < UP_WIDTH; ++w) {
        UP_ARRAY(cosine, UP_COUNT);
        cosine[1] = 2.0f * up_sine_of_turn(up_phase(UP_CUBE wavelengths[w]));
        UP_UNROLL
        for (int k = 2; k < UP_COUNT; ++k) {
            cosine[k] = cosine[k / 2] * cosine[k - k / 2] - (k % 2 == 0 ? 2.0f : cosine[1]);
        }
        basis[w] = 1.0f;
        UP_UNROLL
        for (int k = 1; k < UP_COUNT; ++k) basis[k * UP_WIDTH + w] = cosine[k];
    }
}

#endif

/* x: sum of multipliers times basis, even and odd orders apart. */
UP_FUNCTION float up_polynomial(
    UP_IN float values[UP_STRIDE], UP_IN float basis[UP_COUNT * UP_WIDTH], int w)
{
    float even = values[0] * basis[w] + values[2] * basis[2 * UP_WIDTH + w];
    float odd = values[1] * basis[UP_WIDTH + w];
    UP_UNROLL
    for (int k = 3; k < UP_COUNT; ++k) {
        if (k % 2 == 0) even += values[k] * basis[k * UP_WIDTH + w];
        else odd += values[k] * basis[k * UP_WIDTH + w];
    }
    return even + odd;
}

/* Reflectances of multipliers: 1/2 + deviation(x). */
UP_FUNCTION void up_evaluate_block(
    UP_IN float multipliers[UP_COUNT], UP_IN float basis[UP_COUNT * UP_WIDTH], UP_OUT float total[UP_WIDTH])
{
    UP_ARRAY(values, UP_STRIDE);
    UP_UNROLL
    for (int k = 0; k < UP_COUNT; ++k) values[k] = multipliers[k];
    UP_VECTORISE
    for (int w = 0; w < UP_WIDTH; ++w) total[w] = 0.5f + up_deviation(1.0f, up_polynomial(values, basis, w));
}

/* Index of the last node up to x, for x in [0, 1]. */
UP_FUNCTION int up_cell(UP_READS float x)
{
    int low = UP_INT(up_number(UP_TABLE UP_BINS + UP_INT(x * UP_REAL(UP_BIN_COUNT))));
    while (low < UP_DIM - 2 && x >= up_number(UP_TABLE UP_NODES + low + 1)) low += 1;
    return low;
}

/* Row of the lowest corner of a colour's cell. */
UP_FUNCTION int up_first_corner(UP_READS UP_IN float rgb[3])
{
    int red = up_cell(UP_TABLE rgb[0]), green = up_cell(UP_TABLE rgb[1]), blue = up_cell(UP_TABLE rgb[2]);
    return (red * UP_DIM + green) * UP_DIM + blue;
}

/* Clip to [0, 1]. */
UP_FUNCTION float up_clip(float x)
{
    return x > 0.0f ? (x > 1.0f ? 1.0f : x) : 0.0f;
}

/* Clip a component of a colour to [0, 1]; NaN becomes 0. It is judged by its bits, as compilers may be told that nothing is
   NaN. */
UP_FUNCTION float up_component(UP_IN float rgb[3], int axis)
{
    UP_BITS(bits, rgb[axis]);
    return bits <= 0x3f800000u ? rgb[axis] : bits <= 0x7f800000u ? 1.0f : 0.0f;
}

/* Find the entry in whose box a colour lies, or -1; set the colour and the weight of the lattice.

   In a box, x = (1 - t) e + t y, where the ray from the entry's colour e through x leaves the box at y. The lattice at y
   has weight t, the entry the rest. */
UP_FUNCTION int up_locate(UP_READS UP_IN float rgb[3], UP_OUT float place[UP_PLACE])
{
    UP_ARRAY(query, 3);
    for (int axis = 0; axis < 3; ++axis) place[axis] = up_component(rgb, axis);
    for (int axis = 0; axis < 3; ++axis) query[axis] = place[axis];
    int entry = -1;
    int listed = UP_INT(UP_ABS(up_tag(UP_TABLE up_first_corner(UP_TABLE query))));
    place[3] = 1.0f;
    if (listed > 0) {
        int last = listed + UP_INT(up_number(UP_TABLE UP_LISTS + listed));
        while (listed < last) {
            listed += 1;
            int candidate = UP_INT(up_number(UP_TABLE UP_LISTS + listed));
            int box = UP_BOXES + 12 * candidate;
            float reached = 0.0f;
            for (int axis = 0; axis < 3; ++axis) {
                float ray = query[axis] - up_number(UP_TABLE box + axis) - up_number(UP_TABLE box + 3 + axis);
                float part = ray > 0.0f ? ray * up_number(UP_TABLE box + 9 + axis)
                                        : -ray * up_number(UP_TABLE box + 6 + axis);
                reached = part > reached ? part : reached;
            }
            if (reached < 1.0f) {
                entry = candidate;
                place[3] = reached;
                listed = last;
            }
        }
    }
    if (entry >= 0 && place[3] > 0.0f)
        for (int axis = 0; axis < 3; ++axis) {
            int centre = UP_BOXES + 12 * entry + axis;
            float ray = query[axis] - up_number(UP_TABLE centre) - up_number(UP_TABLE centre + 3);
            place[axis] = up_clip(up_number(UP_TABLE centre) + ray / place[3]);
        }
    return entry;
}

/* Set the weights of the lower and upper side of each axis; return the row of the lowest corner. */
UP_FUNCTION int up_weigh(UP_READS UP_IN float place[UP_PLACE], UP_OUT float sides[6])
{
    int first = 0;
    for (int axis = 0; axis < 3; ++axis) {
        int low = up_cell(UP_TABLE place[axis]);
        float start = up_number(UP_TABLE UP_NODES + low);
        float share = (place[axis] - start) / (up_number(UP_TABLE UP_NODES + low + 1) - start);
        sides[2 * axis] = 1.0f - share;
        sides[2 * axis + 1] = share;
        first = first * UP_DIM + low;
    }
    return first;
}

/* Mix the spectrum of the lattice in `total` with that of an entry, which may have more multipliers. */
UP_FUNCTION void up_add_entry(
    UP_READS float lattice_weight, int entry, UP_IN float wavelengths[UP_WIDTH], UP_OUT float total[UP_WIDTH])
{
    UP_VECTORISE
    for (int w = 0; w < UP_WIDTH; ++w) {
        float x = up_argument(UP_TABLE UP_ENTRIES + entry * UP_ENTRY_COUNT, wavelengths[w]);
        total[w] = 0.5f + lattice_weight * (total[w] - 0.5f) + up_deviation(1.0f - lattice_weight, x);
    }
}

/* Reflectances of multipliers, mixed with those of an entry unless it is negative. */
UP_FUNCTION void up_mix(
    UP_READS UP_IN float multipliers[UP_COUNT], float lattice_weight, int entry,
    UP_IN float wavelengths[UP_WIDTH], UP_OUT float total[UP_WIDTH])
{
    UP_ARRAY(basis, UP_COUNT * UP_WIDTH);
    up_tabulate(UP_CUBE wavelengths, basis);
    up_evaluate_block(multipliers, basis, total);
    if (entry >= 0) up_add_entry(UP_TABLE lattice_weight, entry, wavelengths, total);
}

#if UP_SPECTRA

/* Add the weighted spectra of the eight lattice points around a colour. */
UP_FUNCTION void up_add_nodes(
    UP_READS UP_IN float place[UP_PLACE], UP_IN float basis[UP_COUNT * UP_WIDTH], UP_OUT float total[UP_WIDTH])
{
    UP_ARRAY(sides, 6);
    UP_ARRAY(weights, 8);
    UP_ARRAY(arguments, 8 * UP_WIDTH);
    int first = up_weigh(UP_TABLE place, sides);
    for (int corner = 0; corner < 8; ++corner) {
        UP_ROW(values, first + (corner / 4 * UP_DIM + corner / 2 % 2) * UP_DIM + corner % 2);
        weights[corner] = sides[corner / 4] * sides[2 + corner / 2 % 2] * sides[4 + corner % 2];
        UP_VECTORISE
        for (int w = 0; w < UP_WIDTH; ++w) arguments[corner * UP_WIDTH + w] = up_polynomial(values, basis, w);
    }
    UP_VECTORISE
    for (int w = 0; w < UP_WIDTH; ++w) {
        float x = total[w];
        UP_UNROLL
        for (int corner = 0; corner < 8; ++corner) x += up_deviation(weights[corner], arguments[corner * UP_WIDTH + w]);
        total[w] = x;
    }
}

/* Evaluate a colour that is located: the weighted spectra of lattice points and entry. */
UP_FUNCTION void up_blend(
    UP_READS UP_IN float place[UP_PLACE], int entry, UP_IN float wavelengths[UP_WIDTH],
    UP_OUT float total[UP_WIDTH])
{
    UP_ARRAY(basis, UP_COUNT * UP_WIDTH);
    UP_VECTORISE
    for (int w = 0; w < UP_WIDTH; ++w) total[w] = 0.5f;
    up_tabulate(UP_CUBE wavelengths, basis);
    up_add_nodes(UP_TABLE place, basis, total);
    if (entry >= 0) up_add_entry(UP_TABLE place[3], entry, wavelengths, total);
}

#else

/* Weighted coefficients of the eight lattice points around a colour. Where answers are moved, place[8] is set to the share
   that moves: 1 in cells with points that have not their own colours, less in those around them. */
UP_FUNCTION void up_sum_nodes(UP_READS UP_OUT float place[UP_PLACE], UP_OUT float coefficients[UP_COUNT])
{
    UP_ARRAY(sides, 6);
    int first = up_weigh(UP_TABLE place, sides);
    for (int k = 0; k < UP_COUNT; ++k) coefficients[k] = 0.0f;
#if UP_INEXACT
    place[8] = 0.0f;
#endif
    for (int red = 0; red < 2; ++red)
        for (int green = 0; green < 2; ++green)
            for (int blue = 0; blue < 2; ++blue) {
                UP_ROW(values, first + (red * UP_DIM + green) * UP_DIM + blue);
                float weight = sides[red] * sides[2 + green] * sides[4 + blue];
                for (int k = 0; k < UP_COUNT; ++k) coefficients[k] += weight * values[k];
#if UP_INEXACT
                float tag = UP_ABS(values[UP_COUNT]);
                place[8] += 2.0f * weight * (tag - UP_REAL(UP_INT(tag)));
#endif
            }
#if UP_INEXACT
    place[8] = up_clip(place[8]);
#endif
}

/* Weighted coefficients of the lattice and of an entry, in as many coefficients. */
UP_FUNCTION void up_sum_coefficients(
    UP_READS UP_OUT float place[UP_PLACE], int entry, UP_OUT float coefficients[UP_COUNT])
{
    up_sum_nodes(UP_TABLE place, coefficients);
    if (entry >= 0)
        for (int k = 0; k < UP_COUNT; ++k) {
            float value = up_number(UP_TABLE (UP_LATTICE + entry) * UP_STRIDE + k);
            coefficients[k] = place[3] * coefficients[k] + (1.0f - place[3]) * value;
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

/* Evaluate a colour that is located: the spectrum of the lattice's weighted coefficients, mixed with that of the entry. */
UP_FUNCTION void up_blend(
    UP_READS UP_OUT float place[UP_PLACE], int entry, UP_IN float wavelengths[UP_WIDTH],
    UP_OUT float total[UP_WIDTH])
{
    UP_ARRAY(coefficients, UP_COUNT);
    UP_ARRAY(multipliers, UP_COUNT);
    up_sum_nodes(UP_TABLE place, coefficients);
    up_multipliers_of(coefficients, multipliers);
    up_mix(UP_TABLE multipliers, place[3], entry, wavelengths, total);
}

#endif

#if UP_INEXACT

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

/* Set place[4] to place[6], by which arguments move along the curves of the sensor, so that the answer has its colour:
   the minimum of a convex function [uplift.lookup.refine]. place[7] is how far from 0 and 1 they start. */
UP_SELDOM void up_pull(UP_READS UP_IN float rgb[3], int entry, UP_OUT float place[UP_PLACE])
{
    UP_ARRAY(colour, 3);
    UP_ARRAY(at, UP_WIDTH);
    UP_ARRAY(total, UP_WIDTH);
    UP_ARRAY(given, UP_SAMPLE_ROOM);
    UP_FINES(goal, 3);
    UP_FINES(change, 3);
    UP_FINES(trial, 3);
    UP_FINES(move, 3);
    UP_FINES(found, 9);
    UP_FINES(after, 9);
    UP_FINE part = UP_EXACT(1.0f), off = UP_EXACT(1.0f);
    for (int start = 0; start < UP_SAMPLES; start += UP_WIDTH) {
        for (int w = 0; w < UP_WIDTH; ++w) at[w] = UP_FIRST + UP_STEP * UP_REAL(start + w);
        up_blend(UP_TABLE place, entry, at, total);
        for (int w = 0; w < UP_WIDTH && start + w < UP_SAMPLES; ++w) given[start + w] = total[w];
    }
    for (int axis = 0; axis < 3; ++axis) colour[axis] = up_component(rgb, axis);
    up_realise(UP_TABLE colour);
    for (int axis = 0; axis < 3; ++axis) {
        goal[axis] = change[axis] = UP_EXACT(0.0f);
        for (int k = 0; k < 3; ++k)
            goal[axis] += UP_EXACT(up_number(UP_TABLE UP_SCALES + 3 * axis + k)) * colour[k];
    }
    place[7] = 0.0f;
    for (int k = 0; k < 3; ++k) {
        float rest = UP_REAL(goal[k]);
        for (int row = 0; row < UP_SAMPLES; ++row) rest -= up_number(UP_TABLE UP_PULL + 6 * row + k) * given[row];
        place[7] = UP_ABS(rest) > place[7] ? UP_ABS(rest) : place[7];
    }
    float least = 1e-6f + UP_STEEP * place[7];
    place[7] = UP_LEAST + UP_SLOPE * place[7];
    place[7] = place[7] < least ? place[7] : least;
    place[7] = place[7] < UP_MOST ? place[7] : UP_MOST;
    for (int row = 0; row < UP_SAMPLES; ++row) given[row] = up_linear(given[row], place[7]);
    up_residual(UP_TABLE given, goal, change, found);
    for (int turn = 0; turn < UP_STEPS && off > UP_TOLERANCE; ++turn) {
        UP_FINE before = UP_EXACT(0.0f), beyond = UP_EXACT(0.0f);
        up_step(found, move);
        part = up_shorten(UP_TABLE given, change, part, move);
        for (int k = 0; k < 3; ++k) trial[k] = change[k] + move[k];
        up_residual(UP_TABLE given, goal, trial, after);
        for (int k = 0; k < 3; ++k) {
            before += found[k] * move[k];
            beyond += after[k] * move[k];
        }
        if (beyond >= -0.5f * before && after[3] + after[5] + after[8] >= 0.01f * (found[3] + found[5] + found[8])) {
            for (int k = 0; k < 3; ++k) change[k] = trial[k];
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
    for (int k = 0; k < 3; ++k) place[4 + k] = UP_REAL(change[k]);
}

/* Find the entry in whose box a colour lies, or -1; set what `up_answer` needs. */
UP_FUNCTION int up_find(UP_READS UP_IN float rgb[3], UP_OUT float place[UP_PLACE])
{
    int entry = up_locate(UP_TABLE rgb, place);
    UP_ARRAY(colour, 3);
    for (int axis = 0; axis < 3; ++axis) {
        colour[axis] = place[axis];
        place[4 + axis] = 0.0f;
    }
    if (up_tag(UP_TABLE up_first_corner(UP_TABLE colour)) < 0.0f) up_pull(UP_TABLE rgb, entry, place);
    return entry;
}

/* Move reflectances by what `up_find` set. */
UP_FUNCTION void up_move(
    UP_READS UP_IN float place[UP_PLACE], UP_IN float wavelengths[UP_WIDTH], UP_OUT float total[UP_WIDTH])
{
    if (place[4] != 0.0f || place[5] != 0.0f || place[6] != 0.0f)
        for (int w = 0; w < UP_WIDTH; ++w) {
            float position = (wavelengths[w] - UP_FIRST) / UP_STEP, x = up_linear(total[w], place[7]);
            position = up_clip(position / UP_REAL(UP_SAMPLES - 1)) * UP_REAL(UP_SAMPLES - 1);
            int row = UP_INT(position) < UP_SAMPLES - 1 ? UP_INT(position) : UP_SAMPLES - 2;
            float share = position - UP_REAL(row);
            for (int k = 0; k < 3; ++k) {
                int shape = UP_PULL + 6 * row + 3 + k;
                x += place[4 + k]
                    * ((1.0f - share) * up_number(UP_TABLE shape) + share * up_number(UP_TABLE shape + 6));
            }
#if UP_SPECTRA
            total[w] = 0.5f + up_deviation(1.0f, x);
#else
            total[w] = (1.0f - place[8]) * total[w] + place[8] * (0.5f + up_deviation(1.0f, x));
#endif
        }
}

/* Evaluate a colour that is found: with exactly its colour in mode spectra. */
UP_FUNCTION void up_answer(
    UP_READS UP_OUT float place[UP_PLACE], int entry, UP_IN float wavelengths[UP_WIDTH],
    UP_OUT float total[UP_WIDTH])
{
    up_blend(UP_TABLE place, entry, wavelengths, total);
    up_move(UP_TABLE place, wavelengths, total);
}

#else

/* Where all nodes have their own colours, a colour is found by its place, and its answer is the mixture. */
UP_FUNCTION int up_find(UP_READS UP_IN float rgb[3], UP_OUT float place[UP_PLACE])
{
    return up_locate(UP_TABLE rgb, place);
}

UP_FUNCTION void up_answer(
    UP_READS UP_OUT float place[UP_PLACE], int entry, UP_IN float wavelengths[UP_WIDTH],
    UP_OUT float total[UP_WIDTH])
{
    up_blend(UP_TABLE place, entry, wavelengths, total);
}

#endif

