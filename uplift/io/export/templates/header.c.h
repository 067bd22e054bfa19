static const float ${name}_table[] = {
${table}};

static inline float ${name}_number(int index)
{
    return ${name}_table[index];
}

static inline float ${name}_tag(int index)
{
    return ${name}_table[index * ${NAME}_STRIDE + ${NAME}_COUNT];
}

static inline void ${name}_load_row(int index, float row[${NAME}_STRIDE])
{
    const float *stored = ${name}_table + index * ${NAME}_STRIDE;
    int k;
    for (k = 0; k < ${NAME}_STRIDE; ++k) row[k] = stored[k];
}
