
#define UP_IN const
#define UP_OUT
#define UP_ARRAY(name, size) float name[size]
#define UP_INTS(name, size) int name[size]
#define UP_BITS(name, x) \
    unsigned name; \
    memcpy(&name, &(x), sizeof name)
#define UP_BOOL int
#define UP_INT(x) UP_CAST(int, x)
#define UP_REAL(x) UP_CAST(float, x)
#define UP_ABS fabsf
#define UP_SQRT sqrtf
#define UP_TANH tanhf
#define UP_COPYSIGN copysignf
/* Moving a colour takes a few steps in double precision. */
#define UP_FINE double
#define UP_FINES(name, size) double name[size]
#define UP_EXACT(x) UP_CAST(double, x)
#define UP_TURN(x) (atan(x) * 0.31830988618379067)
#define UP_SQUARE_ROOT sqrt
#define UP_TINY 1e-18
#define UP_TOLERANCE 1e-7
#define UP_STEPS 100
