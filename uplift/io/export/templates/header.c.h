static const float ${name}_table[] = {
${table}};
