/* Spectral uplifting cubes, read at run time: linear RGB in, reflectances out, in single precision.

   Copy this file into your program; it needs nothing but the C library (link with -lm). C99 and C++. One source file has

       #define UPLIFT_IMPLEMENTATION
       #include "uplift.h"

   and all others the second line only. It reads cube files (.uplift) of the formats 3 and 4, of every space, model and
   atlas, and those that were built for a scene. Written by `uplift export --runtime`.

       int error;
       uplift_cube *cube = uplift_open("paints.uplift", &error);
       if (!cube) return puts(uplift_message(error)), 1;
       float rgb[3] = {0.8f, 0.2f, 0.1f}, wavelengths[4] = {450, 500, 550, 600}, reflectances[4];
       uplift_reflectances(cube, rgb, wavelengths, 4, reflectances);
       uplift_close(cube);

   An open cube does not change: any number of threads may use it. Only uplift_open allocates memory. The file stays open
   and must not be truncated until uplift_close.

   Options, to be defined before the implementation:
   UPLIFT_WIDTH     wavelengths that are evaluated at a time, 16; 4 or 8 if rays have as few
   UPLIFT_FILE      name of this file, "uplift.h", if it has another
   UPLIFT_NO_MMAP   read files into memory instead of mapping them

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

#define UPLIFT_FORMAT 4 /* newest format of cube files that is read */

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
    UPLIFT_UNSUPPORTED, /* a sensor of uneven or more than 512 wavelengths, and nodes without their own colours */
    UPLIFT_NOT_IN_SCENE,   /* the cube was built for a scene that has not this colour */
    UPLIFT_NO_ERRORS,      /* the cube has no standard errors */
    UPLIFT_NO_COEFFICIENTS /* next to nodes without their own colours, coefficients are not moved to the colour */
};

/* Open a cube file, or return NULL and set `error`, which may be NULL. */
uplift_cube *uplift_open(const char *path, int *error);

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

/* Numbers of a spectrum of a node: up to 17. */
int uplift_coefficient_count(const uplift_cube *cube);

/* Coefficients of linear RGB, uplift_coefficient_count of them: linear in the spectrum, so that they can be filtered. */
int uplift_coefficients(const uplift_cube *cube, const float rgb[3], float *coefficients);

#ifdef __cplusplus
}
#endif
#endif

#if defined(UPLIFT_IMPLEMENTATION) && !defined(UPLIFT_KERNEL)
#ifndef UPLIFT_INCLUDED
#define UPLIFT_INCLUDED

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if !defined(UPLIFT_NO_MMAP) && (defined(__unix__) || defined(__APPLE__))
#define UPLIFT_MMAP
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#ifdef __cplusplus
#define UPLIFT_CAST(type, x) static_cast<type>(x)
#else
#define UPLIFT_CAST(type, x) ((type)(x))
#endif
#ifndef UPLIFT_WIDTH
#define UPLIFT_WIDTH 16
#endif
#ifndef UPLIFT_FILE
#define UPLIFT_FILE "uplift.h"
#endif
#define UPLIFT_MOST_COUNT 17 /* coefficients of a spectrum */
#define UPLIFT_SAMPLE_ROOM 512
#define UPLIFT_ARRAYS 64 /* arrays in a file */
#define UPLIFT_DEPTH 64 /* of nested JSON values */
#define UPLIFT_MOST_DIM 512

/* Bytes of a file: mapped where the platform has mmap. */
typedef struct {
    unsigned char *bytes;
    size_t size;
} uplift_bytes;

#ifdef UPLIFT_MMAP

static void uplift_release(uplift_bytes *file)
{
    if (file->bytes) munmap(file->bytes, file->size);
    file->bytes = NULL;
}

