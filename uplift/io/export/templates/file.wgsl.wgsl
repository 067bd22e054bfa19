/* ${stem}.bin: ${rows} rows of ${columns} vec4f (little-endian). Load it as a storage buffer. Set its group and binding. */
@group(0) @binding(0) var<storage, read> ${name}_table: array<vec4f>;

fn ${name}_number(index: i32) -> f32 {
    return ${name}_table[index / 4][index % 4];
}

fn ${name}_tag(index: i32) -> f32 {
    return ${name}_number(index * ${NAME}_STRIDE + ${NAME}_COUNT);
}

fn ${name}_load_row(index: i32, row: ptr<function, array<f32, ${NAME}_STRIDE>>) {
    for (var t: i32 = 0; t < ${texels}; t++) {
        let texel = ${name}_table[index * ${texels} + t];
        for (var c: i32 = 0; c < 4; c++) { (*row)[4 * t + c] = texel[c]; }
    }
}
