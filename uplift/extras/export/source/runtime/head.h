/* Spectral uplifting cubes, read at run time: linear RGB in, reflectances out, in single precision.

   Copy this file into your program; it needs nothing but the C library (link with -lm). C99 and C++. One source file has

       #define UPLIFT_IMPLEMENTATION
       #include "uplift.h"

   and all others the second line only. It reads cube files (.uplift) of the format ${format}, of every space, model and
   atlas, and those that were built for a scene. Written by `uplift export --runtime`.

       int error;
       uplift_cube *cube = uplift_open("paints.uplift", &error);
       if (!cube) return puts(uplift_message(error)), 1;
       float rgb[3] = {0.8f, 0.2f, 0.1f}, wavelengths[4] = {450, 500, 550, 600}, reflectances[4];
       uplift_reflectances(cube, rgb, wavelengths, 4, reflectances);
       uplift_close(cube);

   An open cube does not change: any number of threads may use it. Only opening one allocates memory. The file stays open
   and must not be truncated until uplift_close.

   Options, to be defined before the implementation:
   UPLIFT_WIDTH     wavelengths that are evaluated at a time, 16; the last few are in groups of four
   UPLIFT_NO_MMAP   read files into memory instead of mapping them
   UPLIFT_NO_FILES  leave uplift_open out, which needs <stdio.h> or mmap

   BSD 3-Clause License

   Copyright (c) 2026, the uplift developers

   Redistribution and use in source and binary forms, with or without modification, are permitted provided that the
   following conditions are met:

   1. Redistributions of source code must retain the above copyright notice, this list of conditions and the following
      disclaimer.

   2. Redistributions in binary form must reproduce the above copyright notice, this list of conditions and the following
      disclaimer in the documentation and/or other materials provided with the distribution.

   3. Neither the name of the copyright holder nor the names of its contributors may be used to endorse or promote products
      derived from this software without specific prior written permission.

   THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS" AND ANY EXPRESS OR IMPLIED WARRANTIES,
   INCLUDING, BUT NOT LIMITED TO, THE IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE
   DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT HOLDER OR CONTRIBUTORS BE LIABLE FOR ANY DIRECT, INDIRECT, INCIDENTAL,
   SPECIAL, EXEMPLARY, OR CONSEQUENTIAL DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES;
   LOSS OF USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN
   CONTRACT, STRICT LIABILITY, OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE OF THIS
   SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE. */
#ifndef UPLIFT_H
#define UPLIFT_H

#include <stddef.h>

#define UPLIFT_FORMAT ${format} /* newest format of cube files that is read */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct uplift_cube uplift_cube;

/* Results of functions. */
enum {
    UPLIFT_OK,
    UPLIFT_NO_FILE,     /* the file cannot be opened or read */
    UPLIFT_NO_MEMORY,
    UPLIFT_NOT_A_CUBE,  /* another kind of file, or its structure is damaged */
    UPLIFT_VERSION,     /* a format that this reader does not know */
    UPLIFT_FEATURE,     /* an optional part that this reader does not know */
    UPLIFT_DAMAGED,     /* the content does not match its digest */
    UPLIFT_INVALID,     /* values that no cube has */
    UPLIFT_TOO_LARGE,   /* more numbers than this reader can address */
    UPLIFT_UNSUPPORTED, /* a sensor of uneven or more than ${samples} wavelengths, and nodes without their own colours */
    UPLIFT_NOT_IN_SCENE,   /* the cube was built for a scene that has not this colour */
    UPLIFT_NO_ERRORS,      /* the cube has no standard errors */
    UPLIFT_NO_COEFFICIENTS /* next to nodes without their own colours, coefficients are not moved to the colour */
};

/* Open a cube file, or return NULL and set `error`, which may be NULL. */
#ifndef UPLIFT_NO_FILES
uplift_cube *uplift_open(const char *path, int *error);
#endif

/* The same of the bytes of a cube file, which are not copied: keep them until uplift_close. */
uplift_cube *uplift_open_memory(const void *bytes, size_t size, int *error);

/* Release a cube, or do nothing for NULL. */
void uplift_close(uplift_cube *cube);

/* A line about a result. */
const char *uplift_message(int result);

/* Reflectances of linear RGB at `count` wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1], NaN
   becomes 0. Reflectances of colours that are not in the scene of a cube are 0, and the result UPLIFT_NOT_IN_SCENE. */
int uplift_reflectances(
    const uplift_cube *cube, const float rgb[3], const float *wavelengths, int count, float *reflectances);

/* The same of n colours, rgb[n * 3], at the same wavelengths: reflectances[n * count]. */
int uplift_reflectances_n(
    const uplift_cube *cube, const float *rgb, int n, const float *wavelengths, int count, float *reflectances);

/* CIEDE2000 difference that 68 % of measurements of the colour stay within, under the illuminant `reference` of the cube. */
int uplift_standard_error(const uplift_cube *cube, const float rgb[3], float *error);

/* The same for 95 %. */
int uplift_error_bound(const uplift_cube *cube, const float rgb[3], float *error);

/* Numbers of a spectrum of a node: up to ${count}. */
int uplift_coefficient_count(const uplift_cube *cube);

/* Coefficients of linear RGB, uplift_coefficient_count of them: linear in the spectrum, so that they can be filtered. */
int uplift_coefficients(const uplift_cube *cube, const float rgb[3], float *coefficients);

#ifdef __cplusplus
}
#endif
#endif

#ifdef UPLIFT_IMPLEMENTATION
#ifndef UPLIFT_INCLUDED
#define UPLIFT_INCLUDED

#include <math.h>
#include <stdlib.h>
#include <string.h>
#ifndef UPLIFT_NO_FILES
#if !defined(UPLIFT_NO_MMAP) && (defined(__unix__) || defined(__APPLE__))
#define UPLIFT_MMAP
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#else
#include <stdio.h>
#endif
#endif

#ifdef __cplusplus
#define UPLIFT_CAST(type, x) static_cast<type>(x)
#else
#define UPLIFT_CAST(type, x) ((type)(x))
#endif
#ifndef UPLIFT_WIDTH
#define UPLIFT_WIDTH ${width}
#endif
#define UPLIFT_MOST_COUNT ${count} /* coefficients of a spectrum */
#define UPLIFT_SAMPLE_ROOM ${samples}
#define UPLIFT_ARRAYS 64 /* arrays in a file */
#define UPLIFT_DEPTH 64 /* of nested JSON values */
#define UPLIFT_MOST_DIM 512
