/* Mixes RGB colours as paints: blue and yellow are green.

   Written by uplift ${version} from the cube ${digest}. C99 and C++, BSD-3-Clause.
   RGB is linear ${space} under ${illuminant} for the ${observer}, in [0, 1]: numbers outside are clipped, NaN is 0.

   float blue[3] = {0.0f, 0.015f, 0.234f}, yellow[3] = {0.973f, 0.644f, 0.0f}, green[3];
   up_mix(blue, yellow, 0.5f, green);

   Functions and the sizes of their arrays, which are of float:

   up_mix(first[3], second[3], share, mixed[3])         the share is that of the second colour, in [0, 1]
   up_mix_n(rgb[3 * n], parts[n], n, mixed[3])          n colours; without a positive part, black
   up_mix_srgb(first[3], second[3], share, mixed[3])    codes in [0, 1] with the curve of sRGB
   up_mix_bytes(first[3], second[3], share, mixed[3])   8-bit codes, unsigned char

   A colour that is mixed often, such as that of a brush, has its latent numbers computed once. They mix as numbers do:

   up_latent(rgb[3], latent[UP_SIZE])
   up_add(latent[UP_SIZE], share, sum[UP_SIZE])         shares of sum 1, added to 0
   up_colour(latent[UP_SIZE], rgb[3])

   Loops vectorise with cc -O3 -march=x86-64-v3 -fno-math-errno. The table is static: include this file in one source file. */
#ifndef UP_MIXER_H
#define UP_MIXER_H

#include <math.h>
#include <string.h>

#ifdef __cplusplus
#define UP_CAST(type, x) static_cast<type>(x)
#else
#define UP_CAST(type, x) ((type)(x))
#endif
#define UP_FUNCTION static inline
#include "loops.c"
#define UP_BANDS ${bands}
#define UP_DIM ${dim}
#define UP_SIZE (3 * UP_BANDS + 3)

/* Square roots of reflectance and scattering in bands, in units, by red, green and blue. Nodes are even in the square root
   of linear RGB. */
static const float up_table[] = {
${numbers}};
static const float up_units[2] = {${units}};

/* From reflectances in bands to linear RGB. */
static const float up_to_rgb[3][UP_BANDS] = {
${to_rgb}};

/* 0 of a number that is not positive, or NaN. It is judged by its bits, as compilers may be told that nothing is NaN. */
UP_FUNCTION float up_positive(const float *x)
{
    unsigned bits;
    memcpy(&bits, x, sizeof bits);
    return bits <= 0x7f800000u ? *x : 0;
}

UP_FUNCTION float up_clip(const float *x)
{
    float positive = up_positive(x);
    return positive < 1 ? positive : 1;
}

/* Latent numbers of a colour: absorption, scattering and reflectance in bands, and linear RGB. */
UP_FUNCTION void up_latent(const float rgb[3], float latent[UP_SIZE])
{
    float offset[3], roots[2 * UP_BANDS];
    int node = 0;
    for (int c = 0; c < 3; ++c) {
        float inside = up_clip(rgb + c);
        float position = sqrtf(inside) * (UP_DIM - 1);
        int cell = UP_CAST(int, position);
        cell = cell < UP_DIM - 2 ? cell : UP_DIM - 2;
        offset[c] = position - UP_CAST(float, cell);
        node = node * UP_DIM + cell;
        latent[3 * UP_BANDS + c] = inside;
    }
    const float r1 = offset[0], g1 = offset[1], b1 = offset[2];
    const float r0 = 1 - r1, g0 = 1 - g1, b0 = 1 - b1;
    const float w00 = r0 * g0, w01 = r0 * g1, w10 = r1 * g0, w11 = r1 * g1;
    const float *r0g0 = up_table + node * 2 * UP_BANDS, *r0g1 = r0g0 + UP_DIM * 2 * UP_BANDS;
    const float *r1g0 = r0g0 + UP_DIM * UP_DIM * 2 * UP_BANDS, *r1g1 = r1g0 + UP_DIM * 2 * UP_BANDS;
    UP_VECTORISE
    for (int k = 0; k < 2 * UP_BANDS; ++k) {
        const int next = k + 2 * UP_BANDS;
        roots[k] = w00 * b0 * r0g0[k] + w00 * b1 * r0g0[next] + w01 * b0 * r0g1[k] + w01 * b1 * r0g1[next]
            + w10 * b0 * r1g0[k] + w10 * b1 * r1g0[next] + w11 * b0 * r1g1[k] + w11 * b1 * r1g1[next];
    }
    UP_VECTORISE
    for (int k = 0; k < UP_BANDS; ++k) {
        const float root = roots[k] * up_units[0], scattering_root = roots[k + UP_BANDS] * up_units[1];
        const float R = root * root, S = scattering_root * scattering_root;
        latent[k] = S * (1 - R) * (1 - R) / (2 * R); /* Kubelka and Munk: R is that of K and S */
        latent[k + UP_BANDS] = S;
        latent[k + 2 * UP_BANDS] = R;
    }
}

