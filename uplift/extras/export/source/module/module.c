/* The module in uplift.js: uplift.h for WebAssembly. */
#define UPLIFT_NO_FILES
#define UPLIFT_IMPLEMENTATION
#include <uplift.h>

/* The digest of the source, and the compiler. */
const char uplift_source[] = UPLIFT_SOURCE " clang " __clang_version__;

/* Memory for the numbers of a call, of an open cube; the next call has the same. NULL if there is too little. */
void *uplift_scratch(size_t size)
{
    static size_t first;
    if (first) uplift_used = first;
    else first = uplift_used;
    return malloc(size);
}
