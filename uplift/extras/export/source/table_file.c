#include <stdio.h>
#include <stdlib.h>

static float *up_table;

/* Load the table, ${stem}.bin: float32 numbers, little-endian. Returns NULL, or the reason why it cannot be used. */
static inline const char *up_load(const char *path)
{
    FILE *file = fopen(path, "rb");
    size_t size = ${size} * sizeof(float), count = 0, k;
    unsigned char *bytes = UP_CAST(unsigned char *, malloc(size + 1));
    float *table = UP_CAST(float *, malloc(size));
    unsigned long checksum = 0xFFFFFFFFUL; /* CRC-32, as in zlib */
    const char *problem = NULL;
    if (!file) problem = "the table cannot be opened";
    else if (!bytes || !table) problem = "out of memory";
    else count = fread(bytes, 1, size + 1, file);
    if (file) fclose(file);
    for (k = 0; k < count; ++k) {
        int bit;
        checksum ^= bytes[k];
        for (bit = 0; bit < 8; ++bit) checksum = checksum >> 1 ^ (checksum & 1 ? 0xEDB88320UL : 0);
    }
    if (!problem && (count != size || (checksum ^ 0xFFFFFFFFUL) != ${checksum}UL))
        problem = "the table is damaged or of another cube";
    for (k = 0; !problem && k < size / 4; ++k) {
        const unsigned char *four = bytes + 4 * k;
        unsigned int number = four[0] + 0x100U * four[1] + 0x10000U * four[2] + 0x1000000U * four[3];
        memcpy(table + k, &number, sizeof number);
    }
    free(bytes);
    if (problem) {
        free(table);
        return problem;
    }
    free(up_table);
    up_table = table;
    return NULL;
}
