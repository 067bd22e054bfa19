/* Multipliers of moments by Levinson's recursion (Peters et al. 2019; Markoff 1896). Returns 0 if it breaks down. */
static inline int ${name}_dual(const double moments[${count}], double multipliers[${count}])
{
    double hr[${count}], hi[${count}];           /* exponential moments */
    double qr[${count}], qi[${count}];           /* solution of the Toeplitz system */
    double mr[${count}], mi[${count}];           /* its mirror image, then n */
    const double pi = 3.14159265358979323846;
    int j, k;
    if (!(moments[0] >= 0 && moments[0] <= 1)) return 0;
    hr[0] = cos(pi * (moments[0] - 0.5));
    hi[0] = sin(pi * (moments[0] - 0.5));
    for (k = 1; k < ${count}; ++k) {
        hr[k] = hi[k] = 0;
        for (j = 0; j < k; ++j) {
            double scaled = 2 * pi * (k - j) * moments[k - j] / k;
            hr[k] -= scaled * hi[j];
            hi[k] += scaled * hr[j];
        }
    }
    if (!(hr[0] > 0)) return 0;
    for (k = 0; k < ${count}; ++k) qr[k] = qi[k] = 0;
    qr[0] = 1 / hr[0];
    for (k = 1; k < ${count}; ++k) {
        double sr = 0, si = 0, margin;
        for (j = 0; j < k; ++j) {
            sr += (hr[k - j] * qr[j] - hi[k - j] * qi[j]) / 2;
            si += (hr[k - j] * qi[j] + hi[k - j] * qr[j]) / 2;
            mr[j] = qr[k - 1 - j];
            mi[j] = -qi[k - 1 - j];
        }
        margin = 1 - (sr * sr + si * si);
        if (!(margin > 0)) return 0;
        for (j = 0; j < k; ++j) {
            qr[j + 1] -= sr * mr[j] - si * mi[j];
            qi[j + 1] -= sr * mi[j] + si * mr[j];
        }
        for (j = 0; j <= k; ++j) {
            qr[j] /= margin;
            qi[j] /= margin;
        }
    }
    for (k = 0; k < ${count}; ++k) {
        mr[k] = mi[k] = 0;
        for (j = 0; j <= k; ++j) {
            mr[k] += hr[j] * qr[k - j] - hi[j] * qi[k - j];
            mi[k] += hr[j] * qi[k - j] + hi[j] * qr[k - j];
        }
    }
    for (k = 0; k < ${count}; ++k) {
        double lr = 0, li = 0;
        for (j = 0; j < ${count} - k; ++j) {
            lr += mr[k + j] * qr[j] + mi[k + j] * qi[j];
            li += mi[k + j] * qr[j] - mr[k + j] * qi[j];
        }
        multipliers[k] = (li * qr[0] - lr * qi[0]) / (qr[0] * qr[0] + qi[0] * qi[0]);
        if (!(fabs(multipliers[k]) < 1e300)) return 0;
    }
    return 1;
}

/* Multipliers of coefficients. Spectra that reach 0 or 1 are blended with as little grey as necessary. Returns 0 if
   that fails, as for numbers that are not moments of a spectrum; the multipliers are then those of a grey. */
static inline int ${name}_multipliers(const double coefficients[${count}], double multipliers[${count}])
{
    static const double shares[5] = {0, 1e-10, 1e-8, 1e-6, 1e-4};
    double moments[${count}];
    int attempt, k;
    for (attempt = 0; attempt < 5; ++attempt) {
        for (k = 0; k < ${count}; ++k) moments[k] = (1 - shares[attempt]) * coefficients[k];
        moments[0] += 0.5 * shares[attempt];
        if (${name}_dual(moments, multipliers)) return 1;
    }
    for (k = 0; k < ${count}; ++k) multipliers[k] = 0;
    return 0;
}

/* Reflectance in [0, 1] at a wavelength in nm, constant outside ${start} to ${end}. */
static inline double ${name}_evaluate(const double multipliers[${count}], double wavelength)
{
    const double pi = 3.14159265358979323846;
    double turn, sum = 0, before = 0;
    int k;
    wavelength = wavelength > ${start} ? (wavelength < ${end} ? wavelength : ${end}) : ${start};
    turn = 2 * cos(pi * (${warp} - ${low}) / ${width} - pi);
    for (k = ${count} - 1; k > 0; --k) { /* Clenshaw's summation of multipliers[k] cos(k phase) */
        double next = 2 * multipliers[k] + turn * sum - before;
        before = sum;
        sum = next;
    }
    return 0.5 + atan(multipliers[0] + turn / 2 * sum - before) / pi;
}

