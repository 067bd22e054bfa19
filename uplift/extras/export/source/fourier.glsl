/* Spectra of Fourier sRGB, three linear numbers of a texture with the curve of sRGB.

   Call ${name}_multipliers once per texel, filtered or not, and ${name}_reflectance for each wavelength.
   Peters et al. 2019, "Using moments to represent bounded signals for spectral rendering"; the recursion is that of
   Schur 1917 for three moments. */

/* Multipliers of a spectrum, from linear components in [0, 1]. */
vec3 ${name}_multipliers(vec3 colour)
{
    /* Moments, and what keeps rounded ones within those of reflectances. */
    float zeroth = clamp(dot(vec3(${row_0}), colour), 0.0001, 0.9999);
    float scale = 3.14159265 / sin(3.14159265 * zeroth);
    float first = clamp(dot(vec3(${row_1}), colour) * scale, -0.9999, 0.9999);
    float second = dot(vec3(${row_2}), colour) * scale - first * first * cos(3.14159265 * zeroth);
    float one = 1.0 - first * first;
    second = clamp(second / one, -0.9999, 0.9999);
    /* Polynomials A and B; x = (t |A|^2 - |B|^2 / t) / 2k, and its coefficients at lags 0, 1, 2. */
    vec3 a = vec3(1.0, first * (1.0 + second), second);
    vec3 b = vec3(1.0, first * (second - 1.0), -second);
    float t = tan(1.57079633 * zeroth);
    vec3 plus = vec3(dot(a, a), a.y * (a.x + a.z), a.x * a.z);
    vec3 minus = vec3(dot(b, b), b.y * (b.x + b.z), b.x * b.z);
    return (plus * t - minus / t) * (0.5 / (one * (1.0 - second * second)));
}

/* Reflectance at a wavelength in nm. */
float ${name}_reflectance(vec3 multipliers, float nanometres)
{
    float wavelength = clamp(nanometres, ${start}, ${end});
    float warped = ${warp};
    float cosine = cos(3.14159265 * ((warped - ${low}) * ${scale} - 1.0));
    float higher = multipliers.y * cosine + multipliers.z * (2.0 * cosine * cosine - 1.0);
    return 0.5 + 0.318309886 * atan(multipliers.x + 2.0 * higher);
}
