namespace pbrt {
extern const int ${name}ToSpectrumTable_Res = ${res};
extern const float ${name}ToSpectrumTable_Scale[${res}] = {
${scale}
};
extern const float ${name}ToSpectrumTable_Data[3][${res}][${res}][${res}][3] = {
${data}
};
}
