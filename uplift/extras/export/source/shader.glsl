#define UP_WIDTH ${width}
#define UP_TEXEL UP_VEC4
#define UP_FUNCTION
#define UP_EXPANDED
#define UP_SELDOM
#define UP_VECTORISE
#define UP_READS
#define UP_TABLE
#define UP_IN in
#define UP_OUT inout
#define UP_ARRAY(name, size) float name[size]; for (int fill = 0; fill < size; ++fill) name[fill] = 0.0f
#define UP_INTS(name, size) int name[size]; for (int fill = 0; fill < size; ++fill) name[fill] = 0
#define UP_BITS(name, x) uint name = UP_BITS_OF(x)
#define UP_BOOL bool
#define UP_INT(x) int(x)
#define UP_REAL(x) float(x)
#define UP_ABS abs
#define UP_SQRT sqrt
#define UP_TANH tanh
#define UP_COPYSIGN(size, sign) ((sign) > 0.0f ? (size) : -(size))
#define UP_FINE float
#define UP_FINES UP_ARRAY
#define UP_EXACT(x) (x)
#define UP_TURN(x) up_deviation(1.0f, x)
#define UP_SQUARE_ROOT sqrt
#define UP_TINY 1e-7f
#define UP_TOLERANCE 1e-6f
#define UP_STEPS 24
${constants}

float up_number(int index)
{
    return up_texel(index / 4)[index % 4];
}
