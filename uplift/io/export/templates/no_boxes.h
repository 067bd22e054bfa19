/* Coefficients at linear RGB. */
static inline void ${name}_fetch(const double rgb[3], double coefficients[${count}])
{
    double asked[3];
    ${name}_clip(rgb, asked);
    ${name}_lattice(asked, coefficients);
}

