/* Rates of an exported mixer: mixer COLOURS RUNS. COLOURS: linear RGB of pairs, float32, each in [0, 1].

   Prints the fewest CPU seconds of the runs of paint_mix, paint_mix_srgb and paint_mix_bytes over all pairs, and of paint_mix
   with the latent of the first colour computed once, which take turns. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "paint.h"

#define PAIRS 20000
#define WAYS 4

static float colours[PAIRS][6], shares[PAIRS], mixed[PAIRS][3], brush[PAINT_SIZE];
static unsigned char bytes[PAIRS][6], mixed_bytes[PAIRS][3];

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void stroke(const float rgb[3], float share, float result[3])
{
    float sum[PAINT_SIZE];
    paint_latent(rgb, sum);
    for (int k = 0; k < PAINT_SIZE; ++k) sum[k] *= 1 - share;
    paint_add(brush, share, sum);
    paint_colour(sum, result);
}

static void mix_all(int way)
{
    for (int i = 0; i < PAIRS; ++i) {
        const float *first = colours[i], *second = colours[i] + 3;
        if (way == 0) paint_mix(first, second, shares[i], mixed[i]);
        if (way == 1) paint_mix_srgb(first, second, shares[i], mixed[i]);
        if (way == 2) paint_mix_bytes(bytes[i], bytes[i] + 3, shares[i], mixed_bytes[i]);
        if (way == 3) stroke(second, shares[i], mixed[i]);
    }
}

int main(int count, char **words)
{
    double best[WAYS] = {1e9, 1e9, 1e9, 1e9};
    FILE *file = count == 3 ? fopen(words[1], "rb") : NULL;
    if (!file || fread(colours, sizeof colours, 1, file) != 1) return 1;
    for (int i = 0; i < PAIRS; ++i) {
        shares[i] = (float)(i % 100) / 99;
        for (int c = 0; c < 6; ++c) bytes[i][c] = paint_byte(colours[i][c]);
    }
    paint_latent(colours[0], brush);
    for (int run = 0; run < atoi(words[2]); ++run)
        for (int way = 0; way < WAYS; ++way) {
            double begin = seconds();
            mix_all(way);
            begin = seconds() - begin;
            best[way] = begin < best[way] ? begin : best[way];
        }
    for (int way = 0; way < WAYS; ++way) printf("%.9g\n", best[way] / PAIRS);
    return mixed[1][0] + mixed_bytes[1][0] < 0;
}
