/* Rows of multipliers are copied. */
#define UP_BLOCK 1
#if UP_SPECTRA
#define UP_ROOM (4 * UP_STRIDE)
#else
#define UP_ROOM UP_STRIDE
#endif
#define UP_SHAPE(name) float name[UP_ROOM]
#define UP_NUMBERS UP_SHAPE
#define UP_NODE(shape, node) shape, (node) * UP_STRIDE
#define UP_LOAD(shape, node, index) up_load_row(UP_TABLE index, (node) * UP_STRIDE, shape)
#define UP_VALUES(name, index) UP_ARRAY(name, UP_STRIDE); up_load_row(UP_TABLE index, 0, name)