static int uplift_acquire(const char *path, uplift_bytes *file)
{
    struct stat about;
    void *mapped = MAP_FAILED;
    int descriptor = open(path, O_RDONLY);
    int is_file = descriptor >= 0 && fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
    if (is_file && about.st_size > 0) {
        file->size = UPLIFT_CAST(size_t, about.st_size);
        mapped = mmap(NULL, file->size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    }
    if (descriptor >= 0) close(descriptor);
    if (is_file && about.st_size == 0) return UPLIFT_NOT_A_CUBE;
    if (mapped == MAP_FAILED) return UPLIFT_NO_FILE;
    file->bytes = UPLIFT_CAST(unsigned char *, mapped);
    return UPLIFT_OK;
}

#else

static void uplift_release(uplift_bytes *file)
{
    free(file->bytes);
    file->bytes = NULL;
}

static int uplift_acquire(const char *path, uplift_bytes *file)
{
    int result = UPLIFT_OK;
    size_t room = 1 << 16;
    FILE *stream = fopen(path, "rb");
    if (!stream) return UPLIFT_NO_FILE;
    file->bytes = UPLIFT_CAST(unsigned char *, malloc(room));
    if (!file->bytes) result = UPLIFT_NO_MEMORY;
    while (result == UPLIFT_OK) {
        unsigned char *larger;
        size_t got = fread(file->bytes + file->size, 1, room - file->size, stream);
        file->size += got;
        if (file->size < room) {
            if (ferror(stream)) result = UPLIFT_NO_FILE;
            break;
        }
        larger = room > UPLIFT_CAST(size_t, -1) / 2
            ? NULL : UPLIFT_CAST(unsigned char *, realloc(file->bytes, 2 * room));
        if (!larger) result = UPLIFT_NO_MEMORY;
        else file->bytes = larger;
        room *= 2;
    }
    fclose(stream);
    return result;
}

#endif

/* A little-endian whole number of up to eight bytes. */
static unsigned long long uplift_word(const unsigned char *bytes, int size)
{
    unsigned long long word = 0;
    for (int k = size - 1; k >= 0; --k) word = word << 8 | bytes[k];
    return word;
}

/* SHA-256, FIPS 180-4. */
typedef struct {
    unsigned int state[8];
    unsigned char block[64];
    unsigned long long length;
} uplift_hash;

static const unsigned int uplift_round_constants[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

static unsigned int uplift_turn(unsigned int x, int bits)
{
    return x >> bits | x << (32 - bits);
}

static void uplift_hash_block(uplift_hash *hash, const unsigned char *block)
{
    unsigned int words[64], s[8];
    for (int k = 0; k < 16; ++k)
        words[k] = UPLIFT_CAST(unsigned int, block[4 * k]) << 24 | UPLIFT_CAST(unsigned int, block[4 * k + 1]) << 16
            | UPLIFT_CAST(unsigned int, block[4 * k + 2]) << 8 | block[4 * k + 3];
    for (int k = 16; k < 64; ++k) {
        unsigned int low = words[k - 15], high = words[k - 2];
        low = uplift_turn(low, 7) ^ uplift_turn(low, 18) ^ low >> 3;
        high = uplift_turn(high, 17) ^ uplift_turn(high, 19) ^ high >> 10;
        words[k] = words[k - 16] + low + words[k - 7] + high;
    }
    memcpy(s, hash->state, sizeof s);
    for (int k = 0; k < 64; ++k) {
        unsigned int choice = (s[4] & s[5]) ^ (~s[4] & s[6]);
        unsigned int majority = (s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]);
        unsigned int first = uplift_turn(s[4], 6) ^ uplift_turn(s[4], 11) ^ uplift_turn(s[4], 25);
        unsigned int second = uplift_turn(s[0], 2) ^ uplift_turn(s[0], 13) ^ uplift_turn(s[0], 22);
        first += s[7] + choice + uplift_round_constants[k] + words[k];
        second += majority;
        memmove(s + 1, s, 7 * sizeof *s);
        s[4] += first;
        s[0] = first + second;
    }
    for (int k = 0; k < 8; ++k) hash->state[k] += s[k];
}

static void uplift_hash_start(uplift_hash *hash)
{
    static const unsigned int start[8] = {
    0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    memcpy(hash->state, start, sizeof start);
    hash->length = 0;
}

static void uplift_hash_add(uplift_hash *hash, const unsigned char *bytes, size_t size)
{
    size_t held = UPLIFT_CAST(size_t, hash->length % 64);
    hash->length += size;
    while (size > 0) {
        size_t count = size < 64 - held ? size : 64 - held;
        if (held == 0 && count == 64) {
            uplift_hash_block(hash, bytes);
        } else {
            memcpy(hash->block + held, bytes, count);
            if (held + count == 64) uplift_hash_block(hash, hash->block);
        }
        held = (held + count) % 64;
        bytes += count;
        size -= count;
    }
}

/* Set the 64 hexadecimal digits of the hash. */
static void uplift_hash_end(uplift_hash *hash, char digits[64])
{
    unsigned char end[72] = {0x80};
    size_t padding = 1 + UPLIFT_CAST(size_t, (119 - hash->length % 64) % 64);
    unsigned long long bits = hash->length * 8;
    for (int k = 0; k < 8; ++k) end[padding + 7 - UPLIFT_CAST(size_t, k)] = UPLIFT_CAST(unsigned char, bits >> 8 * k & 255);
    uplift_hash_add(hash, end, padding + 8);
    for (int k = 0; k < 64; ++k) digits[k] = "0123456789abcdef"[hash->state[k / 8] >> (28 - 4 * (k % 8)) & 15];
}

/* JSON: a position in a text that is read value by value. `failed` stays set after the first mistake, and the position
   at the end. */
typedef struct {
    const char *at, *end;
    int failed;
} uplift_json;

/* A string between its quotes, as it is written. */
typedef struct {
    const char *text;
    size_t length;
} uplift_string;

static int uplift_is(uplift_string string, const char *word)
{
    return string.length == strlen(word) && memcmp(string.text, word, string.length) == 0;
}

static void uplift_fail(uplift_json *json)
{
    json->failed = 1;
    json->at = json->end;
}

/* The next character after blanks, 0 at the end. */
static char uplift_peek(uplift_json *json)
{
    while (json->at < json->end && (*json->at == ' ' || *json->at == '\t' || *json->at == '\n' || *json->at == '\r'))
        json->at += 1;
    return UPLIFT_CAST(char, json->at < json->end ? *json->at : 0);
}

/* Whether a character comes next; it is then read. */
static int uplift_take(uplift_json *json, char character)
{
    if (uplift_peek(json) != character) return 0;
    json->at += json->at < json->end;
    return !json->failed;
}

static void uplift_expect(uplift_json *json, char character)
{
    if (!uplift_take(json, character)) uplift_fail(json);
}

static uplift_string uplift_read_string(uplift_json *json)
{
    uplift_string string = {"", 0};
    const char *start;
    uplift_expect(json, '"');
    start = json->at;
    while (json->at < json->end && *json->at != '"') {
        if (UPLIFT_CAST(unsigned char, *json->at) < 32) uplift_fail(json);
        else json->at += *json->at == '\\' && json->end - json->at > 1 ? 2 : 1;
    }
    if (json->at < json->end) {
        string.text = start;
        string.length = UPLIFT_CAST(size_t, json->at - start);
    }
    uplift_expect(json, '"');
    return string;
}

/* Begin the next key of a table, or the next item of a list, after its opening bracket; 0 after the last one. */
static int uplift_next(uplift_json *json, int *count, char closing)
{
    if (uplift_take(json, closing)) return 0;
    if (*count > 0) uplift_expect(json, ',');
    *count += 1;
    return !json->failed;
}

static uplift_string uplift_read_key(uplift_json *json)
{
    uplift_string key = uplift_read_string(json);
    uplift_expect(json, ':');
    return key;
}

/* A number, whatever the locale: strtod is not used. */
static double uplift_read_number(uplift_json *json)
{
    double value = 0, scale = 1;
    int digits = 0, exponent = 0, stated = 0, is_negative, is_shrinking;
    uplift_peek(json);
    is_negative = uplift_take(json, '-');
    for (; json->at < json->end && *json->at >= '0' && *json->at <= '9'; ++json->at, ++digits)
        value = value * 10 + (*json->at - '0');
    if (json->at < json->end && *json->at == '.')
        for (++json->at; json->at < json->end && *json->at >= '0' && *json->at <= '9'; ++json->at, ++digits)
            if (value < 1e17) {
                value = value * 10 + (*json->at - '0');
                exponent -= 1;
            }
    if (digits == 0 || digits > 400) uplift_fail(json);
    if (json->at < json->end && (*json->at == 'e' || *json->at == 'E')) {
        json->at += 1;
        is_shrinking = json->at < json->end && *json->at == '-';
        json->at += json->at < json->end && (*json->at == '-' || *json->at == '+');
        for (; json->at < json->end && *json->at >= '0' && *json->at <= '9'; ++json->at)
            stated = stated < 1000 ? stated * 10 + (*json->at - '0') : stated;
        exponent += is_shrinking ? -stated : stated;
    }
    for (int k = exponent < 0 ? -exponent : exponent; k > 0 && scale < 1e300; --k) scale *= 10;
    value = exponent < 0 ? value / scale : value * scale;
    return is_negative ? -value : value;
}

/* A whole number from 0 to 2^53. */
static unsigned long long uplift_read_size(uplift_json *json)
{
    unsigned long long value = 0;
    int digits = 0;
    uplift_peek(json);
    for (; json->at < json->end && *json->at >= '0' && *json->at <= '9'; ++json->at, ++digits) {
        value = value * 10 + UPLIFT_CAST(unsigned long long, *json->at - '0');
        if (value > 1ULL << 53) uplift_fail(json);
    }
    if (digits == 0) uplift_fail(json);
    return json->failed ? 0 : value;
}

/* Read a value of any type. */
static void uplift_skip(uplift_json *json, int depth)
{
    static const char *const words[] = {"true", "false", "null"};
    int count = 0;
    char next = uplift_peek(json);
    if (depth == 0) {
        uplift_fail(json);
    } else if (next == '{') {
        json->at += 1;
        while (uplift_next(json, &count, '}')) {
            uplift_read_key(json);
            uplift_skip(json, depth - 1);
        }
    } else if (next == '[') {
        json->at += 1;
        while (uplift_next(json, &count, ']')) uplift_skip(json, depth - 1);
    } else if (next == '"') {
        uplift_read_string(json);
    } else if (next == '-' || (next >= '0' && next <= '9')) {
        uplift_read_number(json);
    } else {
        for (int k = 0; k < 3; ++k) {
            size_t length = strlen(words[k]);
            if (UPLIFT_CAST(size_t, json->end - json->at) >= length && memcmp(json->at, words[k], length) == 0) {
                json->at += length;
                return;
            }
        }
        uplift_fail(json);
    }
}

/* Read a list and return how many items it has. */
static int uplift_read_length(uplift_json *json)
{
    int count = 0;
    uplift_expect(json, '[');
    while (uplift_next(json, &count, ']')) uplift_skip(json, UPLIFT_DEPTH);
    return count;
}

static int uplift_hex(uplift_json *json)
{
    int value = 0;
    for (int k = 0; k < 4; ++k) {
        char c = UPLIFT_CAST(char, json->at < json->end ? *json->at++ : 0);
        int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
        if (digit < 0) uplift_fail(json);
        value = value * 16 + (digit < 0 ? 0 : digit);
    }
    return value;
}

/* Write the text that a string stands for, which is not longer; return its length, or 0 if an escape is not valid. */
static size_t uplift_unescape(uplift_string string, char *text)
{
    static const char escapes[] = "\"\\/bfnrt", characters[] = "\"\\/\b\f\n\r\t";
    uplift_json json = {string.text, string.text + string.length, 0};
    char *out = text;
    while (json.at < json.end) {
        char c = *json.at++;
        const char *escape;
        if (c != '\\') {
            *out++ = c;
            continue;
        }
        c = UPLIFT_CAST(char, json.at < json.end ? *json.at++ : 0);
        escape = c ? strchr(escapes, c) : NULL;
        if (escape) {
            *out++ = characters[escape - escapes];
        } else if (c == 'u') {
            int code = uplift_hex(&json);
            if (code >= 0xD800 && code < 0xDC00 && json.end - json.at > 1 && json.at[0] == '\\' && json.at[1] == 'u') {
                int low;
                json.at += 2;
                low = uplift_hex(&json);
                if (low < 0xDC00 || low > 0xDFFF) uplift_fail(&json);
                code = 0x10000 + (code - 0xD800) * 0x400 + (low & 0x3FF);
            } else if (code >= 0xD800 && code < 0xE000) {
                uplift_fail(&json);
            }
            if (code < 0x80) {
                *out++ = UPLIFT_CAST(char, code);
            } else if (code < 0x800) {
                *out++ = UPLIFT_CAST(char, 0xC0 | code >> 6);
            } else if (code < 0x10000) {
                *out++ = UPLIFT_CAST(char, 0xE0 | code >> 12);
                *out++ = UPLIFT_CAST(char, 0x80 | (code >> 6 & 0x3F));
            } else {
                *out++ = UPLIFT_CAST(char, 0xF0 | code >> 18);
                *out++ = UPLIFT_CAST(char, 0x80 | (code >> 12 & 0x3F));
                *out++ = UPLIFT_CAST(char, 0x80 | (code >> 6 & 0x3F));
            }
            if (code >= 0x80) *out++ = UPLIFT_CAST(char, 0x80 | (code & 0x3F));
        } else {
            uplift_fail(&json);
        }
    }
    return json.failed ? 0 : UPLIFT_CAST(size_t, out - text);
}

/* Arrays of a file, in the order of their names. */
enum { UPLIFT_F64, UPLIFT_F32, UPLIFT_U8, UPLIFT_I32, UPLIFT_I16, UPLIFT_U32, UPLIFT_TYPES };

typedef struct {
    uplift_string name;
    int type, rank;
    unsigned long long shape[4], length, begin, end;
    const unsigned char *bytes;
} uplift_array;

typedef struct {
    uplift_bytes file;
    uplift_array arrays[UPLIFT_ARRAYS];
    int array_count;
    char *text; /* of the metadata */
    size_t text_length;
    uplift_string digest, digest_entry;
    unsigned int features;
    int version, is_sigmoid, entries, outside, looks;
    unsigned long long dim, count, entry_count;
    double start, end, threshold, bound_factor;
    uplift_string warp;
} uplift_content;

static const char *const uplift_features[] = {"debug", "errors", "left-out", "camera", "sparse", "outside", "outside-measured", "families"};
enum { UPLIFT_DEBUG, UPLIFT_ERRORS, UPLIFT_LEFT_OUT, UPLIFT_CAMERA, UPLIFT_SPARSE };

static int uplift_has(const uplift_content *content, int feature)
{
    return UPLIFT_CAST(int, content->features >> feature & 1);
}

static int uplift_item_size(int type)
{
    static const int sizes[UPLIFT_TYPES] = {8, 4, 1, 4, 2, 4};
    return sizes[type];
}

/* A number of an array. */
static double uplift_number_at(const uplift_array *array, size_t index)
{
    int size = uplift_item_size(array->type);
    unsigned long long word = uplift_word(array->bytes + index * UPLIFT_CAST(size_t, size), size);
    if (array->type == UPLIFT_F64) {
        double value;
        memcpy(&value, &word, sizeof value);
        return value;
    }
    if (array->type == UPLIFT_F32) {
        unsigned int half = UPLIFT_CAST(unsigned int, word);
        float value;
        memcpy(&value, &half, sizeof value);
        return value;
    }
    if (array->type == UPLIFT_I32) return word > 0x7FFFFFFF ? UPLIFT_CAST(double, word) - 4294967296.0 : UPLIFT_CAST(double, word);
    if (array->type == UPLIFT_I16) return word > 0x7FFF ? UPLIFT_CAST(double, word) - 65536.0 : UPLIFT_CAST(double, word);
    return UPLIFT_CAST(double, word);
}

/* Compare names as bytes, which is the order of their characters. */
static int uplift_compare(uplift_string one, uplift_string other)
{
    size_t length = one.length < other.length ? one.length : other.length;
    int order = length ? memcmp(one.text, other.text, length) : 0;
    return order ? order : (one.length > other.length) - (one.length < other.length);
}

/* Read the description of an array: {"dtype": "F64", "shape": [2, 3], "data_offsets": [0, 48]}. */
static void uplift_read_array(uplift_json *json, uplift_array *array)
{
    static const char *const types[UPLIFT_TYPES] = {"F64", "F32", "U8", "I32", "I16", "U32"};
    unsigned long long length = 1;
    int count = 0, keys = 0;
    array->type = -1;
    uplift_expect(json, '{');
    while (uplift_next(json, &count, '}')) {
        uplift_string key = uplift_read_key(json);
        if (uplift_is(key, "dtype")) {
            uplift_string type = uplift_read_string(json);
            for (int k = 0; k < UPLIFT_TYPES; ++k)
                if (uplift_is(type, types[k])) array->type = k;
            keys |= 1;
        } else if (uplift_is(key, "shape")) {
            int axis = 0;
            uplift_expect(json, '[');
            while (uplift_next(json, &axis, ']')) {
                unsigned long long size = uplift_read_size(json);
                if (axis > 4 || (size > 0 && length > (1ULL << 50) / size)) {
                    uplift_fail(json);
                } else {
                    array->shape[axis - 1] = size;
                    length *= size;
                }
            }
            array->rank = axis < 4 ? axis : 4;
            keys |= 2;
        } else if (uplift_is(key, "data_offsets")) {
            uplift_expect(json, '[');
            array->begin = uplift_read_size(json);
            uplift_expect(json, ',');
            array->end = uplift_read_size(json);
            uplift_expect(json, ']');
            keys |= 4;
        } else {
            uplift_fail(json);
        }
    }
    array->length = length;
    if (count != 3 || keys != 7 || array->type < 0 || array->begin > array->end) uplift_fail(json);
    else if (array->end - array->begin != length * UPLIFT_CAST(unsigned, uplift_item_size(array->type))) uplift_fail(json);
}

/* Copy the text of the metadata: {"uplift": "..."}. */
static int uplift_copy_text(uplift_json *json, uplift_content *content)
{
    uplift_string key, text;
    uplift_expect(json, '{');
    key = uplift_read_key(json);
    text = uplift_read_string(json);
    uplift_expect(json, '}');
    if (json->failed || content->text || !uplift_is(key, "uplift")) return UPLIFT_NOT_A_CUBE;
    content->text = UPLIFT_CAST(char *, malloc(text.length + 1));
    if (!content->text) return UPLIFT_NO_MEMORY;
    content->text_length = uplift_unescape(text, content->text);
    return UPLIFT_OK;
}

/* Read the header of the container, a safetensors file, and sort its arrays. They must fill the rest of the file. */
static int uplift_read_header(uplift_content *content)
{
    const unsigned char *bytes = content->file.bytes;
    size_t size = content->file.size;
    unsigned long long length = size < 8 ? 0 : uplift_word(bytes, 8), total = 0;
    uplift_json json;
    int count = 0, result = UPLIFT_OK;
    if (size < 8 || length > size - 8) return UPLIFT_NOT_A_CUBE;
    json.at = UPLIFT_CAST(const char *, UPLIFT_CAST(const void *, bytes + 8));
    json.end = json.at + length;
    json.failed = 0;
    uplift_expect(&json, '{');
    while (result == UPLIFT_OK && uplift_next(&json, &count, '}')) {
        uplift_array array;
        int place = content->array_count;
        memset(&array, 0, sizeof array);
        array.name = uplift_read_key(&json);
        if (uplift_is(array.name, "__metadata__")) {
            result = uplift_copy_text(&json, content);
            continue;
        }
        uplift_read_array(&json, &array);
        if (array.name.length > 64 || memchr(array.name.text, '\\', array.name.length)) uplift_fail(&json);
        if (json.failed || place == UPLIFT_ARRAYS || array.end > size - 8 - length) return UPLIFT_NOT_A_CUBE;
        array.bytes = bytes + 8 + length + array.begin;
        total += array.end - array.begin;
        for (; place > 0 && uplift_compare(content->arrays[place - 1].name, array.name) >= 0; --place) {
            if (uplift_compare(content->arrays[place - 1].name, array.name) == 0) return UPLIFT_NOT_A_CUBE;
            content->arrays[place] = content->arrays[place - 1];
        }
        content->arrays[place] = array;
        content->array_count += 1;
    }
    if (result != UPLIFT_OK) return result;
    if (json.failed || uplift_peek(&json) || !content->text_length || total != size - 8 - length) return UPLIFT_NOT_A_CUBE;
    for (int k = 0; k < content->array_count; ++k)
        for (int other = 0; other < k; ++other) {
            const uplift_array *one = content->arrays + k, *two = content->arrays + other;
            if (one->begin < two->end && two->begin < one->end) return UPLIFT_NOT_A_CUBE;
        }
    return UPLIFT_OK;
}

/* A model: its kind, number of coefficients and range of wavelengths. */
static void uplift_read_model(uplift_json *json, uplift_content *content, unsigned long long *count)
{
    uplift_string name = {"", 0};
    int keys = 0;
    *count = 3;
    uplift_expect(json, '{');
    while (uplift_next(json, &keys, '}')) {
        uplift_string key = uplift_read_key(json);
        if (uplift_is(key, "name")) {
            name = uplift_read_string(json);
        } else if (uplift_is(key, "count")) {
            *count = uplift_read_size(json);
        } else if (uplift_is(key, "start")) {
            content->start = uplift_read_number(json);
        } else if (uplift_is(key, "end")) {
            content->end = uplift_read_number(json);
        } else if (uplift_is(key, "phase")) {
            int parts = 0;
            uplift_expect(json, '{');
            while (uplift_next(json, &parts, '}')) {
                uplift_string part = uplift_read_key(json);
                if (uplift_is(part, "start")) content->start = uplift_read_number(json);
                else if (uplift_is(part, "end")) content->end = uplift_read_number(json);
                else if (uplift_is(part, "warp")) content->warp = uplift_read_string(json);
                else uplift_fail(json);
            }
        } else {
            uplift_fail(json);
        }
    }
    content->is_sigmoid = uplift_is(name, "sigmoid");
    if (!content->is_sigmoid && !uplift_is(name, "moments")) uplift_fail(json);
}

static int uplift_read_features(uplift_json *json, uplift_content *content)
{
    const int known = UPLIFT_CAST(int, sizeof uplift_features / sizeof *uplift_features);
    int count = 0, result = UPLIFT_OK;
    uplift_expect(json, '[');
    while (uplift_next(json, &count, ']')) {
        uplift_string name = uplift_read_string(json);
        int feature = 0;
        while (feature < known && !uplift_is(name, uplift_features[feature])) feature += 1;
        if (feature < known) content->features |= 1U << feature;
        else result = UPLIFT_FEATURE;
    }
    return result;
}

static void uplift_read_provenance(uplift_json *json, uplift_content *content)
{
    int count = 0;
    uplift_expect(json, '{');
    while (uplift_next(json, &count, '}')) {
        uplift_string key = uplift_read_key(json);
        if (uplift_is(key, "left_out")) {
            content->outside = uplift_read_length(json);
        } else if (uplift_is(key, "looks")) {
            content->looks = uplift_read_length(json);
        } else if (uplift_is(key, "prior")) {
            int parts = 0;
            uplift_expect(json, '{');
            while (uplift_next(json, &parts, '}')) {
                if (uplift_is(uplift_read_key(json), "error_bound")) content->bound_factor = uplift_read_number(json);
                else uplift_skip(json, UPLIFT_DEPTH);
            }
        } else {
            uplift_skip(json, UPLIFT_DEPTH);
        }
    }
}

/* Read the metadata. */
static int uplift_read_metadata(uplift_content *content)
{
    uplift_json json = {content->text, content->text + content->text_length, 0};
    uplift_string before = {"", 0}, format = {"", 0};
    unsigned long long version = 0;
    int count = 0, feature_result = UPLIFT_OK, has_entry_model = 0;
    double end = 0, start = 0;
    uplift_string warp = {"", 0};
    content->bound_factor = 2;
    uplift_expect(&json, '{');
    while (uplift_next(&json, &count, '}')) {
        const char *first = json.at;
        uplift_string key = uplift_read_key(&json);
        if (count > 1 && uplift_compare(before, key) >= 0) uplift_fail(&json);
        before = key;
        if (uplift_is(key, "digest")) {
            content->digest = uplift_read_string(&json);
            content->digest_entry.text = first;
            content->digest_entry.length = UPLIFT_CAST(size_t, json.at - first) + 1; /* with the comma */
            if (uplift_peek(&json) != ',') uplift_fail(&json);
        } else if (uplift_is(key, "dim")) {
            content->dim = uplift_read_size(&json);
        } else if (uplift_is(key, "entries")) {
            content->entries = uplift_read_length(&json);
        } else if (uplift_is(key, "entry_model")) {
            uplift_read_model(&json, content, &content->entry_count);
            has_entry_model = 1 + content->is_sigmoid;
            start = content->start;
            end = content->end;
            warp = content->warp;
        } else if (uplift_is(key, "features")) {
            feature_result = uplift_read_features(&json, content);
        } else if (uplift_is(key, "format")) {
            format = uplift_read_string(&json);
        } else if (uplift_is(key, "model")) {
            uplift_read_model(&json, content, &content->count);
        } else if (uplift_is(key, "provenance")) {
            uplift_read_provenance(&json, content);
        } else if (uplift_is(key, "threshold")) {
            content->threshold = uplift_read_number(&json);
        } else if (uplift_is(key, "version")) {
            version = uplift_read_size(&json);
        } else if (
            uplift_is(key, "space") || uplift_is(key, "illuminant") || uplift_is(key, "observer")
            || uplift_is(key, "reference")) {
            uplift_read_string(&json);
        } else {
            uplift_skip(&json, UPLIFT_DEPTH); /* a later version may have more, and is refused below */
        }
    }
    if (!uplift_is(format, "uplift cube")) return UPLIFT_NOT_A_CUBE;
    if (version != 3 && version != UPLIFT_FORMAT) return json.failed ? UPLIFT_NOT_A_CUBE : UPLIFT_VERSION;
    if (json.failed || json.at != json.end) return UPLIFT_NOT_A_CUBE;
    if (feature_result != UPLIFT_OK) return feature_result;
    content->version = UPLIFT_CAST(int, version);
    if (version == 3) {
        content->entry_count = content->count;
    } else if (
        !has_entry_model || has_entry_model != 1 + content->is_sigmoid || start != content->start || end != content->end
        || uplift_compare(warp, content->warp) != 0) {
        return UPLIFT_INVALID;
    }
    return UPLIFT_OK;
}

static const unsigned char *uplift_bytes_of(const char *text)
{
    return UPLIFT_CAST(const unsigned char *, UPLIFT_CAST(const void *, text));
}

/* Whether the file has the content of its digest. */
static int uplift_check_digest(const uplift_content *content)
{
    static const char *const types[UPLIFT_TYPES] = {"<f8", "<f4", "|u1", "<i4", "<i2", "<u4"};
    const char *rest = content->digest_entry.text + content->digest_entry.length;
    const char *end = content->text + content->text_length;
    char line[256], digits[64];
    uplift_hash hash;
    if (content->digest.length != 64) return UPLIFT_DAMAGED;
    uplift_hash_start(&hash);
    uplift_hash_add(
        &hash, uplift_bytes_of(content->text), UPLIFT_CAST(size_t, content->digest_entry.text - content->text));
    uplift_hash_add(&hash, uplift_bytes_of(rest), UPLIFT_CAST(size_t, end - rest));
    for (int k = 0; k < content->array_count; ++k) {
        const uplift_array *array = content->arrays + k;
        int length = snprintf(
            line, sizeof line, "%.*s %s (", UPLIFT_CAST(int, array->name.length), array->name.text, types[array->type]);
        for (int axis = 0; axis < array->rank; ++axis)
            length += snprintf(
                line + length, sizeof line - UPLIFT_CAST(size_t, length), axis ? ", %llu" : "%llu", array->shape[axis]);
        length += snprintf(line + length, sizeof line - UPLIFT_CAST(size_t, length), array->rank == 1 ? ",)" : ")");
        uplift_hash_add(&hash, uplift_bytes_of(line), UPLIFT_CAST(size_t, length));
        uplift_hash_add(&hash, array->bytes, UPLIFT_CAST(size_t, array->end - array->begin));
    }
    uplift_hash_end(&hash, digits);
    return memcmp(digits, content->digest.text, 64) == 0 ? UPLIFT_OK : UPLIFT_DAMAGED;
}

/* The array of a name with numbers from `low` to `high`, of one of two types; NULL if there is none, or it is not valid.
   It has one axis if `width` is 0. */
static const uplift_array *uplift_find_array(
    const uplift_content *content, const char *name, int type, int other, unsigned long long length,
    unsigned long long width, double low, double high)
{
    for (int k = 0; k < content->array_count; ++k) {
        const uplift_array *array = content->arrays + k;
        if (!uplift_is(array->name, name)) continue;
        if (array->type != type && array->type != other) return NULL;
        if (array->rank != (width ? 2 : 1) || array->shape[0] != length || (width && array->shape[1] != width)) return NULL;
        for (size_t i = 0; i < array->length; ++i) {
            double value = uplift_number_at(array, i);
            if (!(value >= low && value <= high)) return NULL;
        }
        return array;
    }
    return NULL;
}

/* Functions for a number of coefficients, see below. */
typedef struct {
    void (*reflectances)(const uplift_cube *, const float *, const float *, int, float *);
    int (*place)(const uplift_cube *, const float *, float *, float *, int *);
} uplift_kernel;

struct uplift_cube {
    uplift_content content;
    const uplift_kernel *kernel;
    /* The table of exported programs, and the constants that locate its sections. */
    float *numbers;
    int entries, nodes, bins, lists, boxes, pull, scales, luminance, facets, facet_count, samples, dim, stride, tag;
    int entry_count, is_warped, is_inexact; /* numbers of an entry in the table */
    float first, step, margin, start, end, low, scale, warp[6];
    /* A cube of a scene: numbers of nodes that have a row, ascending, their rows, and where the numbers of each line of
       nodes along blue begin. Rows from `present` on belong to nodes that are absent. */
    int *points, *rows, *lines, point_count, present, absent_row;
    const uplift_array *coefficients, *distance, *standard_error, *atlas_coefficients, *atlas_error;
};

/* Row of a node in the table and in the arrays of the file; that of an absent node has no spectrum. */
static int uplift_find_row(const uplift_cube *cube, int index)
{
    int low = cube->lines[index / cube->dim], high = cube->lines[index / cube->dim + 1];
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (cube->points[middle] < index) low = middle + 1;
        else high = middle;
    }
    return low < cube->point_count && cube->points[low] == index ? cube->rows[low] : cube->absent_row;
}

static inline int uplift_row(const uplift_cube *cube, int index)
{
    return cube->points ? uplift_find_row(cube, index) : index;
}

/* Multipliers p of moments c, or 0: the bounded maximum-entropy spectrum (Peters et al. 2019), by Schur's algorithm (1917).
   docs/cube-file.md, Spectra, has the steps. */
static int uplift_try_multipliers(const double *c, int count, double *p)
{
    const double pi = 3.14159265358979323846;
    double real[UPLIFT_MOST_COUNT], imaginary[UPLIFT_MOST_COUNT];
    double u[UPLIFT_MOST_COUNT], v[UPLIFT_MOST_COUNT], a[UPLIFT_MOST_COUNT], b[UPLIFT_MOST_COUNT];
    double tangent = tan(pi / 2 * c[0]), scale = 2, sine = sin(pi * c[0]), cosine = cos(pi * c[0]);
    int is_valid = c[0] >= 0 && c[0] <= 1;
    /* exp(iX), X = pi sum c_l z^l */
    for (int order = 0; order < count; ++order) {
        double sum_real = order == 0, sum_imaginary = 0;
        for (int k = 0; k < order; ++k) {
            double slope = pi * (order - k) * c[order - k];
            sum_real -= slope * imaginary[k];
            sum_imaginary += slope * real[k];
        }
        real[order] = sum_real / (order ? order : 1);
        imaginary[order] = sum_imaginary / (order ? order : 1);
    }
    for (int k = 0; k < count; ++k) {
        u[k] = k + 1 < count ? imaginary[k + 1] : 0;
        v[k] = sine * real[k] + cosine * imaginary[k];
        a[k] = b[k] = k == 0;
    }
    for (int order = 0; order < count - 1; ++order) {
        double g = u[0] / v[0];
        for (int k = 0; k < count - 2 - order; ++k) {
            double held = u[k + 1] - g * v[k + 1];
            v[k] -= g * u[k];
            u[k] = held;
        }
        for (int k = 0; k <= (order + 1) / 2; ++k) {
            int mirror = order + 1 - k;
            double first = a[k], second = b[k];
            a[k] += g * a[mirror];
            b[k] -= g * b[mirror];
            if (mirror != k) {
                a[mirror] += g * first;
                b[mirror] -= g * second;
            }
        }
        scale *= 1 - g * g;
        is_valid = is_valid && g * g < 1;
    }
    for (int lag = 0; lag < count; ++lag) {
        double first = 0, second = 0;
        for (int k = 0; k + lag < count; ++k) {
            first += a[k] * a[k + lag];
            second += b[k] * b[k + lag];
        }
        p[lag] = (tangent * first - second / tangent) / scale;
        is_valid = is_valid && fabs(p[lag]) < 1e300; /* not NaN */
    }
    return is_valid;
}

/* Multipliers of the coefficients in a row of an array, with as little grey as necessary; 0 if no spectrum has them. */
static int uplift_multipliers(const uplift_cube *cube, const uplift_array *array, size_t row, int count, double *p)
{
    static const double greys[] = {0, 1e-10, 1e-8, 1e-6, 1e-4};
    double given[UPLIFT_MOST_COUNT], mixed[UPLIFT_MOST_COUNT];
    for (int k = 0; k < count; ++k) given[k] = p[k] = uplift_number_at(array, row * UPLIFT_CAST(size_t, count) + UPLIFT_CAST(size_t, k));
    if (cube->content.is_sigmoid) return 1;
    for (int turn = 0; turn < 5; ++turn) {
        for (int k = 0; k < count; ++k) mixed[k] = (1 - greys[turn]) * given[k];
        mixed[0] += 0.5 * greys[turn];
        if (uplift_try_multipliers(mixed, count, p)) return 1;
    }
    return 0;
}

/* Write multipliers in single precision; 0 for numbers with which spectra cannot be evaluated. */
static int uplift_store(const uplift_cube *cube, const double *p, int count, float *row)
{
    double most = cube->content.is_sigmoid ? 1e18 : 1e30;
    for (int k = 0; k < count; ++k) {
        if (!(fabs(p[k]) <= most)) return 0;
        row[k] = UPLIFT_CAST(float, p[k]);
    }
    return 1;
}

/* Index of the last node up to x, at most that before the last. */
static int uplift_cell(const uplift_array *axis, double x)
{
    int low = 0, high = UPLIFT_CAST(int, axis->length) - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (uplift_number_at(axis, UPLIFT_CAST(size_t, middle)) <= x) low = middle;
        else high = middle;
    }
    return low;
}

