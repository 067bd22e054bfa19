/* Rates of a header with compiled-in numbers and of uplift.h: header CUBE COLOURS WAVELENGTHS RUNS REFLECTANCES.

   COLOURS: linear RGB, WAVELENGTHS: nm, both float32. Writes the reflectances of uplift.h, and prints the fewest CPU seconds
   of the runs by both, which take turns. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#define UPLIFT_IMPLEMENTATION
#include "uplift.h"
#include "cube.h"

static double seconds(void) { return clock() / (double)CLOCKS_PER_SEC; }

static float *read_all(const char *path, long *count)
{
    FILE *file = fopen(path, "rb");
    float *numbers;
    if (!file || fseek(file, 0, SEEK_END)) exit(1);
    *count = ftell(file) / (long)sizeof *numbers;
    rewind(file);
    numbers = malloc(*count * sizeof *numbers);
    if (!numbers || fread(numbers, sizeof *numbers, *count, file) != (size_t)*count) exit(1);
    fclose(file);
    return numbers;
}

int main(int count, char **words)
{
    long components, at, colours, i, run;
    float *rgb, *wavelengths, *found;
    double best[2] = {1e9, 1e9}, begin;
    uplift_cube *cube;
    FILE *file;
    if (count != 6) return 1;
    cube = uplift_open(words[1], NULL);
    rgb = read_all(words[2], &components);
    wavelengths = read_all(words[3], &at);
    colours = components / 3;
    found = malloc(colours * at * sizeof *found);
    if (!cube || !found) return 1;
    for (run = 0; run < atol(words[4]); ++run) {
        begin = seconds();
        for (i = 0; i < colours; ++i) cube_reflectances(rgb + 3 * i, wavelengths, (int)at, found + i * at);
        begin = seconds() - begin;
        best[0] = begin < best[0] ? begin : best[0];
        begin = seconds();
        for (i = 0; i < colours; ++i) uplift_reflectances(cube, rgb + 3 * i, wavelengths, (int)at, found + i * at);
        begin = seconds() - begin;
        best[1] = begin < best[1] ? begin : best[1];
    }
    file = fopen(words[5], "wb");
    if (!file || fwrite(found, at * sizeof *found, colours, file) != (size_t)colours || fclose(file)) return 1;
    printf("%g %g\n", best[0], best[1]);
    return 0;
}
