
/* Memory of an element size, zeroed; at least one byte. */
static void *uplift_allocate(size_t count, size_t size)
{
    return calloc(count ? count : 1, size);
}

/* Find the arrays of the nodes and entries, and check what a lookup relies on. */
static int uplift_check(uplift_cube *cube)
{
    const uplift_content *content = &cube->content;
    const double most = 1e30;
    const unsigned long long dim = content->dim, count = content->count, entry_count = content->entry_count;
    const unsigned long long entries = UPLIFT_CAST(unsigned long long, content->entries);
    const uplift_array *axis;
    unsigned long long nodes = dim * dim * dim;
    if (dim < 2 || count < 3 || entry_count < count) return UPLIFT_INVALID;
    if (content->is_sigmoid ? entry_count != 3 : entry_count > UPLIFT_MOST_COUNT) return UPLIFT_INVALID;
    if (dim > UPLIFT_MOST_DIM || entries > 1 << 24) return UPLIFT_TOO_LARGE;
    if (!(content->start > 0 || content->is_sigmoid) || !(content->start < content->end) || !(content->end < 1e30)) return UPLIFT_INVALID;
    if (!(content->threshold >= 1e-12 && content->threshold <= 0.1) || content->looks > content->entries) return UPLIFT_INVALID;
    if (!(fabs(content->bound_factor) <= most)) return UPLIFT_INVALID;
    axis = uplift_find_array(content, "nodes", UPLIFT_F64, UPLIFT_F64, dim, 0, 0, 1);
    if (!axis || uplift_number_at(axis, 0) != 0 || uplift_number_at(axis, axis->length - 1) != 1) return UPLIFT_INVALID;
    for (size_t k = 1; k < axis->length; ++k)
        if (UPLIFT_CAST(float, uplift_number_at(axis, k)) <= UPLIFT_CAST(float, uplift_number_at(axis, k - 1))) return UPLIFT_INVALID;
    if (uplift_has(content, UPLIFT_SPARSE)) {
        const uplift_array *points = NULL;
        for (int k = 0; k < content->array_count; ++k)
            if (uplift_is(content->arrays[k].name, "points")) points = content->arrays + k;
        if (!points || points->type != UPLIFT_U32 || points->rank != 1 || points->length == 0 || points->length >= nodes) return UPLIFT_INVALID;
        for (size_t k = 0; k < points->length; ++k)
            if (uplift_number_at(points, k) >= UPLIFT_CAST(double, nodes)
                || (k > 0 && uplift_number_at(points, k) <= uplift_number_at(points, k - 1))) return UPLIFT_INVALID;
        nodes = points->length;
    }
    cube->coefficients = uplift_find_array(content, "coefficients", UPLIFT_F32, UPLIFT_F64, nodes, count, -most, most);
    cube->distance = uplift_find_array(content, "distance", UPLIFT_F32, UPLIFT_F32, nodes, 0, 0, most);
    cube->atlas_coefficients = uplift_find_array(content, "atlas.coefficients", UPLIFT_F64, UPLIFT_F64, entries, count, -most, most);
    cube->atlas_error = uplift_find_array(content, "atlas.error", UPLIFT_F64, UPLIFT_F64, entries, 0, 0, most);
    if (!cube->coefficients || !cube->distance || !cube->atlas_coefficients || !cube->atlas_error) return UPLIFT_INVALID;
    if (!uplift_find_array(content, "atlas.rgb", UPLIFT_F64, UPLIFT_F64, entries, 3, 0, 1)) return UPLIFT_INVALID;
    if (!uplift_find_array(content, "atlas.reach", UPLIFT_F64, UPLIFT_F64, entries, 0, 0, 1)) return UPLIFT_INVALID;
    if (uplift_has(content, UPLIFT_ERRORS)) {
        cube->standard_error = uplift_find_array(content, "standard_error", UPLIFT_F32, UPLIFT_F32, nodes, 0, 0, most);
        if (!cube->standard_error) return UPLIFT_INVALID;
    }
    for (size_t k = 0; k < nodes; ++k)
        if (uplift_number_at(cube->distance, k) > content->threshold) cube->is_inexact = 1;
    cube->dim = UPLIFT_CAST(int, dim);
    cube->present = UPLIFT_CAST(int, nodes);
    return UPLIFT_OK;
}

/* Number of the node in a row of the file. */
static int uplift_node_number(const uplift_array *points, int row)
{
    return points ? UPLIFT_CAST(int, uplift_number_at(points, UPLIFT_CAST(size_t, row))) : row;
}