/* Set the lower and the upper face of the box of an entry along an axis. It has no face at the edge of the lattice where
   the entry is there: rounding would decide. */
static void uplift_set_faces(const uplift_array *axis, double centre, double reach, double faces[2])
{
    int last = UPLIFT_CAST(int, axis->length) - 1, cell = uplift_cell(axis, centre);
    double first = uplift_number_at(axis, UPLIFT_CAST(size_t, cell));
    double next = uplift_number_at(axis, UPLIFT_CAST(size_t, cell) + 1);
    double position = cell + (centre - first) / (next - first);
    for (int side = 0; side < 2; ++side) {
        double at = position + (side ? reach : -reach);
        int low = at < 0 ? 0 : UPLIFT_CAST(int, at);
        low = low < last ? low : last - 1;
        at = at < 0 ? 0 : at > last ? last : at;
        first = uplift_number_at(axis, UPLIFT_CAST(size_t, low));
        next = uplift_number_at(axis, UPLIFT_CAST(size_t, low) + 1);
        faces[side] = first + (at - low) * (next - first);
    }
    if (centre < 1e-6) faces[0] = 2 * centre - faces[1];
    else if (centre > 1 - 1e-6) faces[1] = 2 * centre - faces[0];
}

/* A cell that the box of an entry touches. */
typedef struct {
    int cell, entry;
} uplift_touch;

static int uplift_order_touches(const void *one, const void *other)
{
    const uplift_touch *a = UPLIFT_CAST(const uplift_touch *, one), *b = UPLIFT_CAST(const uplift_touch *, other);
    return a->cell != b->cell ? (a->cell > b->cell) - (a->cell < b->cell) : (a->entry > b->entry) - (a->entry < b->entry);
}

/* List the cells that boxes touch, by cell and entry, and write the boxes: centres, what rounding left of them, and
   reciprocals of the distances to the lower and upper faces. Count only, without `touches`. */
static size_t uplift_list_touches(const uplift_cube *cube, uplift_touch *touches, float *boxes)
{
    const uplift_content *content = &cube->content;
    const uplift_array *axis = uplift_find_array(content, "nodes", UPLIFT_F64, UPLIFT_F64, content->dim, 0, 0, 1);
    const unsigned long long length = UPLIFT_CAST(unsigned long long, content->entries);
    const uplift_array *rgb = uplift_find_array(content, "atlas.rgb", UPLIFT_F64, UPLIFT_F64, length, 3, 0, 1);
    const uplift_array *reaches = uplift_find_array(content, "atlas.reach", UPLIFT_F64, UPLIFT_F64, length, 0, 0, 1);
    size_t count = 0;
    for (int entry = 0; entry < content->entries; ++entry) {
        double reach = uplift_number_at(reaches, UPLIFT_CAST(size_t, entry));
        int low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            double centre = uplift_number_at(rgb, UPLIFT_CAST(size_t, 3 * entry + k)), faces[2];
            int cell = uplift_cell(axis, centre);
            float rounded = UPLIFT_CAST(float, centre), *box = boxes + 12 * entry + k;
            uplift_set_faces(axis, centre, reach, faces);
            low[k] = uplift_cell(axis, faces[0]);
            high[k] = uplift_cell(axis, faces[1]);
            low[k] = low[k] > cell - 1 ? low[k] : cell - 1;
            high[k] = high[k] < cell + 1 ? high[k] : cell + 1;
            box[0] = rounded;
            box[3] = UPLIFT_CAST(float, centre - UPLIFT_CAST(double, rounded));
            box[6] = UPLIFT_CAST(float, centre > faces[0] ? 1 / (centre - faces[0]) : 0);
            box[9] = UPLIFT_CAST(float, faces[1] > centre ? 1 / (faces[1] - centre) : 0);
        }
        if (!(reach > 0)) continue;
        for (int red = low[0]; red <= high[0]; ++red)
            for (int green = low[1]; green <= high[1]; ++green)
                for (int blue = low[2]; blue <= high[2]; ++blue, ++count)
                    if (touches) {
                        touches[count].cell = (red * cube->dim + green) * cube->dim + blue;
                        touches[count].entry = entry;
                    }
    }
    if (touches) qsort(touches, count, sizeof *touches, uplift_order_touches);
    return count;
}

/* The sensor: curves without the light (3, N), weights from reflectance to RGB (3, N), and weights of the luminance. */
typedef struct {
    double shapes[3][UPLIFT_SAMPLE_ROOM], weights[3][UPLIFT_SAMPLE_ROOM], luminance[3];
    double first, step;
    int samples;
} uplift_sensor;

/* The inverse of a matrix; 0 if it has none. */
static int uplift_invert(double m[3][3], double inverse[3][3])
{
    double determinant = 0;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            int a = (column + 1) % 3, b = (column + 2) % 3, c = (row + 1) % 3, d = (row + 2) % 3;
            inverse[row][column] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    for (int k = 0; k < 3; ++k) determinant += m[0][k] * inverse[k][0];
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            inverse[row][column] /= determinant;
            if (!(fabs(inverse[row][column]) < 1e30)) return 0;
        }
    return 1;
}

static int uplift_read_sensor(const uplift_content *content, uplift_sensor *sensor)
{
    const double most = 1e30;
    const uplift_array *wavelengths = NULL, *cmfs, *power, *to_rgb, *sensitivities = NULL;
    double matrix[3][3], inverse[3][3], sums[3] = {0, 0, 0}, scale = 0;
    unsigned long long length = 0;
    int samples;
    for (int k = 0; k < content->array_count; ++k)
        if (uplift_is(content->arrays[k].name, "sensor.wavelengths")) length = content->arrays[k].length;
    if (length < 2) return UPLIFT_INVALID;
    if (length > UPLIFT_SAMPLE_ROOM) return UPLIFT_UNSUPPORTED;
    samples = UPLIFT_CAST(int, length);
    wavelengths = uplift_find_array(content, "sensor.wavelengths", UPLIFT_F64, UPLIFT_F64, length, 0, 0, most);
    cmfs = uplift_find_array(content, "sensor.cmfs", UPLIFT_F64, UPLIFT_F64, length, 3, -most, most);
    power = uplift_find_array(content, "sensor.power", UPLIFT_F64, UPLIFT_F64, length, 0, 0, most);
    to_rgb = uplift_find_array(content, "sensor.xyz_to_rgb", UPLIFT_F64, UPLIFT_F64, 3, 3, -most, most);
    if (uplift_has(content, UPLIFT_CAMERA)) {
        sensitivities = uplift_find_array(content, "sensor.sensitivities", UPLIFT_F64, UPLIFT_F64, length, 3, 0, most);
        if (!sensitivities) return UPLIFT_INVALID;
    }
    if (!wavelengths || !cmfs || !power || !to_rgb) return UPLIFT_INVALID;
    sensor->samples = samples;
    sensor->first = uplift_number_at(wavelengths, 0);
    sensor->step = uplift_number_at(wavelengths, 1) - sensor->first;
    if (!(sensor->step > 0)) return UPLIFT_INVALID;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) matrix[row][column] = uplift_number_at(to_rgb, UPLIFT_CAST(size_t, 3 * row + column));
    if (!uplift_invert(matrix, inverse)) return UPLIFT_INVALID;
    for (int k = 0; k < 3; ++k) sensor->luminance[k] = inverse[1][k];
    for (int k = 0; k < samples; ++k) {
        size_t at = UPLIFT_CAST(size_t, k);
        double even = sensor->first + k * sensor->step;
        if (!(fabs(uplift_number_at(wavelengths, at) - even) < 1e-6 * sensor->step)) return UPLIFT_UNSUPPORTED;
        scale += uplift_number_at(power, at) * uplift_number_at(cmfs, 3 * at + 1);
        for (int channel = 0; channel < 3; ++channel) {
            double shape = 0;
            if (sensitivities) shape = uplift_number_at(sensitivities, 3 * at + UPLIFT_CAST(size_t, channel));
            else
                for (int axis = 0; axis < 3; ++axis)
                    shape += uplift_number_at(cmfs, 3 * at + UPLIFT_CAST(size_t, axis)) * matrix[channel][axis];
            sensor->shapes[channel][k] = shape;
            sums[channel] += shape * uplift_number_at(power, at);
        }
    }
    for (int channel = 0; channel < 3; ++channel) {
        double white = 0;
        for (int k = 0; k < samples; ++k) {
            double shape = sensor->shapes[channel][k];
            if (sensitivities) shape = sensor->shapes[channel][k] /= sums[channel];
            sensor->weights[channel][k] = shape * uplift_number_at(power, UPLIFT_CAST(size_t, k)) / (sensitivities ? 1 : scale);
            white += sensor->weights[channel][k];
        }
        if (!(fabs(white - 1) <= 1e-6)) return UPLIFT_INVALID;
    }
    return UPLIFT_OK;
}

/* The inverse of L, where L L^T = W K^T; 0 if there is none. */
static int uplift_scale_colours(const uplift_sensor *sensor, double inverse[3][3])
{
    double lower[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column <= row; ++column) {
            double sum = 0;
            for (int k = 0; k < sensor->samples; ++k) sum += sensor->weights[row][k] * sensor->shapes[column][k];
            for (int k = 0; k < column; ++k) sum -= lower[row][k] * lower[column][k];
            lower[row][column] = row == column ? sqrt(sum) : sum / lower[column][column];
        }
    return uplift_invert(lower, inverse);
}

/* Write the facets of the solid of all colours of reflectances, normals and half the width along them: each pair of
   wavelengths spans two (MacAdam 1935). Return how many pairs do; count only, without `facets`. */
static int uplift_list_facets(const uplift_sensor *sensor, float *facets)
{
    int count = 0;
    for (int i = 0; i < sensor->samples; ++i)
        for (int j = i + 1; j < sensor->samples; ++j) {
            double cross[3], lengths[3] = {0, 0, 0}, width = 0;
            for (int k = 0; k < 3; ++k) {
                int a = (k + 1) % 3, b = (k + 2) % 3;
                cross[k] = sensor->weights[a][i] * sensor->weights[b][j] - sensor->weights[b][i] * sensor->weights[a][j];
                lengths[0] += cross[k] * cross[k];
                lengths[1] += sensor->weights[k][i] * sensor->weights[k][i];
                lengths[2] += sensor->weights[k][j] * sensor->weights[k][j];
            }
            if (!(sqrt(lengths[0]) > 1e-12 * sqrt(lengths[1]) * sqrt(lengths[2]))) continue;
            if (facets) {
                for (int k = 0; k < 3; ++k) cross[k] /= sqrt(lengths[0]);
                for (int k = 0; k < sensor->samples; ++k)
                    width += fabs(
                        cross[0] * sensor->weights[0][k] + cross[1] * sensor->weights[1][k] + cross[2] * sensor->weights[2][k]);
                for (int k = 0; k < 3; ++k) facets[4 * count + k] = UPLIFT_CAST(float, cross[k]);
                facets[4 * count + 3] = UPLIFT_CAST(float, width / 2);
            }
            count += 1;
        }
    return count;
}

/* Memory of an element size, zeroed; at least one byte. */
static void *uplift_allocate(size_t count, size_t size)
{
    return calloc(count ? count : 1, size);
}

