namespace luisa::render {
extern const float ${name}ToSpectrumTable_Data[3][${res}][${res}][${res}][4] = {
${data}
};
}