/* Give rows to the nodes of a scene, and after them to absent nodes whose cells touch boxes. */
static int uplift_index_nodes(uplift_cube *cube, const uplift_array *points, const uplift_touch *touches, size_t touch_count)
{
    size_t room = UPLIFT_CAST(size_t, cube->present) + touch_count, lines = UPLIFT_CAST(size_t, cube->dim) * UPLIFT_CAST(size_t, cube->dim);
    int next = 0, absent = cube->present;
    size_t touch = 0;
    cube->points = UPLIFT_CAST(int *, uplift_allocate(room, sizeof *cube->points));
    cube->rows = UPLIFT_CAST(int *, uplift_allocate(room, sizeof *cube->rows));
    cube->lines = UPLIFT_CAST(int *, uplift_allocate(lines + 1, sizeof *cube->lines));
    if (!cube->points || !cube->rows || !cube->lines) return UPLIFT_NO_MEMORY;
    while (next < cube->present || touch < touch_count) {
        int count = cube->point_count++;
        int node = next < cube->present ? uplift_node_number(points, next) : touches[touch].cell;
        if (touch < touch_count && touches[touch].cell < node) node = touches[touch].cell;
        cube->points[count] = node;
        if (next < cube->present && uplift_node_number(points, next) == node) cube->rows[count] = next++;
        else cube->rows[count] = absent++;
        while (touch < touch_count && touches[touch].cell == node) touch += 1;
        cube->lines[node / cube->dim + 1] = count + 1;
    }
    for (size_t line = 1; line <= lines; ++line)
        if (cube->lines[line] < cube->lines[line - 1]) cube->lines[line] = cube->lines[line - 1];
    cube->absent_row = absent;
    return UPLIFT_OK;
}

/* Write the multipliers of the nodes: less steep ones where colours are not exact (docs/cube-file.md, Exact colours). */
static int uplift_fill_rows(uplift_cube *cube)
{
    const int count = UPLIFT_CAST(int, cube->content.count);
    double p[UPLIFT_MOST_COUNT];
    for (int row = 0; row < cube->present; ++row) {
        if (!uplift_multipliers(cube, cube->coefficients, UPLIFT_CAST(size_t, row), count, p)) return UPLIFT_INVALID;
        if (uplift_number_at(cube->distance, UPLIFT_CAST(size_t, row)) > cube->content.threshold) {
            double size = 0;
            for (int k = 0; k < count; ++k) size += fabs(p[k]);
            for (int k = 0; k < count && size > 500; ++k) p[k] *= 500 / size;
        }
        if (!uplift_store(cube, p, count, cube->numbers + UPLIFT_CAST(size_t, row) * UPLIFT_CAST(size_t, cube->stride))) return UPLIFT_INVALID;
    }
    return UPLIFT_OK;
}

/* Write the lists of entries whose boxes touch a cell, and the tags of cells: where their list is, negative if answers in
   the cell are moved. */
static void uplift_fill_lists(uplift_cube *cube, const uplift_array *points, const uplift_touch *touches, size_t touch_count)
{
    float *lists = cube->numbers + cube->lists, *tags = cube->numbers + cube->tag;
    int length = 1 + cube->is_inexact;
    for (size_t k = 0; k < touch_count;) {
        size_t end = k;
        int at = length++;
        tags[UPLIFT_CAST(size_t, uplift_row(cube, touches[k].cell)) * UPLIFT_CAST(size_t, cube->stride)] = UPLIFT_CAST(float, at);
        for (; end < touch_count && touches[end].cell == touches[k].cell; ++end) lists[length++] = UPLIFT_CAST(float, touches[end].entry);
        lists[at] = UPLIFT_CAST(float, end - k);
        k = end;
    }
    for (int row = 0; row < cube->present; ++row) {
        int node, position[3];
        if (!(uplift_number_at(cube->distance, UPLIFT_CAST(size_t, row)) > cube->content.threshold)) continue;
        node = uplift_node_number(points, row);
        position[0] = node / cube->dim / cube->dim;
        position[1] = node / cube->dim % cube->dim;
        position[2] = node % cube->dim;
        for (int corner = 0; corner < 8; ++corner) {
            int low[3] = {position[0] - corner / 4, position[1] - corner / 2 % 2, position[2] - corner % 2}, is_cell = 1, at;
            for (int k = 0; k < 3; ++k) is_cell = is_cell && low[k] >= 0 && low[k] < cube->dim - 1;
            if (!is_cell) continue;
            at = uplift_row(cube, (low[0] * cube->dim + low[1]) * cube->dim + low[2]);
            if (!cube->points || at != cube->absent_row) {
                float *tag = tags + UPLIFT_CAST(size_t, at) * UPLIFT_CAST(size_t, cube->stride);
                *tag = *tag == 0 ? -1.0f : -UPLIFT_CAST(float, fabs(UPLIFT_CAST(double, *tag)));
            }
        }
    }
}