/* Find the arrays of the nodes and entries, and check what a lookup relies on. */
static int uplift_check(uplift_cube *cube)
{
    const uplift_content *content = &cube->content;
    const double most = 1e30;
    const unsigned long long dim = content->dim, count = content->count, entry_count = content->entry_count;
    const unsigned long long entries = UPLIFT_CAST(unsigned long long, content->entries);
    const uplift_array *axis;
    unsigned long long nodes = dim * dim * dim;
    if (dim < 2 || count < 3 || entry_count < count) return UPLIFT_INVALID;
    if (content->is_sigmoid ? entry_count != 3 : entry_count > UPLIFT_MOST_COUNT) return UPLIFT_INVALID;
    if (dim > UPLIFT_MOST_DIM || entries > 1 << 24) return UPLIFT_TOO_LARGE;
    if (!(content->start > 0 || content->is_sigmoid) || !(content->start < content->end) || !(content->end < 1e30)) return UPLIFT_INVALID;
    if (!(content->threshold >= 1e-12 && content->threshold <= 0.1) || content->looks > content->entries) return UPLIFT_INVALID;
    if (!(fabs(content->bound_factor) <= most)) return UPLIFT_INVALID;
    axis = uplift_find_array(content, "nodes", UPLIFT_F64, UPLIFT_F64, dim, 0, 0, 1);
    if (!axis || uplift_number_at(axis, 0) != 0 || uplift_number_at(axis, axis->length - 1) != 1) return UPLIFT_INVALID;
    for (size_t k = 1; k < axis->length; ++k)
        if (UPLIFT_CAST(float, uplift_number_at(axis, k)) <= UPLIFT_CAST(float, uplift_number_at(axis, k - 1))) return UPLIFT_INVALID;
    if (uplift_has(content, UPLIFT_SPARSE)) {
        const uplift_array *points = NULL;
        for (int k = 0; k < content->array_count; ++k)
            if (uplift_is(content->arrays[k].name, "points")) points = content->arrays + k;
        if (!points || points->type != UPLIFT_U32 || points->rank != 1 || points->length == 0 || points->length >= nodes) return UPLIFT_INVALID;
        for (size_t k = 0; k < points->length; ++k)
            if (uplift_number_at(points, k) >= UPLIFT_CAST(double, nodes)
                || (k > 0 && uplift_number_at(points, k) <= uplift_number_at(points, k - 1))) return UPLIFT_INVALID;
        nodes = points->length;
    }
    cube->coefficients = uplift_find_array(content, "coefficients", UPLIFT_F32, UPLIFT_F64, nodes, count, -most, most);
    cube->distance = uplift_find_array(content, "distance", UPLIFT_F32, UPLIFT_F32, nodes, 0, 0, most);
    cube->atlas_coefficients = uplift_find_array(content, "atlas.coefficients", UPLIFT_F64, UPLIFT_F64, entries, count, -most, most);
    cube->atlas_error = uplift_find_array(content, "atlas.error", UPLIFT_F64, UPLIFT_F64, entries, 0, 0, most);
    if (!cube->coefficients || !cube->distance || !cube->atlas_coefficients || !cube->atlas_error) return UPLIFT_INVALID;
    if (!uplift_find_array(content, "atlas.rgb", UPLIFT_F64, UPLIFT_F64, entries, 3, 0, 1)) return UPLIFT_INVALID;
    if (!uplift_find_array(content, "atlas.reach", UPLIFT_F64, UPLIFT_F64, entries, 0, 0, 1)) return UPLIFT_INVALID;
    if (uplift_has(content, UPLIFT_ERRORS)) {
        cube->standard_error = uplift_find_array(content, "standard_error", UPLIFT_F32, UPLIFT_F32, nodes, 0, 0, most);
        if (!cube->standard_error) return UPLIFT_INVALID;
    }
    for (size_t k = 0; k < nodes; ++k)
        if (uplift_number_at(cube->distance, k) > content->threshold) cube->is_inexact = 1;
    cube->dim = UPLIFT_CAST(int, dim);
    cube->present = UPLIFT_CAST(int, nodes);
    return UPLIFT_OK;
}

/* Number of the node in a row of the file. */
static int uplift_node_number(const uplift_array *points, int row)
{
    return points ? UPLIFT_CAST(int, uplift_number_at(points, UPLIFT_CAST(size_t, row))) : row;
}

/* Give rows to the nodes of a scene, and after them to absent nodes whose cells touch boxes. */
static int uplift_index_nodes(uplift_cube *cube, const uplift_array *points, const uplift_touch *touches, size_t touch_count)
{
    size_t room = UPLIFT_CAST(size_t, cube->present) + touch_count, lines = UPLIFT_CAST(size_t, cube->dim) * UPLIFT_CAST(size_t, cube->dim);
    int next = 0, absent = cube->present;
    size_t touch = 0;
    cube->points = UPLIFT_CAST(int *, uplift_allocate(room, sizeof *cube->points));
    cube->rows = UPLIFT_CAST(int *, uplift_allocate(room, sizeof *cube->rows));
    cube->lines = UPLIFT_CAST(int *, uplift_allocate(lines + 1, sizeof *cube->lines));
    if (!cube->points || !cube->rows || !cube->lines) return UPLIFT_NO_MEMORY;
    while (next < cube->present || touch < touch_count) {
        int count = cube->point_count++;
        int node = next < cube->present ? uplift_node_number(points, next) : touches[touch].cell;
        if (touch < touch_count && touches[touch].cell < node) node = touches[touch].cell;
        cube->points[count] = node;
        if (next < cube->present && uplift_node_number(points, next) == node) cube->rows[count] = next++;
        else cube->rows[count] = absent++;
        while (touch < touch_count && touches[touch].cell == node) touch += 1;
        cube->lines[node / cube->dim + 1] = count + 1;
    }
    for (size_t line = 1; line <= lines; ++line)
        if (cube->lines[line] < cube->lines[line - 1]) cube->lines[line] = cube->lines[line - 1];
    cube->absent_row = absent;
    return UPLIFT_OK;
}

/* Write the multipliers of the nodes: less steep ones where colours are not exact (docs/cube-file.md, Exact colours). */
static int uplift_fill_rows(uplift_cube *cube)
{
    const int count = UPLIFT_CAST(int, cube->content.count);
    double p[UPLIFT_MOST_COUNT];
    for (int row = 0; row < cube->present; ++row) {
        if (!uplift_multipliers(cube, cube->coefficients, UPLIFT_CAST(size_t, row), count, p)) return UPLIFT_INVALID;
        if (uplift_number_at(cube->distance, UPLIFT_CAST(size_t, row)) > cube->content.threshold) {
            double size = 0;
            for (int k = 0; k < count; ++k) size += fabs(p[k]);
            for (int k = 0; k < count && size > 500; ++k) p[k] *= 500 / size;
        }
        if (!uplift_store(cube, p, count, cube->numbers + UPLIFT_CAST(size_t, row) * UPLIFT_CAST(size_t, cube->stride))) return UPLIFT_INVALID;
    }
    return UPLIFT_OK;
}

/* Write the lists of entries whose boxes touch a cell, and the tags of cells: where their list is, negative if answers in
   the cell are moved. */
static void uplift_fill_lists(uplift_cube *cube, const uplift_array *points, const uplift_touch *touches, size_t touch_count)
{
    float *lists = cube->numbers + cube->lists, *tags = cube->numbers + cube->tag;
    int length = 1 + cube->is_inexact;
    for (size_t k = 0; k < touch_count;) {
        size_t end = k;
        int at = length++;
        tags[UPLIFT_CAST(size_t, uplift_row(cube, touches[k].cell)) * UPLIFT_CAST(size_t, cube->stride)] = UPLIFT_CAST(float, at);
        for (; end < touch_count && touches[end].cell == touches[k].cell; ++end) lists[length++] = UPLIFT_CAST(float, touches[end].entry);
        lists[at] = UPLIFT_CAST(float, end - k);
        k = end;
    }
    for (int row = 0; row < cube->present; ++row) {
        int node, position[3];
        if (!(uplift_number_at(cube->distance, UPLIFT_CAST(size_t, row)) > cube->content.threshold)) continue;
        node = uplift_node_number(points, row);
        position[0] = node / cube->dim / cube->dim;
        position[1] = node / cube->dim % cube->dim;
        position[2] = node % cube->dim;
        for (int corner = 0; corner < 8; ++corner) {
            int low[3] = {position[0] - corner / 4, position[1] - corner / 2 % 2, position[2] - corner % 2}, is_cell = 1, at;
            for (int k = 0; k < 3; ++k) is_cell = is_cell && low[k] >= 0 && low[k] < cube->dim - 1;
            if (!is_cell) continue;
            at = uplift_row(cube, (low[0] * cube->dim + low[1]) * cube->dim + low[2]);
            if (!cube->points || at != cube->absent_row) {
                float *tag = tags + UPLIFT_CAST(size_t, at) * UPLIFT_CAST(size_t, cube->stride);
                *tag = *tag == 0 ? -1.0f : -UPLIFT_CAST(float, fabs(UPLIFT_CAST(double, *tag)));
            }
        }
    }
}

/* Write the axis, and the last node up to the start of each of 1024 bins of it. */
static void uplift_fill_axis(uplift_cube *cube)
{
    const uplift_array *axis = uplift_find_array(&cube->content, "nodes", UPLIFT_F64, UPLIFT_F64, cube->content.dim, 0, 0, 1);
    float *nodes = cube->numbers + cube->nodes, *bins = cube->numbers + cube->bins;
    int low = 0;
    for (int k = 0; k < cube->dim; ++k) nodes[k] = UPLIFT_CAST(float, uplift_number_at(axis, UPLIFT_CAST(size_t, k)));
    for (int bin = 0; bin <= 1024; ++bin) {
        while (low < cube->dim - 2 && nodes[low + 1] <= UPLIFT_CAST(float, bin) / 1024) low += 1;
        bins[bin] = UPLIFT_CAST(float, low);
    }
}

/* Write how answers are moved to their colours. */
static int uplift_fill_moves(uplift_cube *cube, const uplift_sensor *sensor)
{
    double scale[3][3];
    float *numbers = cube->numbers;
    if (!uplift_scale_colours(sensor, scale)) return UPLIFT_INVALID;
    for (int k = 0; k < sensor->samples; ++k)
        for (int row = 0; row < 3; ++row) {
            double weight = 0, shape = 0;
            for (int column = 0; column < 3; ++column) {
                weight += scale[row][column] * sensor->weights[column][k];
                shape += scale[row][column] * sensor->shapes[column][k];
            }
            numbers[cube->pull + 6 * k + row] = UPLIFT_CAST(float, weight);
            numbers[cube->pull + 6 * k + 3 + row] = UPLIFT_CAST(float, shape);
        }
    for (int k = 0; k < 9; ++k) numbers[cube->scales + k] = UPLIFT_CAST(float, scale[k / 3][k % 3]);
    for (int k = 0; k < 3; ++k) numbers[cube->luminance + k] = UPLIFT_CAST(float, sensor->luminance[k]);
    uplift_list_facets(sensor, numbers + cube->facets);
    cube->first = UPLIFT_CAST(float, sensor->first);
    cube->step = UPLIFT_CAST(float, sensor->step);
    cube->margin = UPLIFT_CAST(float, cube->content.threshold / 2);
    return UPLIFT_OK;
}

/* Set the range of wavelengths; 0 for a warp that is not known. */
static int uplift_set_range(uplift_cube *cube)
{
    static const struct {
        const char *name;
        double terms[6];
    } warps[] = {{"none", {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}}, {"vision", {1.0, 0.0072, 538.0, 0.0, 0.0, 0.0}}, {"colour", {1.0, 0.0263, 480.0, 1.066, 0.0227, 578.0}}};
    const uplift_content *content = &cube->content;
    double low = content->start, high = content->end;
    cube->start = UPLIFT_CAST(float, low);
    cube->end = UPLIFT_CAST(float, high);
    if (content->is_sigmoid) return 1;
    for (size_t k = 0; k < sizeof warps / sizeof *warps; ++k) {
        const double *terms = warps[k].terms;
        if (!uplift_is(content->warp, warps[k].name)) continue;
        cube->is_warped = terms[0] != 0;
        for (int term = 0; term < 6; ++term) cube->warp[term] = UPLIFT_CAST(float, terms[term]);
        if (cube->is_warped) {
            low = terms[0] * tanh(terms[1] * (low - terms[2])) + terms[3] * tanh(terms[4] * (low - terms[5]));
            high = terms[0] * tanh(terms[1] * (high - terms[2])) + terms[3] * tanh(terms[4] * (high - terms[5]));
        }
        cube->low = UPLIFT_CAST(float, low);
        cube->scale = UPLIFT_CAST(float, 1 / (high - low));
        return high > low && fabs(1 / (high - low)) < 1e30;
    }
    return 0;
}

/* Make the table of a cube whose content is checked. */
static int uplift_make_table(
    uplift_cube *cube, const uplift_sensor *sensor, const uplift_touch *touches, size_t touch_count, const float *boxes)
{
    const uplift_content *content = &cube->content;
    const unsigned long long entries = UPLIFT_CAST(unsigned long long, content->entries);
    const uplift_array *points = uplift_has(content, UPLIFT_SPARSE)
        ? uplift_find_array(content, "points", UPLIFT_U32, UPLIFT_U32, UPLIFT_CAST(unsigned long long, cube->present), 0, 0, 1e10) : NULL;
    const uplift_array *spectra = cube->atlas_coefficients;
    unsigned long long sizes[10] = {0}, total = 0;
    int *const sections[10] = {
        NULL, &cube->entries, &cube->nodes, &cube->bins, &cube->lists, &cube->boxes, &cube->pull, &cube->scales,
        &cube->luminance, &cube->facets};
    const int count = UPLIFT_CAST(int, content->entry_count);
    double p[UPLIFT_MOST_COUNT];
    int result = points ? uplift_index_nodes(cube, points, touches, touch_count) : UPLIFT_OK;
    if (result != UPLIFT_OK) return result;
    if (content->entry_count != content->count)
        spectra = uplift_find_array(content, "atlas.entry_coefficients", UPLIFT_F64, UPLIFT_F64, entries, content->entry_count, -1e30, 1e30);
    if (!spectra) return UPLIFT_INVALID;
    sizes[0] = UPLIFT_CAST(unsigned, points ? cube->absent_row + 1 : cube->present) * UPLIFT_CAST(unsigned long long, cube->stride);
    sizes[1] = entries * UPLIFT_CAST(unsigned, cube->entry_count);
    sizes[2] = content->dim;
    sizes[3] = 1025;
    sizes[4] = 2 + 2 * touch_count;
    sizes[5] = 12 * entries;
    if (sensor) {
        cube->samples = sensor->samples;
        cube->facet_count = uplift_list_facets(sensor, NULL);
        sizes[6] = 6 * UPLIFT_CAST(unsigned long long, cube->samples);
        sizes[7] = 9;
        sizes[8] = 3;
        sizes[9] = 4 * UPLIFT_CAST(unsigned long long, cube->facet_count);
    }
    if (sizes[4] > 1 << 24) return UPLIFT_TOO_LARGE; /* positions in lists are floats */
    for (int k = 0; k < 10; ++k) {
        if (sections[k]) *sections[k] = UPLIFT_CAST(int, total);
        total += sizes[k];
        if (total > 0x7FFFFFF0) return UPLIFT_TOO_LARGE; /* and in the table whole numbers */
    }
    cube->numbers = UPLIFT_CAST(float *, uplift_allocate(UPLIFT_CAST(size_t, total), sizeof(float)));
    if (!cube->numbers) return UPLIFT_NO_MEMORY;
    memcpy(cube->numbers + cube->boxes, boxes, UPLIFT_CAST(size_t, sizes[5]) * sizeof *boxes);
    uplift_fill_axis(cube);
    uplift_fill_lists(cube, points, touches, touch_count);
    for (int entry = 0; entry < content->entries; ++entry) {
        float *row = cube->numbers + cube->entries + entry * cube->entry_count;
        if (!uplift_multipliers(cube, spectra, UPLIFT_CAST(size_t, entry), count, p)) return UPLIFT_INVALID;
        if (!uplift_store(cube, p, count, row)) return UPLIFT_INVALID;
    }
    result = sensor ? uplift_fill_moves(cube, sensor) : UPLIFT_OK;
    return result == UPLIFT_OK ? uplift_fill_rows(cube) : result;
}

/* Make the table, with memory that is needed until it is made. */
static int uplift_build(uplift_cube *cube)
{
    uplift_touch *touches = NULL;
    uplift_sensor *sensor = NULL;
    float *boxes;
    size_t touch_count = 0;
    int result = UPLIFT_OK;
    boxes = UPLIFT_CAST(float *, uplift_allocate(12 * UPLIFT_CAST(size_t, cube->content.entries), sizeof *boxes));
    if (boxes) {
        touch_count = uplift_list_touches(cube, NULL, boxes);
        touches = UPLIFT_CAST(uplift_touch *, uplift_allocate(touch_count, sizeof *touches));
    }
    if (cube->is_inexact) sensor = UPLIFT_CAST(uplift_sensor *, uplift_allocate(1, sizeof *sensor));
    if (!boxes || !touches || (cube->is_inexact && !sensor)) result = UPLIFT_NO_MEMORY;
    if (result == UPLIFT_OK && sensor) result = uplift_read_sensor(&cube->content, sensor);
    if (result == UPLIFT_OK) {
        uplift_list_touches(cube, touches, boxes);
        result = uplift_make_table(cube, sensor, touches, touch_count, boxes);
    }
    free(sensor);
    free(touches);
    free(boxes);
    return result;
}

/* Loops over wavelengths and lanes are vectorised, not unrolled. */
#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wpass-failed" /* without optimisation, or for size, loops stay as they are */
#define UPLIFT_EXPANDED static inline __attribute__((always_inline))
#define UPLIFT_VECTORISE _Pragma("clang loop vectorize(enable) interleave_count(1)")
#elif defined(__GNUC__)
#define UPLIFT_EXPANDED static inline __attribute__((always_inline))
#define UPLIFT_VECTORISE _Pragma("GCC ivdep") _Pragma("GCC unroll 1")
#else
#define UPLIFT_EXPANDED static inline
#define UPLIFT_VECTORISE
#endif

#define UPLIFT_IN const
#define UPLIFT_OUT
#define UPLIFT_ARRAY(name, size) float name[size]
#define UPLIFT_BOOL int
#define UPLIFT_INT(x) UPLIFT_CAST(int, x)
#define UPLIFT_REAL(x) UPLIFT_CAST(float, x)
#define UPLIFT_ABS fabsf
#define UPLIFT_SQRT sqrtf
#define UPLIFT_TANH tanhf
#define UPLIFT_COPYSIGN copysignf
/* Moving a colour takes a few steps in double precision. */
#define UPLIFT_FINE double
#define UPLIFT_FINES(name, size) double name[size]
#define UPLIFT_EXACT(x) UPLIFT_CAST(double, x)
#define UPLIFT_TURN(x) (atan(x) * 0.31830988618379067)
#define UPLIFT_SQUARE_ROOT sqrt
#define UPLIFT_TINY 1e-18
#define UPLIFT_TOLERANCE 1e-7
#define UPLIFT_STEPS 100

