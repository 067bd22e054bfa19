/* Textures of the format rgba32float, in files of the format KTX 2. The first ${texels} are 3-D, with a lattice point per
   texel: x is blue, y green, z red. Together their channels are the numbers of a point, ${NAME}_COUNT of a spectrum and then
   the position of the list of the entries whose boxes touch the cell above. The last is 2-D: entries, axes, lists and
   boxes. Set their groups and bindings. */
@group(0) @binding(${t}) var ${name}_points_${t}: texture_3d<f32>; /* ${stem}-${t}.ktx2 */
@group(0) @binding(${texels}) var ${name}_entries: texture_2d<f32>; /* ${stem}-entries.ktx2 */

fn ${name}_point(index: i32) -> vec3i {
    return vec3i(index % ${NAME}_DIM, index / ${NAME}_DIM % ${NAME}_DIM, index / (${NAME}_DIM * ${NAME}_DIM));
}

fn ${name}_number(index: i32) -> f32 {
    let texel = (index - ${NAME}_LATTICE * ${NAME}_STRIDE) / 4;
    return textureLoad(${name}_entries, vec2i(texel % ${columns}, texel / ${columns}), 0)[index % 4];
}

fn ${name}_tag(index: i32) -> f32 {
    return textureLoad(${name}_points_${tag_texture}, ${name}_point(index), 0)[${tag_channel}];
}

fn ${name}_load_row(index: i32, row: ptr<function, array<f32, ${NAME}_STRIDE>>) {
    let place = ${name}_point(index);
    var texel: vec4f;
    texel = textureLoad(${name}_points_${t}, place, 0); for (var c: i32 = 0; c < 4; c++) { (*row)[4 * ${t} + c] = texel[c]; }
}
