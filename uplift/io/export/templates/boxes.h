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

/* Coefficients at linear RGB. Near an atlas entry, x = (1 - t) e + t y with y where the ray from the entry's colour
   e through x leaves its box: the answer mixes the entry's coefficients and the lattice's at y alike. */
static inline void ${name}_fetch(const double rgb[3], double coefficients[${count}])
{
    double asked[3], share = 0;
    const double *middle;
    int entry, k;
    ${name}_clip(rgb, asked);
    entry = ${name}_entry_at(asked);
    if (entry < 0) {
        ${name}_lattice(asked, coefficients);
        return;
    }
    middle = ${name}_entry_box[entry];
    for (k = 0; k < 3; ++k) {
        double ray = asked[k] - middle[k], room = ray > 0 ? middle[6 + k] - middle[k] : middle[k] - middle[3 + k];
        if (ray != 0 && fabs(ray) > share * room) share = fabs(ray) / room;
    }
    if (share > 0) {
        double away[3];
        for (k = 0; k < 3; ++k) away[k] = middle[k] + (asked[k] - middle[k]) / share;
        ${name}_clip(away, asked);
    }
    ${name}_lattice(asked, coefficients);
    for (k = 0; k < ${count}; ++k)
        coefficients[k] = share * coefficients[k] + (1 - share) * ${name}_entry[entry][k];
}

