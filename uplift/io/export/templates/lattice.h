/* Index of the last node up to x; *fraction is the position of x between it and the next node. */
static inline int ${name}_cell(double x, double *fraction)
{
    int low = 0, high = ${NAME}_DIM - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (x >= ${name}_nodes[middle]) low = middle;
        else high = middle;
    }
    *fraction = (x - ${name}_nodes[low]) / (${name}_nodes[low + 1] - ${name}_nodes[low]);
    return low;
}

/* Coefficients of the lattice: trilinear interpolation in linear RGB. */
static inline void ${name}_lattice(const double rgb[3], double coefficients[${count}])
{
    int low[3], corner, k;
    double along[3];
    for (k = 0; k < 3; ++k) low[k] = ${name}_cell(rgb[k], &along[k]);
    for (k = 0; k < ${count}; ++k) coefficients[k] = 0;
    for (corner = 0; corner < 8; ++corner) {
        int r = corner >> 2, g = corner >> 1 & 1, b = corner & 1;
        const ${type} *point = ${name}_table[((low[0] + r) * ${dim} + low[1] + g) * ${dim} + low[2] + b];
        double weight = (r ? along[0] : 1 - along[0]) * (g ? along[1] : 1 - along[1]) * (b ? along[2] : 1 - along[2]);
        for (k = 0; k < ${count}; ++k) coefficients[k] += weight * point[k];
    }
}

/* Clip linear RGB to [0, 1]; NaN becomes 0. */
static inline void ${name}_clip(const double rgb[3], double clipped[3])
{
    int k;
    for (k = 0; k < 3; ++k) clipped[k] = rgb[k] > 0 ? (rgb[k] < 1 ? rgb[k] : 1) : 0;
}

