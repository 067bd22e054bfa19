${constants}

${table}
UP_FUNCTION float up_number(int index)
{
    return up_table[index];
}
