/* Textures of the format R32G32B32A32_FLOAT, in files of the format DDS. The first ${texels} are 3-D, with a lattice point
   per texel: x is blue, y green, z red. Together their channels are the numbers of a point, ${NAME}_COUNT of a spectrum and
   then the position of the list of the entries whose boxes touch the cell above. The last is 2-D: entries, axes, lists
   and boxes. */
Texture3D<float4> ${name}_points_${t} : register(t${t}); /* ${stem}-${t}.dds */
Texture2D<float4> ${name}_entries : register(t${texels}); /* ${stem}-entries.dds */

int4 ${name}_point(int index)
{
    return int4(index % ${NAME}_DIM, index / ${NAME}_DIM % ${NAME}_DIM, index / (${NAME}_DIM * ${NAME}_DIM), 0);
}

float ${name}_number(int index)
{
    int texel = (index - ${NAME}_LATTICE * ${NAME}_STRIDE) / 4;
    return ${name}_entries.Load(int3(texel % ${columns}, texel / ${columns}, 0))[index % 4];
}

float ${name}_tag(int index)
{
    return ${name}_points_${tag_texture}.Load(${name}_point(index))[${tag_channel}];
}

void ${name}_load_row(int index, inout float row[${NAME}_STRIDE])
{
    int4 place = ${name}_point(index);
    float4 texel;
    texel = ${name}_points_${t}.Load(place); for (int c${t} = 0; c${t} < 4; ++c${t}) row[4 * ${t} + c${t}] = texel[c${t}];
}