/* Lookups follow, the source of the programs that `uplift export` writes: this file includes itself once for each number of
   coefficients. Others are filled up with zeros, which have the same spectrum. */
#define UPLIFT_JOIN(kernel, name) kernel##_##name
#define UPLIFT_NAME_OF(kernel, name) UPLIFT_JOIN(kernel, name)
#define UPLIFT_NAME(name) UPLIFT_NAME_OF(UPLIFT_KERNEL, name)
#if defined(__GNUC__) && !defined(__clang__)
#define UPLIFT_FUNCTION UPLIFT_EXPANDED /* gcc would not expand all in a file of so many; clang vectorises less if it has to */
#else
#define UPLIFT_FUNCTION static inline
#endif
#if defined(__GNUC__)
#define UPLIFT_SELDOM static __attribute__((noinline))
#define UPLIFT_UNUSED __attribute__((unused))
#else
#define UPLIFT_SELDOM static
#define UPLIFT_UNUSED
#endif
#define UPLIFT_LANES 16
#define UPLIFT_READS const uplift_cube *cube,
#define UPLIFT_TABLE cube,
#define UPLIFT_READS_CUBE UPLIFT_UNUSED UPLIFT_READS
#define UPLIFT_CUBE UPLIFT_TABLE
#define UPLIFT_ROW(name, index) const float *name = cube->numbers + UPLIFT_ROW_OF(index) * UPLIFT_STRIDE
UPLIFT_EXPANDED float uplift_number(const uplift_cube *cube, int index)
{
    return cube->numbers[index];
}

#define UPLIFT_SPECTRA 1
#define UPLIFT_BIN_COUNT 1024
#define UPLIFT_LEAST 0.0003f
#define UPLIFT_SLOPE 0.03f
#define UPLIFT_MOST 0.01f
#define UPLIFT_STEEP 100.0f
#define UPLIFT_REACH 2.0f
#define UPLIFT_DIM cube->dim
#define UPLIFT_ENTRIES cube->entries
#define UPLIFT_NODES cube->nodes
#define UPLIFT_BINS cube->bins
#define UPLIFT_LISTS cube->lists
#define UPLIFT_BOXES cube->boxes
#define UPLIFT_PULL cube->pull
#define UPLIFT_SCALES cube->scales
#define UPLIFT_LUMINANCE cube->luminance
#define UPLIFT_FACETS cube->facets
#define UPLIFT_FACET_COUNT cube->facet_count
#define UPLIFT_SAMPLES cube->samples
#define UPLIFT_FIRST cube->first
#define UPLIFT_STEP cube->step
#define UPLIFT_MARGIN cube->margin
#define UPLIFT_START cube->start
#define UPLIFT_END cube->end
#define UPLIFT_LOW cube->low
#define UPLIFT_SCALE cube->scale
#define UPLIFT_WARP_0 cube->warp[0]
#define UPLIFT_WARP_1 cube->warp[1]
#define UPLIFT_WARP_2 cube->warp[2]
#define UPLIFT_WARP_3 cube->warp[3]
#define UPLIFT_WARP_4 cube->warp[4]
#define UPLIFT_WARP_5 cube->warp[5]
#if defined(__clang__)
#define UPLIFT_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define UPLIFT_UNROLL _Pragma("GCC unroll 32")
#else
#define UPLIFT_UNROLL
#endif
/* Where all nodes have their own colours, a colour is found by its place, and its answer is the mixture. */
#define UPLIFT_ALIASES \
    UPLIFT_FUNCTION int UPLIFT_NAME(find)(UPLIFT_READS UPLIFT_IN float rgb[3], UPLIFT_OUT float place[UPLIFT_PLACE]) \
    { \
        return UPLIFT_NAME(locate)(UPLIFT_TABLE rgb, place); \
    } \
    UPLIFT_FUNCTION void UPLIFT_NAME(answer)( \
        UPLIFT_READS UPLIFT_OUT float place[UPLIFT_PLACE], int entry, UPLIFT_IN float wavelengths[UPLIFT_WIDTH], \
        UPLIFT_OUT float total[UPLIFT_WIDTH]) \
    { \
        UPLIFT_NAME(blend)(UPLIFT_TABLE place, entry, wavelengths, total); \
    }

#define UPLIFT_KERNEL uplift_sigmoid
#define UPLIFT_COUNT 3
#define UPLIFT_ENTRY_COUNT 3
#define UPLIFT_STRIDE 4
#define UPLIFT_SIGMOIDS 1
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 0
#define UPLIFT_PLACE 4
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_sigmoid_moved
#define UPLIFT_COUNT 3
#define UPLIFT_ENTRY_COUNT 3
#define UPLIFT_STRIDE 4
#define UPLIFT_SIGMOIDS 1
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_5
#define UPLIFT_COUNT 5
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 8
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 0
#define UPLIFT_PLACE 4
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_5_moved
#define UPLIFT_COUNT 5
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 8
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_9
#define UPLIFT_COUNT 9
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 12
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 0
#define UPLIFT_PLACE 4
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_9_moved
#define UPLIFT_COUNT 9
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 12
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_17
#define UPLIFT_COUNT 17
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 20
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 0
#define UPLIFT_PLACE 4
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_17_moved
#define UPLIFT_COUNT 17
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 20
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_5_warped
#define UPLIFT_COUNT 5
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 8
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 1
#define UPLIFT_INEXACT 0
#define UPLIFT_PLACE 4
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_5_warped_moved
#define UPLIFT_COUNT 5
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 8
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 1
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_17_warped
#define UPLIFT_COUNT 17
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 20
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 1
#define UPLIFT_INEXACT 0
#define UPLIFT_PLACE 4
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_17_warped_moved
#define UPLIFT_COUNT 17
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 20
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 1
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) (index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_sigmoid_moved_sparse
#define UPLIFT_COUNT 3
#define UPLIFT_ENTRY_COUNT 3
#define UPLIFT_STRIDE 4
#define UPLIFT_SIGMOIDS 1
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) uplift_row(cube, index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_9_moved_sparse
#define UPLIFT_COUNT 9
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 12
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) uplift_row(cube, index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_17_moved_sparse
#define UPLIFT_COUNT 17
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 20
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 0
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) uplift_row(cube, index)
#include UPLIFT_FILE

#define UPLIFT_KERNEL uplift_moments_17_warped_moved_sparse
#define UPLIFT_COUNT 17
#define UPLIFT_ENTRY_COUNT 17
#define UPLIFT_STRIDE 20
#define UPLIFT_SIGMOIDS 0
#define UPLIFT_WARPED 1
#define UPLIFT_INEXACT 1
#define UPLIFT_PLACE 9
#define UPLIFT_ROW_OF(index) uplift_row(cube, index)
#include UPLIFT_FILE

/* Use the functions for the number of coefficients of a cube. */
static void uplift_choose(uplift_cube *cube)
{
    static const struct {
        int count, is_sigmoid, is_warped, is_inexact, is_sparse;
        const uplift_kernel *functions;
    } kernels[] = {
        {3, 1, 0, 0, 0, &uplift_sigmoid_functions},
        {3, 1, 0, 1, 0, &uplift_sigmoid_moved_functions},
        {5, 0, 0, 0, 0, &uplift_moments_5_functions},
        {5, 0, 0, 1, 0, &uplift_moments_5_moved_functions},
        {9, 0, 0, 0, 0, &uplift_moments_9_functions},
        {9, 0, 0, 1, 0, &uplift_moments_9_moved_functions},
        {17, 0, 0, 0, 0, &uplift_moments_17_functions},
        {17, 0, 0, 1, 0, &uplift_moments_17_moved_functions},
        {5, 0, 1, 0, 0, &uplift_moments_5_warped_functions},
        {5, 0, 1, 1, 0, &uplift_moments_5_warped_moved_functions},
        {17, 0, 1, 0, 0, &uplift_moments_17_warped_functions},
        {17, 0, 1, 1, 0, &uplift_moments_17_warped_moved_functions},
        {3, 1, 0, 1, 1, &uplift_sigmoid_moved_sparse_functions},
        {9, 0, 0, 1, 1, &uplift_moments_9_moved_sparse_functions},
        {17, 0, 0, 1, 1, &uplift_moments_17_moved_sparse_functions},
        {17, 0, 1, 1, 1, &uplift_moments_17_warped_moved_sparse_functions}};
    const uplift_content *content = &cube->content;
    const int is_sparse = uplift_has(content, UPLIFT_SPARSE), is_inexact = cube->is_inexact || is_sparse;
    int k = 0;
    while (UPLIFT_CAST(unsigned, kernels[k].count) < content->count || kernels[k].is_sigmoid != content->is_sigmoid
        || kernels[k].is_warped != cube->is_warped || kernels[k].is_inexact != is_inexact
        || kernels[k].is_sparse != is_sparse) k += 1;
    cube->kernel = kernels[k].functions;
    cube->tag = kernels[k].count;
    cube->stride = kernels[k].count / 4 * 4 + 4;
    cube->entry_count = content->is_sigmoid ? 3 : UPLIFT_MOST_COUNT;
}

uplift_cube *uplift_open(const char *path, int *error)
{
    uplift_cube *cube = UPLIFT_CAST(uplift_cube *, uplift_allocate(1, sizeof *cube));
    int result = cube ? uplift_acquire(path, &cube->content.file) : UPLIFT_NO_MEMORY;
    if (result == UPLIFT_OK) result = uplift_read_header(&cube->content);
    if (result == UPLIFT_OK) result = uplift_read_metadata(&cube->content);
    if (result == UPLIFT_OK) result = uplift_check_digest(&cube->content);
    if (result == UPLIFT_OK) result = uplift_check(cube);
    if (result == UPLIFT_OK) result = uplift_set_range(cube) ? UPLIFT_OK : UPLIFT_INVALID;
    if (result == UPLIFT_OK) uplift_choose(cube);
    if (result == UPLIFT_OK) result = uplift_build(cube);
    if (error) *error = result;
    if (result == UPLIFT_OK) return cube;
    uplift_close(cube);
    return NULL;
}

void uplift_close(uplift_cube *cube)
{
    if (!cube) return;
    uplift_release(&cube->content.file);
    free(cube->content.text);
    free(cube->numbers);
    free(cube->points);
    free(cube->rows);
    free(cube->lines);
    free(cube);
}

const char *uplift_message(int result)
{
    static const char *const messages[] = {
        "no error",
        "the file cannot be opened or read",
        "out of memory",
        "the file is not a cube, or is damaged",
        "the file has a format that this reader does not know",
        "the file has a part that this reader does not know",
        "the file is damaged: its content does not match its digest",
        "the file has values that no cube has",
        "the cube has more numbers than this reader can address",
        "the cube needs a sensor of evenly spaced wavelengths, at most 512",
        "the colour is not in the scene of the cube",
        "the cube has no standard errors",
        "coefficients are not moved to exact colours here"};
    int is_known = result >= 0 && result < UPLIFT_CAST(int, sizeof messages / sizeof *messages);
    return is_known ? messages[result] : "unknown result";
}

/* The eight nodes and the entry of a colour, and their weights. */
typedef struct {
    int rows[8], entry;
    float weights[8], lattice_weight;
    int position[3];
} uplift_place;

/* Find the nodes of a colour; 0 if the cube lacks one of them. */
static int uplift_find(const uplift_cube *cube, const float rgb[3], uplift_place *place)
{
    float sides[6];
    int first, is_present = 1;
    place->entry = cube->kernel->place(cube, rgb, &place->lattice_weight, sides, &first);
    place->position[0] = first / cube->dim / cube->dim;
    place->position[1] = first / cube->dim % cube->dim;
    place->position[2] = first % cube->dim;
    for (int corner = 0; corner < 8; ++corner) {
        int step = (corner / 4 * cube->dim + corner / 2 % 2) * cube->dim + corner % 2;
        place->rows[corner] = uplift_row(cube, first + step);
        place->weights[corner] = sides[corner / 4] * sides[2 + corner / 2 % 2] * sides[4 + corner % 2];
        is_present = is_present && place->rows[corner] < cube->present;
    }
    return is_present;
}

int uplift_reflectances(
    const uplift_cube *cube, const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    uplift_place place;
    if (cube->points && !uplift_find(cube, rgb, &place)) {
        for (int k = 0; k < count; ++k) reflectances[k] = 0;
        return UPLIFT_NOT_IN_SCENE;
    }
    cube->kernel->reflectances(cube, rgb, wavelengths, count, reflectances);
    return UPLIFT_OK;
}

int uplift_reflectances_n(
    const uplift_cube *cube, const float *rgb, int n, const float *wavelengths, int count, float *reflectances)
{
    int result = UPLIFT_OK;
    for (int i = 0; i < n; ++i, rgb += 3, reflectances += count) {
        int found = uplift_reflectances(cube, rgb, wavelengths, count, reflectances);
        if (found != UPLIFT_OK) result = found;
    }
    return result;
}

/* Weighted error of nodes, times a factor, and of the entry of a colour; that of a look is expected, as those of nodes. */
static int uplift_expected_error(const uplift_cube *cube, const float rgb[3], double factor, float *error)
{
    uplift_place place;
    double sum = 0;
    *error = 0;
    if (!cube->standard_error) return UPLIFT_NO_ERRORS;
    if (!uplift_find(cube, rgb, &place)) return UPLIFT_NOT_IN_SCENE;
    for (int corner = 0; corner < 8; ++corner)
        sum += UPLIFT_CAST(double, place.weights[corner])
            * uplift_number_at(cube->standard_error, UPLIFT_CAST(size_t, place.rows[corner]));
    sum *= factor;
    if (place.entry >= 0) {
        double weight = UPLIFT_CAST(double, place.lattice_weight);
        double entry_error = uplift_number_at(cube->atlas_error, UPLIFT_CAST(size_t, place.entry));
        if (place.entry >= cube->content.entries - cube->content.looks) entry_error *= factor;
        sum = weight * sum + (1 - weight) * entry_error;
    }
    *error = UPLIFT_CAST(float, sum);
    return UPLIFT_OK;
}

int uplift_standard_error(const uplift_cube *cube, const float rgb[3], float *error)
{
    return uplift_expected_error(cube, rgb, 1, error);
}

int uplift_error_bound(const uplift_cube *cube, const float rgb[3], float *error)
{
    return uplift_expected_error(cube, rgb, cube->content.bound_factor, error);
}

int uplift_coefficient_count(const uplift_cube *cube)
{
    return UPLIFT_CAST(int, cube->content.count);
}

/* Whether a node has not its own colour; absent ones count as if they had. */
static int uplift_misses(const uplift_cube *cube, const int position[3])
{
    int row;
    for (int k = 0; k < 3; ++k)
        if (position[k] < 0 || position[k] >= cube->dim) return 0;
    row = uplift_row(cube, (position[0] * cube->dim + position[1]) * cube->dim + position[2]);
    return row < cube->present && uplift_number_at(cube->distance, UPLIFT_CAST(size_t, row)) > cube->content.threshold;
}

/* Whether coefficients of a colour would have to be moved: a corner of its cell shares a cell with such a node. */
static int uplift_is_moved(const uplift_cube *cube, const uplift_place *place)
{
    for (int corner = 0; corner < 8 * cube->is_inexact; ++corner)
        for (int step = 0; step < 27 && place->weights[corner] > 0; ++step) {
            const int position[3] = {
                place->position[0] + corner / 4 + step / 9 - 1, place->position[1] + corner / 2 % 2 + step / 3 % 3 - 1,
                place->position[2] + corner % 2 + step % 3 - 1};
            if (uplift_misses(cube, position)) return 1;
        }
    return 0;
}

int uplift_coefficients(const uplift_cube *cube, const float rgb[3], float *coefficients)
{
    const size_t count = UPLIFT_CAST(size_t, cube->content.count);
    uplift_place place;
    int result = UPLIFT_OK;
    if (!uplift_find(cube, rgb, &place)) result = UPLIFT_NOT_IN_SCENE;
    else if (uplift_is_moved(cube, &place)) result = UPLIFT_NO_COEFFICIENTS;
    for (size_t k = 0; k < count; ++k) {
        double sum = 0, weight = UPLIFT_CAST(double, place.lattice_weight);
        for (int corner = 0; corner < 8 && result == UPLIFT_OK; ++corner)
            sum += UPLIFT_CAST(double, place.weights[corner])
                * uplift_number_at(cube->coefficients, UPLIFT_CAST(size_t, place.rows[corner]) * count + k);
        if (place.entry >= 0 && result == UPLIFT_OK)
            sum = weight * sum
                + (1 - weight) * uplift_number_at(cube->atlas_coefficients, UPLIFT_CAST(size_t, place.entry) * count + k);
        coefficients[k] = UPLIFT_CAST(float, sum);
    }
    return result;
}

#if defined(__clang__)
#pragma clang diagnostic pop
#endif
#endif
#endif

#ifdef UPLIFT_KERNEL


/* Position of the list of entries whose boxes touch the cell above a lattice point, 0 for none; it is negative where
   answers in the cell are moved. Its fraction is 1/2 at points where coefficients are moved, 0 at others. */
