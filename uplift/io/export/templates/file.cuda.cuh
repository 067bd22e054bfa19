${NAME}_FUNCTION float ${name}_number(const float *table, int index)
{
    return table[index];
}

${NAME}_FUNCTION float ${name}_tag(const float *table, int index)
{
    return table[index * ${NAME}_STRIDE + ${NAME}_COUNT];
}

${NAME}_FUNCTION void ${name}_load_row(const float *table, int index, float row[${NAME}_STRIDE])
{
    for (int k = 0; k < ${NAME}_COUNT; ++k) row[k] = table[index * ${NAME}_STRIDE + k];
}
