/* Answers of an exported header, or of uplift.h (-DRUNTIME): linear RGB from standard input, float32,
   reflectances at 400, 410, …, 700 nm to standard output. The argument is the cube file. */
#include <stdio.h>
#ifdef RUNTIME
#define UPLIFT_IMPLEMENTATION
#include "uplift.h"
#else
#include "cube.h"
#endif

int main(int count, char **words)
{
    float rgb[3], at[31], found[31];
    for (int k = 0; k < 31; ++k) at[k] = 400.0f + 10.0f * (float)k;
#ifdef RUNTIME
    int error;
    uplift_cube *cube = uplift_open(words[count - 1], &error);
    if (!cube) return error;
#else
    (void)count, (void)words;
#endif
    while (fread(rgb, sizeof rgb, 1, stdin) == 1) {
#ifdef RUNTIME
        if (uplift_reflectances(cube, rgb, at, 31, found) != UPLIFT_OK) return 99;
#else
        cube_reflectances(rgb, at, 31, found);
#endif
        fwrite(found, sizeof found, 1, stdout);
    }
    return 0;
}