/* Add a share of a latent to a sum. */
UP_FUNCTION void up_add(const float latent[UP_SIZE], float share, float sum[UP_SIZE])
{
    UP_VECTORISE
    for (int k = 0; k < UP_SIZE; ++k) sum[k] += share * latent[k];
}

/* Linear RGB of latent numbers: mixed light, and the change to a mixture of paints. */
UP_FUNCTION void up_colour(const float latent[UP_SIZE], float rgb[3])
{
    float change[UP_BANDS];
    UP_VECTORISE
    for (int k = 0; k < UP_BANDS; ++k) {
        const float K = latent[k], S = latent[k + UP_BANDS];
        change[k] = S / (K + S + sqrtf(K * (K + 2 * S)) + 1e-30f) - latent[k + 2 * UP_BANDS];
    }
    for (int c = 0; c < 3; ++c) {
        float products[UP_BANDS], sum = 0;
        for (int k = 0; k < UP_BANDS; ++k) products[k] = change[k] * up_to_rgb[c][k];
        for (int k = 0; k < UP_BANDS / 2; ++k) sum += products[k] + products[k + UP_BANDS / 2];
        sum += latent[3 * UP_BANDS + c];
        rgb[c] = up_clip(&sum);
    }
}

/* Mix two colours; the share is that of the second. */
UP_FUNCTION void up_mix(const float first[3], const float second[3], float share, float mixed[3])
{
    float one[UP_SIZE], other[UP_SIZE];
    const float t = up_clip(&share);
    up_latent(first, one);
    up_latent(second, other);
    UP_VECTORISE
    for (int k = 0; k < UP_SIZE; ++k) one[k] = (1 - t) * one[k] + t * other[k];
    up_colour(one, mixed);
}

/* Mix n colours by their parts. */
UP_FUNCTION void up_mix_n(const float *rgb, const float *parts, int n, float mixed[3])
{
    float latent[UP_SIZE], sum[UP_SIZE] = {0}, total = 0;
    for (int i = 0; i < n; ++i) total += up_positive(parts + i);
    for (int i = 0; i < n; ++i) {
        const float part = up_positive(parts + i);
        if (part == 0) continue;
        up_latent(rgb + 3 * i, latent);
        up_add(latent, part / total, sum);
    }
    up_colour(sum, mixed);
}

UP_FUNCTION float up_decode(float code)
{
    return code <= 0.04045f ? code / 12.92f : powf((code + 0.055f) / 1.055f, 2.4f);
}

UP_FUNCTION float up_encode(float linear)
{
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

/* Mix two colours as codes of the curve of sRGB. */
UP_FUNCTION void up_mix_srgb(const float first[3], const float second[3], float share, float mixed[3])
{
    float one[3], other[3];
    for (int c = 0; c < 3; ++c) {
        one[c] = up_decode(up_clip(first + c));
        other[c] = up_decode(up_clip(second + c));
    }
    up_mix(one, other, share, mixed);
    for (int c = 0; c < 3; ++c) mixed[c] = up_encode(mixed[c]);
}

/* Linear values of 8-bit codes. */
static const float up_decoded[256] = {
${decoded}};

/* Nearest code of a linear value; the polynomial of its fourth root is the curve within ${curve_error} codes. */
UP_FUNCTION unsigned char up_byte(float linear)
{
    const float v = sqrtf(sqrtf(linear));
    const float curve = ${curve};
    return UP_CAST(unsigned char, (linear <= 0.0031308f ? 255 * 12.92f * linear : curve) + 0.5f);
}

/* Mix two colours as 8-bit codes of the curve of sRGB. */
UP_FUNCTION void up_mix_bytes(
    const unsigned char first[3], const unsigned char second[3], float share, unsigned char mixed[3])
{
    float one[3], other[3], linear[3];
    for (int c = 0; c < 3; ++c) {
        one[c] = up_decoded[first[c]];
        other[c] = up_decoded[second[c]];
    }
    up_mix(one, other, share, linear);
    for (int c = 0; c < 3; ++c) mixed[c] = up_byte(linear[c]);
}
#include "loops_end.c"
#endif
