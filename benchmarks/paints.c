/* Time of mixtures of measured paints: prints seconds per mixture, the best of some runs, and the last colour. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "mixer.h"

int main(int argc, char **argv)
{
    enum { COUNT = 20000 };
    static float parts[COUNT][MIXER_PAINTS], rgb[COUNT][3];
    const int runs = argc > 1 ? atoi(argv[1]) : 5;
    double best = 1e30;
    unsigned state = 1;
    for (int i = 0; i < COUNT; ++i)
        for (int paint = 0; paint < MIXER_PAINTS; ++paint) {
            state = state * 1664525u + 1013904223u;
            parts[i][paint] = (float)(state >> 8) + 1.0f;
        }
    for (int run = 0; run < runs; ++run) {
        const clock_t begin = clock();
        for (int i = 0; i < COUNT; ++i) mixer_mix(parts[i], rgb[i]);
        const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC / COUNT;
        if (seconds < best) best = seconds;
    }
    printf("%.9g %.9g\n", best, (double)rgb[COUNT - 1][0]);
    return 0;
}
