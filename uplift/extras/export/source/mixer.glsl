/* Mixes RGB colours as paints: blue and yellow are green. GLSL 3.30 and GLSL ES 3.00.

   Written by uplift ${version} from the cube ${digest}. BSD-3-Clause.
   RGB is linear ${space} under ${illuminant} for the ${observer}, in [0, 1]: numbers outside are clipped, NaN is 0.

   vec3 up_mix(vec3 first, vec3 second, float share)        the share is that of the second colour, in [0, 1]
   vec3 up_mix_srgb(vec3 first, vec3 second, float share)   codes in [0, 1] with the curve of sRGB

   Latents mix as numbers do, also of more colours: up_colour(up_blend(up_latent(a), up_latent(b), share)).

   ${stem}.bin: half floats, little-endian, ${dim} x ${dim} x ${depth} texels of four. Load it as the 3D texture up_table of the format
   RGBA16F, filter LINEAR, wrap CLAMP_TO_EDGE. */
#ifdef GL_ES
precision highp float;
precision highp int;
#endif
#define UP_DIM ${dim}.0
uniform highp sampler3D up_table;

/* Absorption, scattering and reflectance in bands, and linear RGB. */
struct up_paint {
    mat2x4 K;
    mat2x4 S;
    mat2x4 R;
    vec3 rgb;
};

/* From reflectances in bands to linear RGB. */
const vec4 up_to_rgb[6] = vec4[6](
${to_rgb});

vec3 up_clip(vec3 x)
{
    uvec3 size = floatBitsToUint(x) & uvec3(0x7fffffffu);
    return clamp(mix(x, vec3(0.0), greaterThan(size, uvec3(0x7f800000u))), 0.0, 1.0); /* NaN is 0 */
}

/* Numbers 4 * quarter to 4 * quarter + 3 of a node: square roots of reflectances, then of scattering. */
vec4 up_roots(vec3 place, float quarter)
{
    vec3 texel = vec3(place.bg, place.r) * (UP_DIM - 1.0) + 0.5;
    return texture(up_table, (texel + vec3(0.0, 0.0, quarter * UP_DIM)) / vec3(UP_DIM, UP_DIM, 4.0 * UP_DIM));
}

/* Latent numbers of a colour. */
up_paint up_latent(vec3 rgb)
{
    up_paint paint;
    paint.rgb = up_clip(rgb);
    vec3 place = sqrt(paint.rgb);
    for (int k = 0; k < 2; ++k) {
        vec4 roots = up_roots(place, float(k));
        vec4 scattering_roots = up_roots(place, float(k + 2));
        vec4 R = roots * roots;
        vec4 S = scattering_roots * scattering_roots;
        paint.K[k] = S * (1.0 - R) * (1.0 - R) / (2.0 * R); /* Kubelka and Munk: R is that of K and S */
        paint.S[k] = S;
        paint.R[k] = R;
    }
    return paint;
}

up_paint up_blend(up_paint first, up_paint second, float share)
{
    float t = clamp(share, 0.0, 1.0);
    return up_paint(
        first.K * (1.0 - t) + second.K * t, first.S * (1.0 - t) + second.S * t, first.R * (1.0 - t) + second.R * t,
        mix(first.rgb, second.rgb, t));
}

/* Linear RGB of latent numbers: mixed light, and the change to a mixture of paints. */
vec3 up_colour(up_paint paint)
{
    vec3 rgb = paint.rgb;
    for (int k = 0; k < 2; ++k) {
        vec4 K = paint.K[k], S = paint.S[k];
        vec4 change = S / (K + S + sqrt(K * (K + 2.0 * S)) + 1e-30) - paint.R[k];
        rgb += vec3(dot(up_to_rgb[k], change), dot(up_to_rgb[k + 2], change), dot(up_to_rgb[k + 4], change));
    }
    return up_clip(rgb);
}

/* Mix two colours, linear RGB. */
vec3 up_mix(vec3 first, vec3 second, float share)
{
    return up_colour(up_blend(up_latent(first), up_latent(second), share));
}

vec3 up_decode(vec3 code)
{
    return mix(code / 12.92, pow((code + 0.055) / 1.055, vec3(2.4)), step(0.04045, code));
}

vec3 up_encode(vec3 linear)
{
    return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, linear));
}

/* Mix two colours as codes of the curve of sRGB. */
vec3 up_mix_srgb(vec3 first, vec3 second, float share)
{
    return up_encode(up_mix(up_decode(up_clip(first)), up_decode(up_clip(second)), share));
}