UPLIFT_FUNCTION float UPLIFT_NAME(tag)(UPLIFT_READS int index)
{
    return uplift_number(UPLIFT_TABLE UPLIFT_ROW_OF(index) * UPLIFT_STRIDE + UPLIFT_COUNT);
}

/* Spectra are 1/2 + deviation(x), where x(lambda) is a polynomial with the multipliers as coefficients. */
#if UPLIFT_SIGMOIDS

/* Weighted x / (2 sqrt(1 + x^2)): the sigmoid around 1/2. */
UPLIFT_FUNCTION float UPLIFT_NAME(deviation)(float weight, float x)
{
    return weight * 0.5f * x / UPLIFT_SQRT(1.0f + x * x);
}

/* Wavelength scaled from the range to [-1, 1]; differences of magnitudes clip it. */
UPLIFT_FUNCTION float UPLIFT_NAME(scaled)(UPLIFT_READS_CUBE float wavelength)
{
    float x = (2.0f * wavelength - (UPLIFT_START + UPLIFT_END)) / (UPLIFT_END - UPLIFT_START);
    return 0.5f * (UPLIFT_ABS(x + 1.0f) - UPLIFT_ABS(x - 1.0f));
}

/* x = c_0 s^2 + c_1 s + c_2 of the multipliers from an index in the table. */
UPLIFT_FUNCTION float UPLIFT_NAME(argument)(UPLIFT_READS int first, float wavelength)
{
    float s = UPLIFT_NAME(scaled)(UPLIFT_CUBE wavelength);
    return (uplift_number(UPLIFT_TABLE first) * s + uplift_number(UPLIFT_TABLE first + 1)) * s
        + uplift_number(UPLIFT_TABLE first + 2);
}

/* Tabulate s^2, s, 1 at wavelengths in nm. */
UPLIFT_FUNCTION void UPLIFT_NAME(tabulate)(UPLIFT_READS_CUBE UPLIFT_IN float wavelengths[UPLIFT_WIDTH], UPLIFT_OUT float basis[UPLIFT_COUNT * UPLIFT_WIDTH])
{
    UPLIFT_VECTORISE
    for (int w = 0; w < UPLIFT_WIDTH; ++w) {
        float s = UPLIFT_NAME(scaled)(UPLIFT_CUBE wavelengths[w]);
        basis[w] = s * s;
        basis[UPLIFT_WIDTH + w] = s;
        basis[2 * UPLIFT_WIDTH + w] = 1.0f;
    }
}

#else

/* sin(pi x) for x in [-1/2, 1/2], to 6e-8 of the value. */
UPLIFT_FUNCTION float UPLIFT_NAME(sine_of_turn)(float x)
{
    float u = x * x;
    float series = 2.55006973f + u * (-0.59824213f + u * 0.07756039f);
    return x * (3.14159264f + u * (-5.16770968f + u * series));
}

/* Weighted arctan(x) / pi, to 6e-7, by arctan |x| = pi/4 + arctan t: conditions would keep loops from vectorising. To
   6e-8 where answers are moved, which magnifies errors. */
UPLIFT_FUNCTION float UPLIFT_NAME(deviation)(float weight, float x)
{
    float size = UPLIFT_ABS(x);
    float t = (size - 1.0f) / (size + 1.0f);
    float u = t * t;
#if UPLIFT_INEXACT
    float high = -0.045208186f + u * (0.0338578399f + u * (-0.0238587439f
        + u * (0.0135560565f + u * (-0.00509455944f + u * 0.000902110684f))));
    return UPLIFT_COPYSIGN(weight, x) * (0.25f + t * (0.318309881f + u * (-0.106102447f + u * (0.0636380517f + u * high))));
#else
    float high = 0.0616058142f + u * -0.0370596857f + u * u * (0.0167581496f + u * -0.0037303064f);
    return UPLIFT_COPYSIGN(weight, x) * (0.25f + t * (0.318302635f + u * -0.105877136f + u * u * high));
#endif
}

/* Wavelengths, evenly or as the eye distinguishes them. */
UPLIFT_FUNCTION float UPLIFT_NAME(warp)(UPLIFT_READS_CUBE float wavelength)
{
#if UPLIFT_WARPED
    float low = UPLIFT_WARP_0 * UPLIFT_TANH(UPLIFT_WARP_1 * (wavelength - UPLIFT_WARP_2));
    return low + UPLIFT_WARP_3 * UPLIFT_TANH(UPLIFT_WARP_4 * (wavelength - UPLIFT_WARP_5));
#else
    return wavelength;
#endif
}

/* Phase phi in turns, [-1/2, 1/2]; differences of magnitudes clip it to the range. */
UPLIFT_FUNCTION float UPLIFT_NAME(phase)(UPLIFT_READS_CUBE float wavelength)
{
    float turn = (UPLIFT_NAME(warp)(UPLIFT_CUBE wavelength) - UPLIFT_LOW) * UPLIFT_SCALE - 0.5f;
    return 0.5f * (UPLIFT_ABS(turn + 0.5f) - UPLIFT_ABS(turn - 0.5f));
}

/* x = p_0 + 2 p_1 cos(phi) + 2 p_2 cos(2 phi) + ... of the multipliers from an index in the table, by Chebyshev's
   2 cos(k + 1)phi = 2 cos(phi) 2 cos(k phi) - 2 cos(k - 1)phi. */
UPLIFT_FUNCTION float UPLIFT_NAME(argument)(UPLIFT_READS int first, float wavelength)
{
    float cosine = 2.0f * UPLIFT_NAME(sine_of_turn)(UPLIFT_NAME(phase)(UPLIFT_CUBE wavelength)), before = 2.0f, now = cosine;
    float x = uplift_number(UPLIFT_TABLE first);
    for (int k = 1; k < UPLIFT_ENTRY_COUNT; ++k) {
        float held = now;
        x += now * uplift_number(UPLIFT_TABLE first + k);
        now = cosine * now - before;
        before = held;
    }
    return x;
}

/* Tabulate 1, 2 cos(phi), ..., 2 cos(m phi) at wavelengths in nm, order by order:
   2 cos(j phi) 2 cos(k phi) = 2 cos(j + k)phi + 2 cos(j - k)phi. */
UPLIFT_FUNCTION void UPLIFT_NAME(tabulate)(UPLIFT_READS_CUBE UPLIFT_IN float wavelengths[UPLIFT_WIDTH], UPLIFT_OUT float basis[UPLIFT_COUNT * UPLIFT_WIDTH])
{
    UPLIFT_VECTORISE
    for (int w = 0; w < UPLIFT_WIDTH; ++w) {
        UPLIFT_ARRAY(cosine, UPLIFT_COUNT);
        cosine[1] = 2.0f * UPLIFT_NAME(sine_of_turn)(UPLIFT_NAME(phase)(UPLIFT_CUBE wavelengths[w]));
        UPLIFT_UNROLL
        for (int k = 2; k < UPLIFT_COUNT; ++k) {
            cosine[k] = cosine[k / 2] * cosine[k - k / 2] - (k % 2 == 0 ? 2.0f : cosine[1]);
        }
        basis[w] = 1.0f;
        UPLIFT_UNROLL
        for (int k = 1; k < UPLIFT_COUNT; ++k) basis[k * UPLIFT_WIDTH + w] = cosine[k];
    }
}

#endif

/* x: sum of multipliers times basis, even and odd orders apart. */
UPLIFT_FUNCTION float UPLIFT_NAME(polynomial)(
    UPLIFT_IN float values[UPLIFT_STRIDE], UPLIFT_IN float basis[UPLIFT_COUNT * UPLIFT_WIDTH], int w)
{
    float even = values[0] * basis[w] + values[2] * basis[2 * UPLIFT_WIDTH + w];
    float odd = values[1] * basis[UPLIFT_WIDTH + w];
    UPLIFT_UNROLL
    for (int k = 3; k < UPLIFT_COUNT; ++k) {
        if (k % 2 == 0) even += values[k] * basis[k * UPLIFT_WIDTH + w];
        else odd += values[k] * basis[k * UPLIFT_WIDTH + w];
    }
    return even + odd;
}

/* Reflectances of multipliers: 1/2 + deviation(x). */
UPLIFT_FUNCTION void UPLIFT_NAME(evaluate_block)(
    UPLIFT_IN float multipliers[UPLIFT_COUNT], UPLIFT_IN float basis[UPLIFT_COUNT * UPLIFT_WIDTH], UPLIFT_OUT float total[UPLIFT_WIDTH])
{
    UPLIFT_ARRAY(values, UPLIFT_STRIDE);
    UPLIFT_UNROLL
    for (int k = 0; k < UPLIFT_COUNT; ++k) values[k] = multipliers[k];
    UPLIFT_VECTORISE
    for (int w = 0; w < UPLIFT_WIDTH; ++w) total[w] = 0.5f + UPLIFT_NAME(deviation)(1.0f, UPLIFT_NAME(polynomial)(values, basis, w));
}

/* Index of the last node up to x, for x in [0, 1]. */
UPLIFT_FUNCTION int UPLIFT_NAME(cell)(UPLIFT_READS float x)
{
    int low = UPLIFT_INT(uplift_number(UPLIFT_TABLE UPLIFT_BINS + UPLIFT_INT(x * UPLIFT_REAL(UPLIFT_BIN_COUNT))));
    while (low < UPLIFT_DIM - 2 && x >= uplift_number(UPLIFT_TABLE UPLIFT_NODES + low + 1)) low += 1;
    return low;
}

/* Row of the lowest corner of a colour's cell. */
UPLIFT_FUNCTION int UPLIFT_NAME(first_corner)(UPLIFT_READS UPLIFT_IN float rgb[3])
{
    int red = UPLIFT_NAME(cell)(UPLIFT_TABLE rgb[0]), green = UPLIFT_NAME(cell)(UPLIFT_TABLE rgb[1]), blue = UPLIFT_NAME(cell)(UPLIFT_TABLE rgb[2]);
    return (red * UPLIFT_DIM + green) * UPLIFT_DIM + blue;
}

/* Clip to [0, 1]; NaN becomes 0. */
UPLIFT_FUNCTION float UPLIFT_NAME(clip)(float x)
{
    return x > 0.0f ? (x > 1.0f ? 1.0f : x) : 0.0f;
}

/* Find the entry in whose box a colour lies, or -1; set the colour and the weight of the lattice.

   In a box, x = (1 - t) e + t y, where the ray from the entry's colour e through x leaves the box at y. The lattice at y
   has weight t, the entry the rest. */
UPLIFT_FUNCTION int UPLIFT_NAME(locate)(UPLIFT_READS UPLIFT_IN float rgb[3], UPLIFT_OUT float place[UPLIFT_PLACE])
{
    UPLIFT_ARRAY(query, 3);
    for (int axis = 0; axis < 3; ++axis) place[axis] = UPLIFT_NAME(clip)(rgb[axis]);
    for (int axis = 0; axis < 3; ++axis) query[axis] = place[axis];
    int entry = -1;
    int listed = UPLIFT_INT(UPLIFT_ABS(UPLIFT_NAME(tag)(UPLIFT_TABLE UPLIFT_NAME(first_corner)(UPLIFT_TABLE query))));
    place[3] = 1.0f;
    if (listed > 0) {
        int last = listed + UPLIFT_INT(uplift_number(UPLIFT_TABLE UPLIFT_LISTS + listed));
        while (listed < last) {
            listed += 1;
            int candidate = UPLIFT_INT(uplift_number(UPLIFT_TABLE UPLIFT_LISTS + listed));
            int box = UPLIFT_BOXES + 12 * candidate;
            float reached = 0.0f;
            for (int axis = 0; axis < 3; ++axis) {
                float ray = query[axis] - uplift_number(UPLIFT_TABLE box + axis) - uplift_number(UPLIFT_TABLE box + 3 + axis);
                float part = ray > 0.0f ? ray * uplift_number(UPLIFT_TABLE box + 9 + axis)
                                        : -ray * uplift_number(UPLIFT_TABLE box + 6 + axis);
                reached = part > reached ? part : reached;
            }
            if (reached < 1.0f) {
                entry = candidate;
                place[3] = reached;
                listed = last;
            }
        }
    }
    if (entry >= 0 && place[3] > 0.0f)
        for (int axis = 0; axis < 3; ++axis) {
            int centre = UPLIFT_BOXES + 12 * entry + axis;
            float ray = query[axis] - uplift_number(UPLIFT_TABLE centre) - uplift_number(UPLIFT_TABLE centre + 3);
            place[axis] = UPLIFT_NAME(clip)(uplift_number(UPLIFT_TABLE centre) + ray / place[3]);
        }
    return entry;
}

/* Set the weights of the lower and upper side of each axis; return the row of the lowest corner. */
UPLIFT_FUNCTION int UPLIFT_NAME(weigh)(UPLIFT_READS UPLIFT_IN float place[UPLIFT_PLACE], UPLIFT_OUT float sides[6])
{
    int first = 0;
    for (int axis = 0; axis < 3; ++axis) {
        int low = UPLIFT_NAME(cell)(UPLIFT_TABLE place[axis]);
        float start = uplift_number(UPLIFT_TABLE UPLIFT_NODES + low);
        float share = (place[axis] - start) / (uplift_number(UPLIFT_TABLE UPLIFT_NODES + low + 1) - start);
        sides[2 * axis] = 1.0f - share;
        sides[2 * axis + 1] = share;
        first = first * UPLIFT_DIM + low;
    }
    return first;
}

/* Mix the spectrum of the lattice in `total` with that of an entry, which may have more multipliers. */
UPLIFT_FUNCTION void UPLIFT_NAME(add_entry)(
    UPLIFT_READS float lattice_weight, int entry, UPLIFT_IN float wavelengths[UPLIFT_WIDTH], UPLIFT_OUT float total[UPLIFT_WIDTH])
{
    UPLIFT_VECTORISE
    for (int w = 0; w < UPLIFT_WIDTH; ++w) {
        float x = UPLIFT_NAME(argument)(UPLIFT_TABLE UPLIFT_ENTRIES + entry * UPLIFT_ENTRY_COUNT, wavelengths[w]);
        total[w] = 0.5f + lattice_weight * (total[w] - 0.5f) + UPLIFT_NAME(deviation)(1.0f - lattice_weight, x);
    }
}

/* Reflectances of multipliers, mixed with those of an entry unless it is negative. */
UPLIFT_FUNCTION void UPLIFT_NAME(mix)(
    UPLIFT_READS UPLIFT_IN float multipliers[UPLIFT_COUNT], float lattice_weight, int entry,
    UPLIFT_IN float wavelengths[UPLIFT_WIDTH], UPLIFT_OUT float total[UPLIFT_WIDTH])
{
    UPLIFT_ARRAY(basis, UPLIFT_COUNT * UPLIFT_WIDTH);
    UPLIFT_NAME(tabulate)(UPLIFT_CUBE wavelengths, basis);
    UPLIFT_NAME(evaluate_block)(multipliers, basis, total);
    if (entry >= 0) UPLIFT_NAME(add_entry)(UPLIFT_TABLE lattice_weight, entry, wavelengths, total);
}

#if UPLIFT_SPECTRA

/* Add the weighted spectra of the eight lattice points around a colour. */
UPLIFT_FUNCTION void UPLIFT_NAME(add_nodes)(
    UPLIFT_READS UPLIFT_IN float place[UPLIFT_PLACE], UPLIFT_IN float basis[UPLIFT_COUNT * UPLIFT_WIDTH], UPLIFT_OUT float total[UPLIFT_WIDTH])
{
    UPLIFT_ARRAY(sides, 6);
    UPLIFT_ARRAY(weights, 8);
    UPLIFT_ARRAY(arguments, 8 * UPLIFT_WIDTH);
    int first = UPLIFT_NAME(weigh)(UPLIFT_TABLE place, sides);
    for (int corner = 0; corner < 8; ++corner) {
        UPLIFT_ROW(values, first + (corner / 4 * UPLIFT_DIM + corner / 2 % 2) * UPLIFT_DIM + corner % 2);
        weights[corner] = sides[corner / 4] * sides[2 + corner / 2 % 2] * sides[4 + corner % 2];
        UPLIFT_VECTORISE
        for (int w = 0; w < UPLIFT_WIDTH; ++w) arguments[corner * UPLIFT_WIDTH + w] = UPLIFT_NAME(polynomial)(values, basis, w);
    }
    UPLIFT_VECTORISE
    for (int w = 0; w < UPLIFT_WIDTH; ++w) {
        float x = total[w];
        UPLIFT_UNROLL
        for (int corner = 0; corner < 8; ++corner) x += UPLIFT_NAME(deviation)(weights[corner], arguments[corner * UPLIFT_WIDTH + w]);
        total[w] = x;
    }
}

/* Evaluate a colour that is located: the weighted spectra of lattice points and entry. */
UPLIFT_FUNCTION void UPLIFT_NAME(blend)(
    UPLIFT_READS UPLIFT_IN float place[UPLIFT_PLACE], int entry, UPLIFT_IN float wavelengths[UPLIFT_WIDTH],
    UPLIFT_OUT float total[UPLIFT_WIDTH])
{
    UPLIFT_ARRAY(basis, UPLIFT_COUNT * UPLIFT_WIDTH);
    UPLIFT_VECTORISE
    for (int w = 0; w < UPLIFT_WIDTH; ++w) total[w] = 0.5f;
    UPLIFT_NAME(tabulate)(UPLIFT_CUBE wavelengths, basis);
    UPLIFT_NAME(add_nodes)(UPLIFT_TABLE place, basis, total);
    if (entry >= 0) UPLIFT_NAME(add_entry)(UPLIFT_TABLE place[3], entry, wavelengths, total);
}

