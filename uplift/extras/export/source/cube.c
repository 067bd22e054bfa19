/* Spectra are 1/2 + deviation(x), where x is a polynomial with the multipliers as coefficients, of an abscissa that follows
   from the wavelength. A shape is what the spectrum of the lattice is evaluated from: UP_SHAPE(name), multipliers of its four
   nodes, or in mode moments of their weighted coefficients. */

/* Wavelengths, evenly or as the eye distinguishes them. */
UP_FUNCTION float up_warp(UP_READS_CUBE float wavelength)
{
    float warped = wavelength;
    if (UP_WARPED != 0) {
        warped = UP_WARP_0 * UP_TANH(UP_WARP_1 * (wavelength - UP_WARP_2));
        warped += UP_WARP_3 * UP_TANH(UP_WARP_4 * (wavelength - UP_WARP_5));
    }
    return warped;
}

#if UP_SIGMOIDS

/* Weighted x / (2 sqrt(1 + x^2)): the sigmoid around 1/2. */
UP_FUNCTION float up_deviation(float weight, float x)
{
    return weight * 0.5f * x / UP_SQRT(1.0f + x * x);
}

/* s: wavelength scaled from the range to [-1, 1]; differences of magnitudes clip it. */
UP_FUNCTION float up_abscissa(UP_READS_CUBE float wavelength)
{
    float x = (2.0f * wavelength - (UP_START + UP_END)) / (UP_END - UP_START);
    return 0.5f * (UP_ABS(x + 1.0f) - UP_ABS(x - 1.0f));
}

/* Set powers of s: those of a wavelength w of `width`, order by order. */
UP_FUNCTION void up_powers(float s, int w, int width, UP_OUT float basis[UP_COUNT * UP_BLOCK])
{
    basis[w] = s * s;
    basis[width + w] = s;
    basis[2 * width + w] = 1.0f;
}

