/* Textures of the format RGBA32F, filter NEAREST, in files of the format KTX 2. The first ${texels} are 3-D, with a lattice
   point per texel: x is blue, y green, z red. Together their channels are the numbers of a point, ${NAME}_COUNT of a
   spectrum and then the position of the list of the entries whose boxes touch the cell above. The last is 2-D: entries,
   axes, lists and boxes. */
uniform highp sampler3D ${name}_points_${t}; /* ${stem}-${t}.ktx2 */
uniform highp sampler2D ${name}_entries; /* ${stem}-entries.ktx2 */

ivec3 ${name}_point(int index)
{
    return ivec3(index % ${NAME}_DIM, index / ${NAME}_DIM % ${NAME}_DIM, index / (${NAME}_DIM * ${NAME}_DIM));
}

float ${name}_number(int index)
{
    int texel = (index - ${NAME}_LATTICE * ${NAME}_STRIDE) / 4;
    return texelFetch(${name}_entries, ivec2(texel % ${columns}, texel / ${columns}), 0)[index % 4];
}

float ${name}_tag(int index)
{
    return texelFetch(${name}_points_${tag_texture}, ${name}_point(index), 0)[${tag_channel}];
}

void ${name}_load_row(int index, inout float row[${NAME}_STRIDE])
{
    ivec3 place = ${name}_point(index);
    vec4 texel;
    texel = texelFetch(${name}_points_${t}, place, 0); for (int c = 0; c < 4; ++c) row[4 * ${t} + c] = texel[c];
}
