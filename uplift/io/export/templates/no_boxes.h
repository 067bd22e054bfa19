/* Coefficients at linear RGB. */
static inline void ${name}_fetch(const double rgb[3], double coefficients[${count}])
{
    double query[3];
    ${name}_clip(rgb, query);
    ${name}_lattice(query, coefficients);
}

