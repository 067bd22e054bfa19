/* The atlas entry in whose box linear RGB lies, or -1; boxes do not overlap. */
static inline int ${name}_entry_at(const double rgb[3])
{
    double along;
    int r = ${name}_cell(rgb[0], &along), g = ${name}_cell(rgb[1], &along), b = ${name}_cell(rgb[2], &along);
    int cell = (r * ${dim} + g) * ${dim} + b, low = 0, high = ${boxes}, k;
    while (low < high) {
        int middle = (low + high) / 2;
        if (${name}_box_cell[middle] < cell) low = middle + 1;
        else high = middle;
    }
    for (; low < ${boxes} && ${name}_box_cell[low] == cell; ++low) {
        const double *lowest = ${name}_entry_box[${name}_box_entry[low]] + 3, *highest = lowest + 3;
        int inside = 1;
        for (k = 0; k < 3; ++k) inside = inside && rgb[k] >= lowest[k] && rgb[k] <= highest[k];
        if (inside) return ${name}_box_entry[low];
    }
    return -1;
}

/* Coefficients at linear RGB. In the box of an atlas entry, x = (1 - t) e + t y, where the ray from the entry's colour
   e through x leaves the box at y. The result mixes the coefficients of the entry and of the lattice at y by t. */
static inline void ${name}_fetch(const double rgb[3], double coefficients[${count}])
{
    double query[3], share = 0;
    const double *middle;
    int entry, k;
    ${name}_clip(rgb, query);
    entry = ${name}_entry_at(query);
    if (entry < 0) {
        ${name}_lattice(query, coefficients);
        return;
    }
    middle = ${name}_entry_box[entry];
    for (k = 0; k < 3; ++k) {
        double ray = query[k] - middle[k], extent = ray > 0 ? middle[6 + k] - middle[k] : middle[k] - middle[3 + k];
        if (ray != 0 && fabs(ray) > share * extent) share = fabs(ray) / extent;
    }
    if (share > 0) {
        double exit_rgb[3];
        for (k = 0; k < 3; ++k) exit_rgb[k] = middle[k] + (query[k] - middle[k]) / share;
        ${name}_clip(exit_rgb, query);
    }
    ${name}_lattice(query, coefficients);
    for (k = 0; k < ${count}; ++k)
        coefficients[k] = share * coefficients[k] + (1 - share) * ${name}_entry[entry][k];
}

