/* Position of the list of entries whose boxes touch the cell above a lattice point, 0 for none; it is negative where
   answers in the cell are moved. Its fraction is 1/2 at points where coefficients are moved, 0 at others. */
UP_FUNCTION float up_tag(UP_READS int index)
{
    return up_number(UP_TABLE UP_ROW_OF(index) * UP_STRIDE + UP_COUNT);
}

/* Clip to [0, 1]. */
UP_FUNCTION float up_clip(float x)
{
    return x > 0.0f ? (x > 1.0f ? 1.0f : x) : 0.0f;
}

/* Clip a component of a colour to [0, 1]; NaN becomes 0. It is judged by its bits, as compilers may be told that nothing is
   NaN. */
UP_FUNCTION float up_component(UP_IN float rgb[3], int axis)
{
    UP_BITS(bits, rgb[axis]);
    return bits <= 0x3f800000u ? rgb[axis] : bits <= 0x7f800000u ? 1.0f : 0.0f;
}

/* Row of the lowest corner of a colour's cell. The colour becomes its fractions t of the cell, in [0, 1] along each axis:
   t = (x - node) / (next node - node). A cell has four numbers in the table: both nodes, the last next one at infinity, and
   the reciprocal of the step. */
UP_FUNCTION int up_enter(UP_READS UP_OUT float colour[3])
{
    int corner = 0;
    for (int axis = 0; axis < 3; ++axis) {
        int bin = UP_BINS + UP_INT(colour[axis] * UP_REAL(UP_BIN_COUNT));
        int cell = UP_INT(up_number(UP_TABLE bin));
        while (colour[axis] >= up_number(UP_TABLE UP_CELLS + 4 * cell + 1)) cell += 1;
        float beyond = colour[axis] - up_number(UP_TABLE UP_CELLS + 4 * cell);
        float share = beyond * up_number(UP_TABLE UP_CELLS + 4 * cell + 2);
        colour[axis] = share < 1.0f ? share : 1.0f;
        corner = corner * UP_DIM + cell;
    }
    return corner;
}

/* Set the nodes of the tetrahedron in which fractions of a cell lie, and their weights: from the lowest corner a step along
   each axis, by decreasing fraction, ties in the order red, green, blue. Weights are 1 - t_1, t_1 - t_2, t_2 - t_3, t_3.
   No branches, which processors could not predict. */
UP_FUNCTION void up_divide(UP_READS_CUBE int corner, UP_IN float t[3], UP_OUT int nodes[4], UP_OUT float place[UP_PLACE])
{
    int red = UP_DIM * UP_DIM, green = UP_DIM, blue = 1;
    int red_green = t[0] >= t[1] ? 1 : 0, red_blue = t[0] >= t[2] ? 1 : 0, green_blue = t[1] >= t[2] ? 1 : 0;
    int green_red = 1 - red_green, blue_red = 1 - red_blue, blue_green = 1 - green_blue;
    float most = t[0] > t[1] ? t[0] : t[1], least = t[0] > t[1] ? t[1] : t[0];
    float first = most > t[2] ? most : t[2], rest = most > t[2] ? t[2] : most;
    float second = least > rest ? least : rest, third = least > rest ? rest : least;
    nodes[0] = corner;
    nodes[3] = corner + red + green + blue;
    nodes[1] = nodes[0] + red * (red_green & red_blue) + green * (green_red & green_blue) + blue * (blue_red & blue_green);
    nodes[2] = nodes[3] - red * (green_red & blue_red) - green * (red_green & blue_green) - blue * (red_blue & green_blue);
    place[0] = 1.0f - first;
    place[1] = first - second;
    place[2] = second - third;
    place[3] = third;
}

/* Find the entry of a list in whose box a colour lies, or -1. Move the colour x to y, where the ray from the entry's colour
   e through x leaves the box, and set place[4] to t: x = (1 - t) e + t y. Each axis of a box has four numbers in the table:
   the centre, what rounding left of it, and the reciprocals of its distances to the lower and the upper face. */
UP_FUNCTION int up_leave(UP_READS int listed, UP_OUT float colour[3], UP_OUT float place[UP_PLACE])
{
    int entry = -1, last = listed + UP_INT(up_number(UP_TABLE UP_LISTS + listed));
    while (listed < last) {
        listed += 1;
        int candidate = UP_INT(up_number(UP_TABLE UP_LISTS + listed));
        float reached = 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
            int box = UP_BOXES + 12 * candidate + 4 * axis;
            float ray = colour[axis] - up_number(UP_TABLE box) - up_number(UP_TABLE box + 1);
            float above = ray * up_number(UP_TABLE box + 3), below = -ray * up_number(UP_TABLE box + 2);
            reached = above > reached ? above : reached;
            reached = below > reached ? below : reached;
        }
        if (reached < 1.0f) {
            entry = candidate;
            place[4] = reached;
            listed = last;
        }
    }
    if (entry >= 0 && place[4] > 0.0f)
        for (int axis = 0; axis < 3; ++axis) {
            int box = UP_BOXES + 12 * entry + 4 * axis;
            float ray = colour[axis] - up_number(UP_TABLE box) - up_number(UP_TABLE box + 1);
            colour[axis] = up_clip(up_number(UP_TABLE box) + ray / place[4]);
        }
    return entry;
}

/* Find the entry in whose box a colour lies, or -1; set the nodes of the lattice around the colour, or around that at which
   it leaves the box, their weights, the weight of the lattice, and, where answers may be moved, the tag of the cell. */
UP_FUNCTION int up_locate(UP_READS UP_IN float rgb[3], UP_OUT int nodes[4], UP_OUT float place[UP_PLACE])
{
    UP_ARRAY(colour, 3);
    UP_ARRAY(share, 3);
    int entry = -1;
    for (int axis = 0; axis < 3; ++axis) colour[axis] = share[axis] = up_component(rgb, axis);
    int corner = up_enter(UP_TABLE share), listed = UP_INT(UP_ABS(up_tag(UP_TABLE corner)));
    place[4] = 1.0f;
    if (listed > 0) entry = up_leave(UP_TABLE listed, colour, place);
    if (entry >= 0) {
        for (int axis = 0; axis < 3; ++axis) share[axis] = colour[axis];
        corner = up_enter(UP_TABLE share);
    }
    up_divide(UP_CUBE corner, share, nodes, place);
#if UP_INEXACT
    place[5] = up_tag(UP_TABLE corner);
#endif
    return entry;
}

