/* Loops over wavelengths and lanes are vectorised, not unrolled. */
#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wpass-failed" /* without optimisation, or for size, loops stay as they are */
#define UP_EXPANDED static inline __attribute__((always_inline))
#define UP_VECTORISE _Pragma("clang loop vectorize(enable) interleave_count(1)")
#elif defined(__GNUC__)
#define UP_EXPANDED static inline __attribute__((always_inline))
#define UP_VECTORISE _Pragma("GCC ivdep") _Pragma("GCC unroll 1")
#else
#define UP_EXPANDED static inline
#define UP_VECTORISE
#endif
