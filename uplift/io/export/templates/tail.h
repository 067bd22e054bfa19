/* All at once, for who asks for a colour once. */
static inline double ${name}_reflectance(const double rgb[3], double wavelength)
{
    double coefficients[${count}], multipliers[${count}];
    ${name}_fetch(rgb, coefficients);
    ${name}_multipliers(coefficients, multipliers);
    return ${name}_evaluate(multipliers, wavelength);
}

#endif
