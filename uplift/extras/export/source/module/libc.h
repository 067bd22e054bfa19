/* What uplift.h uses of the C library, for WebAssembly: mathematics is imported from JavaScript, memory is given once and
   never taken back, as every cube has a module of its own. */
#ifndef UPLIFT_LIBC_H
#define UPLIFT_LIBC_H

#include <stddef.h>

double sin(double), cos(double), tan(double), tanh(double), atan(double), exp(double);
#define fabs __builtin_fabs
#define fabsf __builtin_fabsf
#define sqrt __builtin_sqrt
#define sqrtf __builtin_sqrtf
#define copysignf __builtin_copysignf
#define tanhf(x) ((float)tanh((double)(x)))

void *memcpy(void *to, const void *from, size_t size)
{
    return __builtin_memcpy(to, from, size); /* an instruction */
}

void *memmove(void *to, const void *from, size_t size)
{
    return __builtin_memmove(to, from, size);
}

void *memset(void *to, int value, size_t size)
{
    return __builtin_memset(to, value, size);
}

int memcmp(const void *one, const void *other, size_t size)
{
    const unsigned char *first = one, *second = other;
    size_t k = 0;
    while (k < size && first[k] == second[k]) k += 1;
    return k < size ? first[k] - second[k] : 0;
}

void *memchr(const void *bytes, int value, size_t size)
{
    const unsigned char *first = bytes;
    for (size_t k = 0; k < size; ++k)
        if (first[k] == value) return (void *)(first + k);
    return NULL;
}

size_t strlen(const char *text)
{
    size_t length = 0;
    while (text[length]) length += 1;
    return length;
}

char *strchr(const char *text, int value)
{
    return memchr(text, value, strlen(text) + 1);
}

extern unsigned char __heap_base;
static size_t uplift_used;

/* The next bytes of the memory, which grows by pages. */
void *malloc(size_t size)
{
    const size_t page = 65536, most = 0xFFFF0000;
    size_t first = uplift_used ? uplift_used : ((size_t)&__heap_base + 15) / 16 * 16;
    size_t room = __builtin_wasm_memory_size(0) * page, end;
    if (size > most - first) return NULL;
    end = (first + size + 15) / 16 * 16;
    if (end > room && __builtin_wasm_memory_grow(0, (end - room + page - 1) / page) == (size_t)-1) return NULL;
    uplift_used = end;
    return (void *)first;
}

/* Memory that was not given before is 0. */
void *calloc(size_t count, size_t size)
{
    return size > 0 && count > (size_t)-1 / size ? NULL : malloc(count * size);
}

void free(void *memory)
{
    (void)memory;
}

static void uplift_swap(unsigned char *one, unsigned char *other, size_t size)
{
    for (size_t k = 0; k < size; ++k) {
        unsigned char held = one[k];
        one[k] = other[k];
        other[k] = held;
    }
}

/* Swap an item of a heap with the larger of its children until it is not less than either. */
static void uplift_sink(
    unsigned char *items, size_t parent, size_t count, size_t size, int (*compare)(const void *, const void *))
{
    for (size_t child = 2 * parent + 1; child < count; child = 2 * parent + 1) {
        if (child + 1 < count && compare(items + child * size, items + (child + 1) * size) < 0) child += 1;
        if (compare(items + parent * size, items + child * size) >= 0) return;
        uplift_swap(items + parent * size, items + child * size, size);
        parent = child;
    }
}

/* Heapsort, whose time is bounded for every file. */
void qsort(void *base, size_t count, size_t size, int (*compare)(const void *, const void *))
{
    unsigned char *items = base;
    for (size_t k = count / 2; k > 0; --k) uplift_sink(items, k - 1, count, size, compare);
    for (size_t last = count; last-- > 1;) {
        uplift_swap(items, items + last * size, size);
        uplift_sink(items, 0, last, size, compare);
    }
}

#endif
