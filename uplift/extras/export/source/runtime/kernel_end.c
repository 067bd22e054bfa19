
/* Find the cell in which the lattice is evaluated for a colour, its lowest corner and the weights of its sides, and the
   entry in whose box the colour lies, or -1. */
static int UP_NAME(place)(const uplift_cube *cube, const float *rgb, float *lattice_weight, float *sides, int *first)
{
    float place[UP_PLACE];
    int entry = UP_NAME(locate)(cube, rgb, place);
    *lattice_weight = place[3];
    *first = UP_NAME(weigh)(cube, place, sides);
    return entry;
}

static const uplift_kernel UP_NAME(functions) = {UP_NAME(reflectances_n), UP_NAME(place)};

#undef UPLIFT_KERNEL
#undef UP_COUNT
#undef UP_STRIDE
#undef UP_SIGMOIDS
#undef UP_INEXACT
#undef UP_PLACE
