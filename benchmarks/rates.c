/* Rates of an exported header on one core: rates COLOURS WAVELENGTHS RUNS REFLECTANCES < nothing.

   COLOURS: linear RGB, WAVELENGTHS: nm, both float32. Writes reflectances of the first colours at all wavelengths, then
   prints the fewest CPU seconds of the runs: lookups one by one, many in one call, evaluation of stored multipliers, and
   with shared cosines. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "cube.h"

#define CHECKED 10000
#define RAY 16

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
    long components, at, colours, i, k, run, runs;
    float *rgb, *wavelengths, *found, *rays, *multipliers;
    double best[4] = {1e9, 1e9, 1e9, 1e9}, begin, sum = 0;
    FILE *file;
    if (count != 5) return 1;
    rgb = read_all(words[1], &components);
    wavelengths = read_all(words[2], &at);
    runs = atol(words[3]);
    colours = components / 3;
    found = malloc((colours * RAY + CHECKED * at) * sizeof *found);
    for (i = 0; i < CHECKED; ++i) cube_reflectances(rgb + 3 * i, wavelengths, at, found + at * i);
    file = fopen(words[4], "wb");
    if (!file || fwrite(found, sizeof *found, CHECKED * at, file) != (size_t)(CHECKED * at)) return 1;
    fclose(file);
    rays = malloc(colours * RAY * sizeof *rays); /* every ray has wavelengths of its own */
    for (i = 0; i < colours; ++i)
        for (k = 0; k < RAY; ++k) rays[RAY * i + k] = 400 + 20 * k + (i % 97) * 0.2f;
    multipliers = malloc(colours * CUBE_COUNT * sizeof *multipliers);
    for (i = 0; i < colours * CUBE_COUNT; ++i) multipliers[i] = 20 * (rgb[i % components] - 0.5f);
    for (run = 0; run < runs; ++run) {
        float basis[CUBE_COUNT * CUBE_WIDTH];
        begin = seconds();
        for (i = 0; i < colours; ++i) cube_reflectances(rgb + 3 * i, rays + RAY * i, RAY, found + RAY * i);
        if (seconds() - begin < best[0]) best[0] = seconds() - begin;
        sum += found[run];
        begin = seconds();
        cube_reflectances_n(rgb, (int)colours, rays, RAY, found);
        if (seconds() - begin < best[1]) best[1] = seconds() - begin;
        sum += found[run];
        begin = seconds();
        for (i = 0; i < colours; ++i)
            cube_evaluate(multipliers + CUBE_COUNT * i, rays + RAY * i, RAY, found + RAY * i);
        if (seconds() - begin < best[2]) best[2] = seconds() - begin;
        sum += found[run];
        cube_tabulate(rays, basis);
        begin = seconds();
        for (i = 0; i < colours; ++i) cube_evaluate_block(multipliers + CUBE_COUNT * i, basis, found + RAY * i);
        if (seconds() - begin < best[3]) best[3] = seconds() - begin;
        sum += found[run];
    }
    printf("%.9g %.9g %.9g %.9g %g\n", best[0], best[1], best[2], best[3], sum);
    return 0;
}
