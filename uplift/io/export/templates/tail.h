/* Reflectance of a colour that is evaluated once. */
static inline double ${name}_reflectance(const double rgb[3], double wavelength)
{
    double coefficients[${count}], multipliers[${count}];
    ${name}_fetch(rgb, coefficients);
    ${name}_multipliers(coefficients, multipliers);
    return ${name}_evaluate(multipliers, wavelength);
}

#endif
