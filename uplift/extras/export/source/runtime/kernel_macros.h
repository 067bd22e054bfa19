
/* Lookups follow, the source of the programs that `uplift export` writes: this file includes itself once for each number of
   coefficients. Others are filled up with zeros, which have the same spectrum. */
#define UP_JOIN(kernel, name) kernel##_##name
#define UP_NAME_OF(kernel, name) UP_JOIN(kernel, name)
#define UP_NAME(name) UP_NAME_OF(UP_KERNEL, name)
#if defined(__GNUC__) && !defined(__clang__)
#define UP_FUNCTION UP_EXPANDED /* gcc would not expand all in a file of so many; clang vectorises less if it has to */
#else
#define UP_FUNCTION static inline
#endif
#if defined(__GNUC__)
#define UP_SELDOM static __attribute__((noinline))
#define UP_UNUSED __attribute__((unused))
#else
#define UP_SELDOM static
#define UP_UNUSED
#endif
#define UP_LANES 16
#define UP_READS const uplift_cube *cube,
#define UP_TABLE cube,
#define UP_READS_CUBE UP_UNUSED UP_READS
#define UP_CUBE UP_TABLE
#define UP_ROW(name, index) const float *name = cube->numbers + UP_ROW_OF(index) * UP_STRIDE
UP_EXPANDED float uplift_number(const uplift_cube *cube, int index)
{
    return cube->numbers[index];
}

#define UP_SPECTRA 1
#define UP_BIN_COUNT 1024
${definitions}
${fields}
#define UP_WARP_0 cube->warp[0]
#define UP_WARP_1 cube->warp[1]
#define UP_WARP_2 cube->warp[2]
#define UP_WARP_3 cube->warp[3]
#define UP_WARP_4 cube->warp[4]
#define UP_WARP_5 cube->warp[5]
#if defined(__clang__)
#define UP_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define UP_UNROLL _Pragma("GCC unroll 32")
#else
#define UP_UNROLL
#endif
