static const float up_table[] = {
${numbers}};
