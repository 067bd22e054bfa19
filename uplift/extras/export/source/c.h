/* C99 and C++. The table is static: include this file in one source file.
   UP_WIDTH wavelengths are evaluated at a time. Loops over them vectorise: cc -O3 -march=x86-64-v3. */
#ifndef UP_UPLIFT_H
#define UP_UPLIFT_H

#include <math.h>
#include <string.h>

#ifdef __cplusplus
#define UP_CAST(type, x) static_cast<type>(x)
#else
#define UP_CAST(type, x) ((type)(x))
#endif
#ifndef UP_WIDTH
#define UP_WIDTH ${width}
#endif
#define UP_LANES 16
#define UP_FUNCTION static inline
#define UP_READS
#define UP_TABLE
#define UP_SELDOM UP_FUNCTION
#define UP_BLOCK UP_WIDTH
#define UP_ROW(index) (up_table + (index) * UP_STRIDE)
#include "loops.c"
#include "numbers.c"
#include "host.c"
${program}
#include "loops_end.c"
#endif