/* Write the axis, and the last node up to the start of each of 1024 bins of it. */
static void uplift_fill_axis(uplift_cube *cube)
{
    const uplift_array *axis = uplift_find_array(&cube->content, "nodes", UPLIFT_F64, UPLIFT_F64, cube->content.dim, 0, 0, 1);
    float *nodes = cube->numbers + cube->nodes, *bins = cube->numbers + cube->bins;
    int low = 0;
    for (int k = 0; k < cube->dim; ++k) nodes[k] = UPLIFT_CAST(float, uplift_number_at(axis, UPLIFT_CAST(size_t, k)));
    for (int bin = 0; bin <= 1024; ++bin) {
        while (low < cube->dim - 2 && nodes[low + 1] <= UPLIFT_CAST(float, bin) / 1024) low += 1;
        bins[bin] = UPLIFT_CAST(float, low);
    }
}

/* Write how answers are moved to their colours. */
static int uplift_fill_moves(uplift_cube *cube, const uplift_sensor *sensor)
{
    double scale[3][3];
    float *numbers = cube->numbers;
    if (!uplift_scale_colours(sensor, scale)) return UPLIFT_INVALID;
    for (int k = 0; k < sensor->samples; ++k)
        for (int row = 0; row < 3; ++row) {
            double weight = 0, shape = 0;
            for (int column = 0; column < 3; ++column) {
                weight += scale[row][column] * sensor->weights[column][k];
                shape += scale[row][column] * sensor->shapes[column][k];
            }
            numbers[cube->pull + 6 * k + row] = UPLIFT_CAST(float, weight);
            numbers[cube->pull + 6 * k + 3 + row] = UPLIFT_CAST(float, shape);
        }
    for (int k = 0; k < 9; ++k) numbers[cube->scales + k] = UPLIFT_CAST(float, scale[k / 3][k % 3]);
    for (int k = 0; k < 3; ++k) numbers[cube->luminance + k] = UPLIFT_CAST(float, sensor->luminance[k]);
    uplift_list_facets(sensor, numbers + cube->facets);
    cube->first = UPLIFT_CAST(float, sensor->first);
    cube->step = UPLIFT_CAST(float, sensor->step);
    cube->margin = UPLIFT_CAST(float, cube->content.threshold / 2);
    return UPLIFT_OK;
}

/* Set the range of wavelengths; 0 for a warp that is not known. */
static int uplift_set_range(uplift_cube *cube)
{
    static const struct {
        const char *name;
        double terms[6];
    } warps[] = {${warps}};
    const uplift_content *content = &cube->content;
    double low = content->start, high = content->end;
    cube->start = UPLIFT_CAST(float, low);
    cube->end = UPLIFT_CAST(float, high);
    if (content->is_sigmoid) return 1;
    for (size_t k = 0; k < sizeof warps / sizeof *warps; ++k) {
        const double *terms = warps[k].terms;
        if (!uplift_is(content->warp, warps[k].name)) continue;
        cube->is_warped = terms[0] != 0;
        for (int term = 0; term < 6; ++term) cube->warp[term] = UPLIFT_CAST(float, terms[term]);
        if (cube->is_warped) {
            low = terms[0] * tanh(terms[1] * (low - terms[2])) + terms[3] * tanh(terms[4] * (low - terms[5]));
            high = terms[0] * tanh(terms[1] * (high - terms[2])) + terms[3] * tanh(terms[4] * (high - terms[5]));
        }
        cube->low = UPLIFT_CAST(float, low);
        cube->scale = UPLIFT_CAST(float, 1 / (high - low));
        return high > low && fabs(1 / (high - low)) < 1e30;
    }
    return 0;
}