#else

/* Weighted coefficients of the eight lattice points around a colour. Where answers are moved, place[8] is set to the share
   that moves: 1 in cells with points that have not their own colours, less in those around them. */
UPLIFT_FUNCTION void UPLIFT_NAME(sum_nodes)(UPLIFT_READS UPLIFT_OUT float place[UPLIFT_PLACE], UPLIFT_OUT float coefficients[UPLIFT_COUNT])
{
    UPLIFT_ARRAY(sides, 6);
    int first = UPLIFT_NAME(weigh)(UPLIFT_TABLE place, sides);
    for (int k = 0; k < UPLIFT_COUNT; ++k) coefficients[k] = 0.0f;
#if UPLIFT_INEXACT
    place[8] = 0.0f;
#endif
    for (int red = 0; red < 2; ++red)
        for (int green = 0; green < 2; ++green)
            for (int blue = 0; blue < 2; ++blue) {
                UPLIFT_ROW(values, first + (red * UPLIFT_DIM + green) * UPLIFT_DIM + blue);
                float weight = sides[red] * sides[2 + green] * sides[4 + blue];
                for (int k = 0; k < UPLIFT_COUNT; ++k) coefficients[k] += weight * values[k];
#if UPLIFT_INEXACT
                float tag = UPLIFT_ABS(values[UPLIFT_COUNT]);
                place[8] += 2.0f * weight * (tag - UPLIFT_REAL(UPLIFT_INT(tag)));
#endif
            }
#if UPLIFT_INEXACT
    place[8] = UPLIFT_NAME(clip)(place[8]);
#endif
}

/* Weighted coefficients of the lattice and of an entry, in as many coefficients. */
UPLIFT_FUNCTION void UPLIFT_NAME(sum_coefficients)(
    UPLIFT_READS UPLIFT_OUT float place[UPLIFT_PLACE], int entry, UPLIFT_OUT float coefficients[UPLIFT_COUNT])
{
    UPLIFT_NAME(sum_nodes)(UPLIFT_TABLE place, coefficients);
    if (entry >= 0)
        for (int k = 0; k < UPLIFT_COUNT; ++k) {
            float value = uplift_number(UPLIFT_TABLE (UPLIFT_LATTICE + entry) * UPLIFT_STRIDE + k);
            coefficients[k] = place[3] * coefficients[k] + (1.0f - place[3]) * value;
        }
}

#if UPLIFT_SIGMOIDS

/* Coefficients of sigmoids are their multipliers: always true. */
UPLIFT_FUNCTION UPLIFT_BOOL UPLIFT_NAME(dual)(UPLIFT_IN float coefficients[UPLIFT_COUNT], UPLIFT_OUT float multipliers[UPLIFT_COUNT])
{
    for (int k = 0; k < UPLIFT_COUNT; ++k) multipliers[k] = coefficients[k];
    return UPLIFT_COUNT > 0;
}

#else

/* Multipliers of moments by Schur's algorithm [Schur 1917, see uplift.models.duality]; false where it breaks down.
   No branches, so that compilers compute several colours side by side. */
UPLIFT_EXPANDED UPLIFT_BOOL UPLIFT_NAME(dual)(UPLIFT_IN float moments[UPLIFT_COUNT], UPLIFT_OUT float multipliers[UPLIFT_COUNT])
{
    float middle = moments[0] - 0.5f, nearest = middle < 0.0f ? moments[0] : 1.0f - moments[0]; /* the middle rounds */
    float sine = UPLIFT_NAME(sine_of_turn)(nearest), cosine = -UPLIFT_NAME(sine_of_turn)(middle);
    UPLIFT_ARRAY(slope, UPLIFT_COUNT);
    UPLIFT_ARRAY(even, UPLIFT_COUNT);
    UPLIFT_ARRAY(odd, UPLIFT_COUNT);
    UPLIFT_ARRAY(upper, UPLIFT_COUNT);
    UPLIFT_ARRAY(lower, UPLIFT_COUNT);
    UPLIFT_ARRAY(first, UPLIFT_COUNT);
    UPLIFT_ARRAY(second, UPLIFT_COUNT);
    /* Power series of the exponential function of the moments: its odd and its even part. */
    UPLIFT_UNROLL
    for (int k = 0; k < UPLIFT_COUNT; ++k) {
        slope[k] = 3.14159265f * UPLIFT_REAL(k) * moments[k];
        odd[k] = slope[k];
        even[k] = first[k] = second[k] = k == 0 ? 1.0f : 0.0f;
    }
    UPLIFT_UNROLL
    for (int order = 1; order < UPLIFT_COUNT; ++order) {
        even[order] *= 1.0f / UPLIFT_REAL(order);
        odd[order] *= 1.0f / UPLIFT_REAL(order);
        UPLIFT_UNROLL
        for (int k = order + 1; k < UPLIFT_COUNT; ++k) {
            even[k] -= slope[k - order] * odd[order];
            odd[k] += slope[k - order] * even[order];
        }
    }
    UPLIFT_UNROLL
    for (int k = 0; k < UPLIFT_COUNT - 1; ++k) {
        upper[k] = odd[k + 1];
        lower[k] = sine * even[k] + cosine * odd[k];
    }
    /* Schur's steps: the reflection coefficients g, and the orthogonal polynomials of both kinds by their recurrence. */
    float room = 0.25f - middle * middle, scale = 2.0f;
    UPLIFT_UNROLL
    for (int order = 0; order < UPLIFT_COUNT - 1; ++order) {
        float g = upper[0] / lower[0], rest = 1.0f - g * g;
        room = rest < room ? rest : room;
        scale *= rest;
        UPLIFT_UNROLL
        for (int k = 0; k < UPLIFT_COUNT - 2 - order; ++k) {
            float held = upper[k + 1] - g * lower[k + 1];
            lower[k] -= g * upper[k];
            upper[k] = held;
        }
        UPLIFT_UNROLL
        for (int k = 0; k < order / 2 + 1; ++k) {
            float held = first[k];
            first[k] += g * first[order + 1 - k];
            first[order + 1 - k] += g * held;
            held = second[k];
            second[k] -= g * second[order + 1 - k];
            second[order + 1 - k] -= g * held;
        }
        if (order % 2 == 1) {
            first[(order + 1) / 2] *= 1.0f + g;
            second[(order + 1) / 2] *= 1.0f - g;
        }
    }
    /* Multipliers: weighted autocorrelations of both polynomials. */
    float opposite = cosine > 0.0f ? sine : 1.0f - cosine, adjacent = cosine > 0.0f ? 1.0f + cosine : sine;
    float first_weight = opposite / (adjacent * scale), second_weight = adjacent / (opposite * scale);
    UPLIFT_UNROLL
    for (int lag = 0; lag < UPLIFT_COUNT; ++lag) {
        float first_sum = first[0] * first[lag], second_sum = second[0] * second[lag];
        UPLIFT_UNROLL
        for (int k = 1; k < UPLIFT_COUNT - lag; ++k) {
            first_sum += first[k] * first[k + lag];
            second_sum += second[k] * second[k + lag];
        }
        multipliers[lag] = first_weight * first_sum - second_weight * second_sum;
    }
    return room > 0.0f && scale > 1e-30f;
}

#endif

/* Multipliers, with as little grey as necessary; false, and those of a grey, if no spectrum fits. */
UPLIFT_FUNCTION UPLIFT_BOOL UPLIFT_NAME(multipliers_of)(UPLIFT_IN float coefficients[UPLIFT_COUNT], UPLIFT_OUT float multipliers[UPLIFT_COUNT])
{
    UPLIFT_ARRAY(mixed, UPLIFT_COUNT);
    float share = 0.0f;
    int attempt = 0;
    UPLIFT_BOOL valid;
    do {
        for (int k = 0; k < UPLIFT_COUNT; ++k) mixed[k] = coefficients[k] * (1.0f - share);
        mixed[0] += 0.5f * share;
        valid = UPLIFT_NAME(dual)(mixed, multipliers);
        share = attempt == 0 ? 0.0000001f : share * 10.0f;
        attempt += 1;
    } while (!valid && attempt < 5);
    if (!valid)
        for (int k = 0; k < UPLIFT_COUNT; ++k) multipliers[k] = 0.0f;
    return valid;
}

/* Evaluate a colour that is located: the spectrum of the lattice's weighted coefficients, mixed with that of the entry. */
UPLIFT_FUNCTION void UPLIFT_NAME(blend)(
    UPLIFT_READS UPLIFT_OUT float place[UPLIFT_PLACE], int entry, UPLIFT_IN float wavelengths[UPLIFT_WIDTH],
    UPLIFT_OUT float total[UPLIFT_WIDTH])
{
    UPLIFT_ARRAY(coefficients, UPLIFT_COUNT);
    UPLIFT_ARRAY(multipliers, UPLIFT_COUNT);
    UPLIFT_NAME(sum_nodes)(UPLIFT_TABLE place, coefficients);
    UPLIFT_NAME(multipliers_of)(coefficients, multipliers);
    UPLIFT_NAME(mix)(UPLIFT_TABLE multipliers, place[3], entry, wavelengths, total);
}

#endif

#if UPLIFT_INEXACT

/* The argument x of a reflectance 1/2 + deviation(x), at least a distance away from 0 and 1. */
UPLIFT_FUNCTION float UPLIFT_NAME(linear)(float reflectance, float away)
{
    float middle = reflectance - 0.5f;
    float size = UPLIFT_ABS(middle) < 0.5f - away ? UPLIFT_ABS(middle) : 0.5f - away;
#if UPLIFT_SIGMOIDS
    float x = size / UPLIFT_SQRT((0.5f - size) * (0.5f + size));
#else
    float x = UPLIFT_NAME(sine_of_turn)(size) / UPLIFT_NAME(sine_of_turn)(0.5f - size);
#endif
    return UPLIFT_COPYSIGN(x, middle);
}

/* The requested colour; one that is not well inside the colours of reflectances moves there, towards its grey. */
UPLIFT_FUNCTION void UPLIFT_NAME(realise)(UPLIFT_READS UPLIFT_OUT float rgb[3])
{
    UPLIFT_ARRAY(chroma, 3);
    float grey = 0.0f, size = UPLIFT_MARGIN, reach = 2.0f;
    for (int axis = 0; axis < 3; ++axis) grey += uplift_number(UPLIFT_TABLE UPLIFT_LUMINANCE + axis) * rgb[axis];
    grey = UPLIFT_MARGIN + (1.0f - 2.0f * UPLIFT_MARGIN) * UPLIFT_NAME(clip)((grey - UPLIFT_MARGIN) / (1.0f - 2.0f * UPLIFT_MARGIN));
    for (int axis = 0; axis < 3; ++axis) {
        chroma[axis] = rgb[axis] - grey;
        size = UPLIFT_ABS(chroma[axis]) > size ? UPLIFT_ABS(chroma[axis]) : size;
    }
    for (int facet = UPLIFT_FACETS; facet < UPLIFT_FACETS + 4 * UPLIFT_FACET_COUNT; facet += 4) {
        float along = 0.0f, speed = 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
            float normal = uplift_number(UPLIFT_TABLE facet + axis);
            along += normal * (grey - 0.5f);
            speed += normal * chroma[axis];
        }
        float room = uplift_number(UPLIFT_TABLE facet + 3) - (speed > 0.0f ? along : -along);
        room = room > 0.0f ? room : 0.0f;
        if (UPLIFT_ABS(speed) * reach > room) reach = room / UPLIFT_ABS(speed);
    }
    reach -= UPLIFT_MARGIN / size;
    if (reach < 1.0f)
        for (int axis = 0; axis < 3; ++axis) rgb[axis] = grey + (reach > 0.0f ? reach : 0.0f) * chroma[axis];
}

/* Set the residual, three numbers, and the derivative of the colour, six, of arguments that move by `change`. */
UPLIFT_FUNCTION void UPLIFT_NAME(residual)(
    UPLIFT_READS UPLIFT_IN float given[UPLIFT_SAMPLE_ROOM], UPLIFT_IN UPLIFT_FINE goal[3], UPLIFT_IN UPLIFT_FINE change[3], UPLIFT_OUT UPLIFT_FINE found[9])
{
    for (int k = 0; k < 9; ++k) found[k] = k < 3 ? goal[k] : UPLIFT_EXACT(0.0f);
    for (int row = 0; row < UPLIFT_SAMPLES; ++row) {
        int at = UPLIFT_PULL + 6 * row;
        UPLIFT_FINES(weight, 3);
        UPLIFT_FINES(shape, 3);
        UPLIFT_FINE x = UPLIFT_EXACT(given[row]);
        for (int k = 0; k < 3; ++k) {
            weight[k] = UPLIFT_EXACT(uplift_number(UPLIFT_TABLE at + k));
            shape[k] = UPLIFT_EXACT(uplift_number(UPLIFT_TABLE at + 3 + k));
            x += shape[k] * change[k];
        }
#if UPLIFT_SIGMOIDS
        UPLIFT_FINE root = UPLIFT_SQUARE_ROOT(1.0f + x * x);
        UPLIFT_FINE value = 0.5f + 0.5f * x / root, slope = 0.5f / (root * root * root);
#else
        UPLIFT_FINE value = 0.5f + UPLIFT_TURN(x), slope = UPLIFT_EXACT(0.318309886f) / (1.0f + x * x);
#endif
        for (int a = 0; a < 3; ++a) {
            found[a] -= weight[a] * value;
            for (int b = 0; b <= a; ++b) found[3 + a * (a + 1) / 2 + b] += weight[a] * slope * shape[b];
        }
    }
}

/* Newton's step of residual and derivative. */
UPLIFT_FUNCTION void UPLIFT_NAME(step)(UPLIFT_IN UPLIFT_FINE found[9], UPLIFT_OUT UPLIFT_FINE change[3])
{
    UPLIFT_FINE least = UPLIFT_TINY * (found[3] + found[5] + found[8]);
    UPLIFT_FINE d0 = found[3] > least ? found[3] : least, l1 = found[4] / d0, l2 = found[6] / d0;
    UPLIFT_FINE d1 = found[5] - l1 * found[4], d2, l3;
    d1 = d1 > least ? d1 : least;
    l3 = (found[7] - l2 * found[4]) / d1;
    d2 = found[8] - l2 * found[6] - l3 * l3 * d1;
    d2 = d2 > least ? d2 : least;
    change[1] = found[1] - l1 * found[0];
    change[2] = (found[2] - l2 * found[0] - l3 * change[1]) / d2;
    change[1] = change[1] / d1 - l3 * change[2];
    change[0] = found[0] / d0 - l1 * change[1] - l2 * change[2];
}

/* Take a part of a step, less if arguments x, which have moved by `change`, would move farther than UPLIFT_REACH (1 + |x|). */
UPLIFT_FUNCTION UPLIFT_FINE UPLIFT_NAME(shorten)(
    UPLIFT_READS UPLIFT_IN float given[UPLIFT_SAMPLE_ROOM], UPLIFT_IN UPLIFT_FINE change[3], UPLIFT_FINE part, UPLIFT_OUT UPLIFT_FINE move[3])
{
    UPLIFT_FINE kept = part;
    for (int row = 0; row < UPLIFT_SAMPLES; ++row) {
        UPLIFT_FINE x = UPLIFT_EXACT(given[row]), by = UPLIFT_EXACT(0.0f);
        for (int k = 0; k < 3; ++k) {
            UPLIFT_FINE shape = UPLIFT_EXACT(uplift_number(UPLIFT_TABLE UPLIFT_PULL + 6 * row + 3 + k));
            x += shape * change[k];
            by += shape * move[k];
        }
        x = x > 0.0f ? x : -x;
        by = by > 0.0f ? by : -by;
        if (kept * by > UPLIFT_REACH * (1.0f + x)) kept = UPLIFT_REACH * (1.0f + x) / by;
    }
    for (int k = 0; k < 3; ++k) move[k] *= kept;
    return kept;
}

/* Set place[4] to place[6], by which arguments move along the curves of the sensor, so that the answer has its colour:
   the minimum of a convex function [uplift.lookup.refine]. place[7] is how far from 0 and 1 they start. */
