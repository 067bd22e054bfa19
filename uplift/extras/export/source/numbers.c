${constants}

${table}
#if UP_SPECTRA
typedef const float *up_row;
#define UP_SHAPE(name) up_row name[4]
#define UP_NODE(shape, node) shape[node], 0
#define UP_LOAD(shape, node, row) shape[node] = up_table + row
#else
#define UP_SHAPE(name) float name[UP_COUNT]
#endif
#define UP_NUMBERS(name) float *name
#define UP_ROW(name, index) const float *name = up_table + (index) * UP_STRIDE
UP_FUNCTION float up_number(int index)
{
    return up_table[index];
}