/* Make the table of a cube whose content is checked. */
static int uplift_make_table(
    uplift_cube *cube, const uplift_sensor *sensor, const uplift_touch *touches, size_t touch_count, const float *boxes)
{
    const uplift_content *content = &cube->content;
    const unsigned long long entries = UPLIFT_CAST(unsigned long long, content->entries);
    const uplift_array *points = uplift_has(content, UPLIFT_SPARSE)
        ? uplift_find_array(content, "points", UPLIFT_U32, UPLIFT_U32, UPLIFT_CAST(unsigned long long, cube->present), 0, 0, 1e10) : NULL;
    const uplift_array *spectra = cube->atlas_coefficients;
    unsigned long long sizes[10] = {0}, total = 0;
    int *const sections[10] = {
        NULL, &cube->entries, &cube->nodes, &cube->bins, &cube->lists, &cube->boxes, &cube->pull, &cube->scales,
        &cube->luminance, &cube->facets};
    const int count = UPLIFT_CAST(int, content->entry_count);
    double p[UPLIFT_MOST_COUNT];
    int result = points ? uplift_index_nodes(cube, points, touches, touch_count) : UPLIFT_OK;
    if (result != UPLIFT_OK) return result;
    if (content->entry_count != content->count)
        spectra = uplift_find_array(content, "atlas.entry_coefficients", UPLIFT_F64, UPLIFT_F64, entries, content->entry_count, -1e30, 1e30);
    if (!spectra) return UPLIFT_INVALID;
    sizes[0] = UPLIFT_CAST(unsigned, points ? cube->absent_row + 1 : cube->present) * UPLIFT_CAST(unsigned long long, cube->stride);
    sizes[1] = entries * UPLIFT_CAST(unsigned, cube->entry_count);
    sizes[2] = content->dim;
    sizes[3] = 1025;
    sizes[4] = 2 + 2 * touch_count;
    sizes[5] = 12 * entries;
    if (sensor) {
        cube->samples = sensor->samples;
        cube->facet_count = uplift_list_facets(sensor, NULL);
        sizes[6] = 6 * UPLIFT_CAST(unsigned long long, cube->samples);
        sizes[7] = 9;
        sizes[8] = 3;
        sizes[9] = 4 * UPLIFT_CAST(unsigned long long, cube->facet_count);
    }
    if (sizes[4] > 1 << 24) return UPLIFT_TOO_LARGE; /* positions in lists are floats */
    for (int k = 0; k < 10; ++k) {
        if (sections[k]) *sections[k] = UPLIFT_CAST(int, total);
        total += sizes[k];
        if (total > 0x7FFFFFF0) return UPLIFT_TOO_LARGE; /* and in the table whole numbers */
    }
    cube->numbers = UPLIFT_CAST(float *, uplift_allocate(UPLIFT_CAST(size_t, total), sizeof(float)));
    if (!cube->numbers) return UPLIFT_NO_MEMORY;
    memcpy(cube->numbers + cube->boxes, boxes, UPLIFT_CAST(size_t, sizes[5]) * sizeof *boxes);
    uplift_fill_axis(cube);
    uplift_fill_lists(cube, points, touches, touch_count);
    for (int entry = 0; entry < content->entries; ++entry) {
        float *row = cube->numbers + cube->entries + entry * cube->entry_count;
        if (!uplift_multipliers(cube, spectra, UPLIFT_CAST(size_t, entry), count, p)) return UPLIFT_INVALID;
        if (!uplift_store(cube, p, count, row)) return UPLIFT_INVALID;
    }
    result = sensor ? uplift_fill_moves(cube, sensor) : UPLIFT_OK;
    return result == UPLIFT_OK ? uplift_fill_rows(cube) : result;
}

/* Make the table, with memory that is needed until it is made. */
static int uplift_build(uplift_cube *cube)
{
    uplift_touch *touches = NULL;
    uplift_sensor *sensor = NULL;
    float *boxes;
    size_t touch_count = 0;
    int result = UPLIFT_OK;
    boxes = UPLIFT_CAST(float *, uplift_allocate(12 * UPLIFT_CAST(size_t, cube->content.entries), sizeof *boxes));
    if (boxes) {
        touch_count = uplift_list_touches(cube, NULL, boxes);
        touches = UPLIFT_CAST(uplift_touch *, uplift_allocate(touch_count, sizeof *touches));
    }
    if (cube->is_inexact) sensor = UPLIFT_CAST(uplift_sensor *, uplift_allocate(1, sizeof *sensor));
    if (!boxes || !touches || (cube->is_inexact && !sensor)) result = UPLIFT_NO_MEMORY;
    if (result == UPLIFT_OK && sensor) result = uplift_read_sensor(&cube->content, sensor);
    if (result == UPLIFT_OK) {
        uplift_list_touches(cube, touches, boxes);
        result = uplift_make_table(cube, sensor, touches, touch_count, boxes);
    }
    free(sensor);
    free(touches);
    free(boxes);
    return result;
}