/* x = c_0 s^2 + c_1 s + c_2 of the multipliers from an index in the table. */
UP_FUNCTION float up_argument(UP_READS int first, float s)
{
    return (up_number(UP_TABLE first) * s + up_number(UP_TABLE first + 1)) * s
        + up_number(UP_TABLE first + 2);
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

/* Phase phi in turns, [-1/2, 1/2]; differences of magnitudes clip it to the range. */
UP_FUNCTION float up_phase(UP_READS_CUBE float warped)
{
    float turn = (warped - UP_LOW) * UP_SCALE - 0.5f;
    return 0.5f * (UP_ABS(turn + 0.5f) - UP_ABS(turn - 0.5f));
}

/* 2 cos(phi). */
UP_FUNCTION float up_abscissa(UP_READS_CUBE float warped)
{
    return 2.0f * up_sine_of_turn(up_phase(UP_CUBE warped));
}

/* Set 1, 2 cos(phi), ..., 2 cos(m phi) of a wavelength w of `width`, order by order:
   2 cos(j phi) 2 cos(k phi) = 2 cos(j + k)phi + 2 cos(j - k)phi. */
UP_FUNCTION void up_powers(float cosine, int w, int width, UP_OUT float basis[UP_COUNT * UP_BLOCK])
{
    UP_ARRAY(power, UP_COUNT);
    power[0] = 1.0f;
    power[1] = cosine;
    UP_UNROLL
    for (int k = 2; k < UP_COUNT; ++k) power[k] = power[k / 2] * power[k - k / 2] - (k % 2 == 0 ? 2.0f : cosine);
    UP_UNROLL
    for (int k = 0; k < UP_COUNT; ++k) basis[k * width + w] = power[k];
}

/* x = p_0 + 2 p_1 cos(phi) + 2 p_2 cos(2 phi) + ... of the multipliers from an index in the table, by Chebyshev's
   2 cos(k + 1)phi = 2 cos(phi) 2 cos(k phi) - 2 cos(k - 1)phi. */
UP_FUNCTION float up_argument(UP_READS int first, float cosine)
{
    float before = 2.0f, now = cosine;
    float x = up_number(UP_TABLE first);
    for (int k = 1; k < UP_ENTRY_COUNT; ++k) {
        float held = now;
        x += now * up_number(UP_TABLE first + k);
        now = cosine * now - before;
        before = held;
    }
    return x;
}

#endif

/* x at a wavelength w of `width`: sum of multipliers from an index times powers, even and odd ones apart. */
UP_FUNCTION float up_polynomial(
    UP_IN UP_NUMBERS(multipliers), int first, UP_IN float basis[UP_COUNT * UP_BLOCK], int w, int width)
{
    float even = multipliers[first] * basis[w] + multipliers[first + 2] * basis[2 * width + w];
    float odd = multipliers[first + 1] * basis[width + w];
    UP_UNROLL
    for (int k = 3; k < UP_COUNT; ++k) {
        if (k % 2 == 0) even += multipliers[first + k] * basis[k * width + w];
        else odd += multipliers[first + k] * basis[k * width + w];
    }
    return even + odd;
}

/* Set the reflectances of multipliers at `width` wavelengths. */
UP_EXPANDED void up_spectrum(
    UP_IN UP_NUMBERS(multipliers), UP_IN float basis[UP_COUNT * UP_BLOCK], int width, UP_OUT float total[UP_BLOCK])
{
    UP_VECTORISE
    for (int w = 0; w < width; ++w) total[w] = 0.5f + up_deviation(1.0f, up_polynomial(multipliers, 0, basis, w, width));
}

#ifndef UP_ROW

/* Copy the row of a lattice point, UP_COUNT numbers of its spectrum, its tag, and zeros. */
UP_FUNCTION void up_load_row(UP_READS int index, int first, UP_OUT float rows[UP_ROOM])
{
    UP_UNROLL
    for (int t = 0; t < UP_STRIDE / 4; ++t) {
        UP_TEXEL texel = up_texel(UP_TABLE index * (UP_STRIDE / 4) + t);
        rows[first + 4 * t] = texel.x;
        rows[first + 4 * t + 1] = texel.y;
        rows[first + 4 * t + 2] = texel.z;
        rows[first + 4 * t + 3] = texel.w;
    }
}

#endif

#if UP_SPECTRA

/* Find the entry in whose box a colour lies, or -1, its place, and the shape of the lattice there. */
UP_FUNCTION int up_seek(UP_READS UP_IN float rgb[3], UP_OUT float place[UP_PLACE], UP_OUT UP_SHAPE(shape))
{
    UP_INTS(nodes, 4);
    int entry = up_locate(UP_TABLE rgb, nodes, place);
    UP_UNROLL
    for (int node = 0; node < 4; ++node) {
        int index = nodes[node];
        UP_LOAD(shape, node, UP_ROW_OF(index));
    }
    return entry;
}

/* Set the reflectances of the lattice at `width` wavelengths: the weighted spectra of four nodes. */
UP_EXPANDED void up_lattice(
    UP_IN UP_SHAPE(shape), UP_IN float place[UP_PLACE], UP_IN float basis[UP_COUNT * UP_BLOCK], int width,
    UP_OUT float total[UP_BLOCK])
{
    UP_UNROLL
    for (int node = 0; node < 4; ++node) {
        UP_VECTORISE
        for (int w = 0; w < width; ++w) {
            float x = up_polynomial(UP_NODE(shape, node), basis, w, width);
            total[w] = (node == 0 ? 0.5f : total[w]) + up_deviation(place[node], x);
        }
    }
}

#else
#include "moments.c"
#endif

/* Mix the reflectance of the lattice with that of an entry, which may have more multipliers. */
UP_FUNCTION float up_mix(UP_READS float lattice_weight, int entry, float abscissa, float reflectance)
{
    float x = up_argument(UP_TABLE UP_ENTRIES + entry * UP_ENTRY_COUNT, abscissa);
    return 0.5f + lattice_weight * (reflectance - 0.5f) + up_deviation(1.0f - lattice_weight, x);
}

/* Set the reflectances of a colour that is located at `width` wavelengths: the mixture of lattice and entry. */
UP_EXPANDED void up_blend(
    UP_READS UP_IN UP_SHAPE(shape), UP_IN float place[UP_PLACE], int entry, UP_IN float basis[UP_COUNT * UP_BLOCK], int width,
    UP_OUT float total[UP_BLOCK])
{
    up_lattice(shape, place, basis, width, total);
    if (entry >= 0)
        for (int w = 0; w < width; ++w) total[w] = up_mix(UP_TABLE place[4], entry, basis[width + w], total[w]);
}

/* Reflectance of a colour that is located, at a wavelength in nm. */
UP_FUNCTION float up_blend_at(
    UP_READS UP_IN UP_SHAPE(shape), UP_IN float place[UP_PLACE], int entry, float wavelength)
{
    UP_ARRAY(basis, UP_COUNT * UP_BLOCK);
    UP_ARRAY(total, UP_BLOCK);
    up_powers(up_abscissa(UP_CUBE up_warp(UP_CUBE wavelength)), 0, 1, basis);
    up_blend(UP_TABLE shape, place, entry, basis, 1, total);
    return total[0];
}

#if UP_INEXACT
#include "moved.c"
#endif

/* The same, and how the answer is moved to the colour. */
UP_FUNCTION int up_find(UP_READS UP_IN float rgb[3], UP_OUT float place[UP_PLACE], UP_OUT UP_SHAPE(shape))
{
    int entry = up_seek(UP_TABLE rgb, place, shape);
#if UP_INEXACT
    up_settle(UP_TABLE rgb, place);
#endif
    return entry;
}

/* Reflectance of a colour that is found, at a wavelength in nm. */
UP_FUNCTION float up_answer(
    UP_READS UP_IN UP_SHAPE(shape), UP_IN float place[UP_PLACE], int entry, float wavelength)
{
    float reflectance = up_blend_at(UP_TABLE shape, place, entry, wavelength);
#if UP_INEXACT
    if (place[8] > 0.0f) reflectance = up_move(UP_TABLE place, wavelength, reflectance);
#endif
    return reflectance;
}