UPLIFT_SELDOM void UPLIFT_NAME(pull)(UPLIFT_READS UPLIFT_IN float rgb[3], int entry, UPLIFT_OUT float place[UPLIFT_PLACE])
{
    UPLIFT_ARRAY(colour, 3);
    UPLIFT_ARRAY(at, UPLIFT_WIDTH);
    UPLIFT_ARRAY(total, UPLIFT_WIDTH);
    UPLIFT_ARRAY(given, UPLIFT_SAMPLE_ROOM);
    UPLIFT_FINES(goal, 3);
    UPLIFT_FINES(change, 3);
    UPLIFT_FINES(trial, 3);
    UPLIFT_FINES(move, 3);
    UPLIFT_FINES(found, 9);
    UPLIFT_FINES(after, 9);
    UPLIFT_FINE part = UPLIFT_EXACT(1.0f), off = UPLIFT_EXACT(1.0f);
    for (int start = 0; start < UPLIFT_SAMPLES; start += UPLIFT_WIDTH) {
        for (int w = 0; w < UPLIFT_WIDTH; ++w) at[w] = UPLIFT_FIRST + UPLIFT_STEP * UPLIFT_REAL(start + w);
        UPLIFT_NAME(blend)(UPLIFT_TABLE place, entry, at, total);
        for (int w = 0; w < UPLIFT_WIDTH && start + w < UPLIFT_SAMPLES; ++w) given[start + w] = total[w];
    }
    for (int axis = 0; axis < 3; ++axis) colour[axis] = UPLIFT_NAME(clip)(rgb[axis]);
    UPLIFT_NAME(realise)(UPLIFT_TABLE colour);
    for (int axis = 0; axis < 3; ++axis) {
        goal[axis] = change[axis] = UPLIFT_EXACT(0.0f);
        for (int k = 0; k < 3; ++k)
            goal[axis] += UPLIFT_EXACT(uplift_number(UPLIFT_TABLE UPLIFT_SCALES + 3 * axis + k)) * colour[k];
    }
    place[7] = 0.0f;
    for (int k = 0; k < 3; ++k) {
        float rest = UPLIFT_REAL(goal[k]);
        for (int row = 0; row < UPLIFT_SAMPLES; ++row) rest -= uplift_number(UPLIFT_TABLE UPLIFT_PULL + 6 * row + k) * given[row];
        place[7] = UPLIFT_ABS(rest) > place[7] ? UPLIFT_ABS(rest) : place[7];
    }
    float least = 1e-6f + UPLIFT_STEEP * place[7];
    place[7] = UPLIFT_LEAST + UPLIFT_SLOPE * place[7];
    place[7] = place[7] < least ? place[7] : least;
    place[7] = place[7] < UPLIFT_MOST ? place[7] : UPLIFT_MOST;
    for (int row = 0; row < UPLIFT_SAMPLES; ++row) given[row] = UPLIFT_NAME(linear)(given[row], place[7]);
    UPLIFT_NAME(residual)(UPLIFT_TABLE given, goal, change, found);
    for (int turn = 0; turn < UPLIFT_STEPS && off > UPLIFT_TOLERANCE; ++turn) {
        UPLIFT_FINE before = UPLIFT_EXACT(0.0f), beyond = UPLIFT_EXACT(0.0f);
        UPLIFT_NAME(step)(found, move);
        part = UPLIFT_NAME(shorten)(UPLIFT_TABLE given, change, part, move);
        for (int k = 0; k < 3; ++k) trial[k] = change[k] + move[k];
        UPLIFT_NAME(residual)(UPLIFT_TABLE given, goal, trial, after);
        for (int k = 0; k < 3; ++k) {
            before += found[k] * move[k];
            beyond += after[k] * move[k];
        }
        if (beyond >= -0.5f * before && after[3] + after[5] + after[8] >= 0.01f * (found[3] + found[5] + found[8])) {
            for (int k = 0; k < 3; ++k) change[k] = trial[k];
            for (int k = 0; k < 9; ++k) found[k] = after[k];
            part = part < 0.25f ? 4.0f * part : UPLIFT_EXACT(1.0f);
        } else {
            part *= 0.25f;
        }
        off = UPLIFT_EXACT(0.0f);
        for (int k = 0; k < 3; ++k) {
            UPLIFT_FINE size = found[k] > 0.0f ? found[k] : -found[k];
            off = size > off ? size : off;
        }
    }
    for (int k = 0; k < 3; ++k) place[4 + k] = UPLIFT_REAL(change[k]);
}

/* Find the entry in whose box a colour lies, or -1; set what `UPLIFT_NAME(answer)` needs. */
UPLIFT_FUNCTION int UPLIFT_NAME(find)(UPLIFT_READS UPLIFT_IN float rgb[3], UPLIFT_OUT float place[UPLIFT_PLACE])
{
    int entry = UPLIFT_NAME(locate)(UPLIFT_TABLE rgb, place);
    UPLIFT_ARRAY(colour, 3);
    for (int axis = 0; axis < 3; ++axis) {
        colour[axis] = place[axis];
        place[4 + axis] = 0.0f;
    }
    if (UPLIFT_NAME(tag)(UPLIFT_TABLE UPLIFT_NAME(first_corner)(UPLIFT_TABLE colour)) < 0.0f) UPLIFT_NAME(pull)(UPLIFT_TABLE rgb, entry, place);
    return entry;
}

/* Move reflectances by what `UPLIFT_NAME(find)` set. */
UPLIFT_FUNCTION void UPLIFT_NAME(move)(
    UPLIFT_READS UPLIFT_IN float place[UPLIFT_PLACE], UPLIFT_IN float wavelengths[UPLIFT_WIDTH], UPLIFT_OUT float total[UPLIFT_WIDTH])
{
    if (place[4] != 0.0f || place[5] != 0.0f || place[6] != 0.0f)
        for (int w = 0; w < UPLIFT_WIDTH; ++w) {
            float position = (wavelengths[w] - UPLIFT_FIRST) / UPLIFT_STEP, x = UPLIFT_NAME(linear)(total[w], place[7]);
            position = UPLIFT_NAME(clip)(position / UPLIFT_REAL(UPLIFT_SAMPLES - 1)) * UPLIFT_REAL(UPLIFT_SAMPLES - 1);
            int row = UPLIFT_INT(position) < UPLIFT_SAMPLES - 1 ? UPLIFT_INT(position) : UPLIFT_SAMPLES - 2;
            float share = position - UPLIFT_REAL(row);
            for (int k = 0; k < 3; ++k) {
                int shape = UPLIFT_PULL + 6 * row + 3 + k;
                x += place[4 + k]
                    * ((1.0f - share) * uplift_number(UPLIFT_TABLE shape) + share * uplift_number(UPLIFT_TABLE shape + 6));
            }
#if UPLIFT_SPECTRA
            total[w] = 0.5f + UPLIFT_NAME(deviation)(1.0f, x);
#else
            total[w] = (1.0f - place[8]) * total[w] + place[8] * (0.5f + UPLIFT_NAME(deviation)(1.0f, x));
#endif
        }
}

/* Evaluate a colour that is found: with exactly its colour in mode spectra. */
UPLIFT_FUNCTION void UPLIFT_NAME(answer)(
    UPLIFT_READS UPLIFT_OUT float place[UPLIFT_PLACE], int entry, UPLIFT_IN float wavelengths[UPLIFT_WIDTH],
    UPLIFT_OUT float total[UPLIFT_WIDTH])
{
    UPLIFT_NAME(blend)(UPLIFT_TABLE place, entry, wavelengths, total);
    UPLIFT_NAME(move)(UPLIFT_TABLE place, wavelengths, total);
}

#else
UPLIFT_ALIASES
#endif

/* Reflectances of the multipliers of a place, mixed with those of an entry unless it is negative, at wavelengths in nm. */
UPLIFT_FUNCTION void UPLIFT_NAME(mix_all)(
    UPLIFT_READS_CUBE const float multipliers[UPLIFT_COUNT], const float place[UPLIFT_PLACE], int entry, const float *wavelengths, int count,
    float *reflectances)
{
    int start;
    for (start = 0; start + UPLIFT_WIDTH <= count; start += UPLIFT_WIDTH) {
        UPLIFT_NAME(mix)(UPLIFT_CUBE multipliers, place[3], entry, wavelengths + start, reflectances + start);
#if UPLIFT_INEXACT
        UPLIFT_NAME(move)(UPLIFT_CUBE place, wavelengths + start, reflectances + start);
#endif
    }
    if (start < count) {
        float block[UPLIFT_WIDTH] = {0}, found[UPLIFT_WIDTH];
        memcpy(block, wavelengths + start, UPLIFT_CAST(size_t, count - start) * sizeof *block);
        UPLIFT_NAME(mix)(UPLIFT_CUBE multipliers, place[3], entry, block, found);
#if UPLIFT_INEXACT
        UPLIFT_NAME(move)(UPLIFT_CUBE place, block, found);
#endif
        memcpy(reflectances + start, found, UPLIFT_CAST(size_t, count - start) * sizeof *found);
    }
}

/* Reflectances of stored multipliers at wavelengths in nm. */
UPLIFT_FUNCTION void UPLIFT_NAME(evaluate)(
    UPLIFT_READS_CUBE const float multipliers[UPLIFT_COUNT], const float *wavelengths, int count, float *reflectances)
{
    const float place[UPLIFT_PLACE] = {0, 0, 0, 1};
    UPLIFT_NAME(mix_all)(UPLIFT_CUBE multipliers, place, -1, wavelengths, count, reflectances);
}

#if UPLIFT_SPECTRA

/* Reflectances of linear RGB at wavelengths in nm; their colour is exactly this RGB. Clips RGB to [0, 1]. */
UPLIFT_FUNCTION void UPLIFT_NAME(reflectances)(UPLIFT_READS_CUBE const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    float place[UPLIFT_PLACE];
    int start, entry = UPLIFT_NAME(find)(UPLIFT_CUBE rgb, place);
    for (start = 0; start + UPLIFT_WIDTH <= count; start += UPLIFT_WIDTH)
        UPLIFT_NAME(answer)(UPLIFT_CUBE place, entry, wavelengths + start, reflectances + start);
    if (start < count) {
        float block[UPLIFT_WIDTH] = {0}, found[UPLIFT_WIDTH];
        memcpy(block, wavelengths + start, UPLIFT_CAST(size_t, count - start) * sizeof *block);
        UPLIFT_NAME(answer)(UPLIFT_CUBE place, entry, block, found);
        memcpy(reflectances + start, found, UPLIFT_CAST(size_t, count - start) * sizeof *found);
    }
}

/* The same of n colours at the same wavelengths. */
UPLIFT_FUNCTION void UPLIFT_NAME(reflectances_n)(
    UPLIFT_READS_CUBE const float *rgb, int n, const float *wavelengths, int count, float *reflectances)
{
    for (int i = 0; i < n; ++i, rgb += 3, reflectances += count) UPLIFT_NAME(reflectances)(UPLIFT_CUBE rgb, wavelengths, count, reflectances);
}

#else

/* Coefficients of linear RGB, which are linear in the spectrum: they can be filtered. Clips RGB to [0, 1]. */
UPLIFT_FUNCTION void UPLIFT_NAME(coefficients)(const float rgb[3], float coefficients[UPLIFT_COUNT])
{
    float place[UPLIFT_PLACE];
    int entry = UPLIFT_NAME(locate)(UPLIFT_CUBE rgb, place);
    UPLIFT_NAME(sum_coefficients)(UPLIFT_CUBE place, entry, coefficients);
}

/* Multipliers of coefficients, once per texel. Returns 0 for numbers that are the coefficients of no spectrum. */
UPLIFT_FUNCTION int UPLIFT_NAME(multipliers)(const float coefficients[UPLIFT_COUNT], float multipliers[UPLIFT_COUNT])
{
    return UPLIFT_NAME(multipliers_of)(coefficients, multipliers);
}

/* Multipliers of UPLIFT_LANES colours side by side, in the lanes of vector registers: moment k of colour i is
   moments[k * UPLIFT_LANES + i]; `valid` is 0 where the algorithm breaks down. */
UPLIFT_FUNCTION void UPLIFT_NAME(duals)(
    const float moments[UPLIFT_COUNT * UPLIFT_LANES], float multipliers[UPLIFT_COUNT * UPLIFT_LANES], float valid[UPLIFT_LANES])
{
    UPLIFT_VECTORISE
    for (int lane = 0; lane < UPLIFT_LANES; ++lane) {
        float given[UPLIFT_COUNT], found[UPLIFT_COUNT];
        UPLIFT_UNROLL
        for (int k = 0; k < UPLIFT_COUNT; ++k) given[k] = moments[k * UPLIFT_LANES + lane];
        valid[lane] = UPLIFT_NAME(dual)(given, found) ? 1.0f : 0.0f;
        UPLIFT_UNROLL
        for (int k = 0; k < UPLIFT_COUNT; ++k) multipliers[k * UPLIFT_LANES + lane] = found[k];
    }
}

/* Multipliers of the coefficients of up to UPLIFT_LANES colours, in one pass. Returns how many have no spectrum. */
UPLIFT_FUNCTION int UPLIFT_NAME(multipliers_of_lanes)(const float *coefficients, int colours, float *multipliers)
{
    float given[UPLIFT_COUNT * UPLIFT_LANES] = {0}, found[UPLIFT_COUNT * UPLIFT_LANES], valid[UPLIFT_LANES];
    int failed = 0;
    for (int lane = 0; lane < colours; ++lane)
        for (int k = 0; k < UPLIFT_COUNT; ++k) given[UPLIFT_LANES * k + lane] = coefficients[UPLIFT_COUNT * lane + k];
    UPLIFT_NAME(duals)(given, found, valid);
    for (int lane = 0; lane < colours; ++lane) {
        float *own = multipliers + UPLIFT_COUNT * lane;
        if (valid[lane] > 0)
            for (int k = 0; k < UPLIFT_COUNT; ++k) own[k] = found[UPLIFT_LANES * k + lane];
        else
            failed += !UPLIFT_NAME(multipliers_of)(coefficients + UPLIFT_COUNT * lane, own);
    }
    return failed;
}

/* Multipliers of the coefficients of n colours: faster than one by one. Returns how many have no spectrum. */
UPLIFT_FUNCTION int UPLIFT_NAME(multipliers_n)(const float *coefficients, int n, float *multipliers)
{
    int failed = 0;
    for (; n > 0; n -= UPLIFT_LANES, coefficients += UPLIFT_COUNT * UPLIFT_LANES, multipliers += UPLIFT_COUNT * UPLIFT_LANES)
        failed += UPLIFT_NAME(multipliers_of_lanes)(coefficients, n < UPLIFT_LANES ? n : UPLIFT_LANES, multipliers);
    return failed;
}

/* Reflectances of linear RGB at wavelengths in nm; their colour is this RGB, approximately. Clips RGB to [0, 1]. */
UPLIFT_FUNCTION void UPLIFT_NAME(reflectances)(UPLIFT_READS_CUBE const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    float place[UPLIFT_PLACE], coefficients[UPLIFT_COUNT], multipliers[UPLIFT_COUNT];
    int entry = UPLIFT_NAME(find)(UPLIFT_CUBE rgb, place);
    UPLIFT_NAME(sum_nodes)(UPLIFT_CUBE place, coefficients);
    UPLIFT_NAME(multipliers_of)(coefficients, multipliers);
    UPLIFT_NAME(mix_all)(UPLIFT_CUBE multipliers, place, entry, wavelengths, count, reflectances);
}

/* The same of n colours at the same wavelengths: faster than one by one. */
UPLIFT_FUNCTION void UPLIFT_NAME(reflectances_n)(
    UPLIFT_READS_CUBE const float *rgb, int n, const float *wavelengths, int count, float *reflectances)
{
    for (; n > 0; n -= UPLIFT_LANES) {
        float places[UPLIFT_PLACE * UPLIFT_LANES], numbers[UPLIFT_COUNT * UPLIFT_LANES], multipliers[UPLIFT_COUNT * UPLIFT_LANES];
        int entries[UPLIFT_LANES], colours = n < UPLIFT_LANES ? n : UPLIFT_LANES;
        for (int lane = 0; lane < colours; ++lane, rgb += 3) {
            entries[lane] = UPLIFT_NAME(find)(UPLIFT_CUBE rgb, places + UPLIFT_PLACE * lane);
            UPLIFT_NAME(sum_nodes)(UPLIFT_CUBE places + UPLIFT_PLACE * lane, numbers + UPLIFT_COUNT * lane);
        }
        UPLIFT_NAME(multipliers_of_lanes)(numbers, colours, multipliers);
        for (int lane = 0; lane < colours; ++lane, reflectances += count)
            UPLIFT_NAME(mix_all)(
                UPLIFT_CUBE multipliers + UPLIFT_COUNT * lane, places + UPLIFT_PLACE * lane, entries[lane], wavelengths, count, reflectances);
    }
}

#endif

/* Find the cell in which the lattice is evaluated for a colour, its lowest corner and the weights of its sides, and the
   entry in whose box the colour lies, or -1. */
static int UPLIFT_NAME(place)(const uplift_cube *cube, const float *rgb, float *lattice_weight, float *sides, int *first)
{
    float place[UPLIFT_PLACE];
    int entry = UPLIFT_NAME(locate)(cube, rgb, place);
    *lattice_weight = place[3];
    *first = UPLIFT_NAME(weigh)(cube, place, sides);
    return entry;
}

static void UPLIFT_NAME(answer_all)(
    const uplift_cube *cube, const float *rgb, const float *wavelengths, int count, float *reflectances)
{
    UPLIFT_NAME(reflectances)(cube, rgb, wavelengths, count, reflectances);
}

static const uplift_kernel UPLIFT_NAME(functions) = {UPLIFT_NAME(answer_all), UPLIFT_NAME(place)};

#undef UPLIFT_KERNEL
#undef UPLIFT_COUNT
#undef UPLIFT_ENTRY_COUNT
#undef UPLIFT_STRIDE
#undef UPLIFT_SIGMOIDS
#undef UPLIFT_WARPED
#undef UPLIFT_INEXACT
#undef UPLIFT_PLACE
#undef UPLIFT_ROW_OF
#endif
