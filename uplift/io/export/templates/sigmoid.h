/* Multipliers of coefficients, which are the same numbers. */
static inline int ${name}_multipliers(const double coefficients[${count}], double multipliers[${count}])
{
    int k;
    for (k = 0; k < ${count}; ++k) multipliers[k] = coefficients[k];
    return 1;
}

/* Reflectance in [0, 1] at a wavelength in nm, constant outside ${start} to ${end}. */
static inline double ${name}_evaluate(const double multipliers[${count}], double wavelength)
{
    double x, t;
    wavelength = wavelength > ${start} ? (wavelength < ${end} ? wavelength : ${end}) : ${start};
    x = (2 * wavelength - (${start} + ${end})) / (${end} - ${start});
    t = (multipliers[0] * x + multipliers[1]) * x + multipliers[2];
    return 0.5 + t / (2 * sqrt(1 + t * t));
}

