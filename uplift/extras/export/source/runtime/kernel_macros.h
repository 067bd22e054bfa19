
/* Lookups follow, the source of the programs that `uplift export` writes, once for each of a few numbers of coefficients.
   Others are filled up with zeros, which have the same spectrum. */
#if defined(__GNUC__) && !defined(__clang__)
#define UP_FUNCTION UP_EXPANDED /* gcc would not expand all in a file of so many */
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
#define UP_READS UP_UNUSED const uplift_cube *cube,
#define UP_TABLE cube,
#define UP_READS_CUBE UP_READS
#define UP_CUBE UP_TABLE
#define UP_BLOCK UP_WIDTH
#define UP_SPECTRA 1
#define UP_INEXACT 1
#define UP_PLACE ${place}
#define UP_BIN_COUNT 1024
#define UP_ROW_OF(index) uplift_row(cube, index)
#define UP_ROW(index) (cube->numbers + (index) * cube->stride)
${definitions}
${fields}
#define UP_WARPED cube->is_warped
#define UP_WARP_0 cube->warp[0]
#define UP_WARP_1 cube->warp[1]
#define UP_WARP_2 cube->warp[2]
#define UP_WARP_3 cube->warp[3]
#define UP_WARP_4 cube->warp[4]
#define UP_WARP_5 cube->warp[5]
UP_EXPANDED float up_number(const uplift_cube *cube, int index)
{
    return cube->numbers[index];
}

