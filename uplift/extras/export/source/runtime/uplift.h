#include "runtime/head.h"
#include "runtime/file.c"
#include "runtime/content.c"
#include "runtime/table.c"
#include "runtime/build.c"

#include "loops.c"
#include "host.c"
#include "runtime/kernel_macros.h"
${inclusions}
#include "runtime/calls.c"

#ifdef UP_KERNEL

${kernel}
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

static const uplift_kernel UP_NAME(functions) = {UP_NAME(reflectances), UP_NAME(place)};

#undef UPLIFT_KERNEL
#undef UP_COUNT
#undef UP_ENTRY_COUNT
#undef UP_STRIDE
#undef UP_SIGMOIDS
#undef UP_WARPED
#undef UP_INEXACT
#undef UP_PLACE
#undef UP_ROW_OF
#endif

/* clang reports loops by their lines in this file, also of the lookups above: the pragma of the loops ends after them. */
#ifdef UP_POP
#undef UP_POP
#if defined(__clang__)
#pragma clang diagnostic pop
#endif
#endif
