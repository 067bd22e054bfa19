/* Rows of multipliers stay in the table. */
#define UP_NARROW (UP_WIDTH < 4 ? UP_WIDTH : 4)
#define UP_CHUNK (4 * UP_WIDTH)
#define UP_VALUES(name, index) const float *name = UP_ROW(index)
#define UP_NUMBERS(name) float *name
#if UP_SPECTRA
typedef const float *up_row_type;
#define UP_SHAPE(name) up_row_type name[4]
#define UP_NODE(shape, node) shape[node], 0
#define UP_LOAD(shape, node, index) shape[node] = UP_ROW(index)
#else
#define UP_SHAPE(name) float name[UP_COUNT]
#endif
