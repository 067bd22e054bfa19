
/* Memory of numbers, zeroed; at least one byte. */
static void *uplift_allocate(long long count, size_t size)
{
    return calloc(count > 0 ? UPLIFT_CAST(size_t, count) : 1, size);
}

/* Check the numbers of nodes in a cube of a scene. */
static int uplift_check_points(const uplift_cube *cube)
{
    const double nodes = UPLIFT_CAST(double, cube->dim) * cube->dim * cube->dim;
    if (cube->present == 0 || cube->present >= nodes) return 0;
    for (int k = 0; k < cube->present; ++k) {
        double point = uplift_value(cube, UPLIFT_POINTS, k);
        if (point >= nodes || (k > 0 && point <= uplift_value(cube, UPLIFT_POINTS, k - 1))) return 0;
    }
    return 1;
}

/* Check what a lookup relies on beyond the ranges of numbers. */
static int uplift_check(uplift_cube *cube)
{
    const uplift_content *content = &cube->content;
    const uplift_model *model = &content->model;
    const long long entry_count = content->entry_model.count;
    if (content->dim < 2 || model->count < 3 || entry_count < model->count) return UPLIFT_INVALID;
    if (model->is_sigmoid ? entry_count != 3 : entry_count > UPLIFT_MOST_COUNT) return UPLIFT_INVALID;
    if (!(model->start > 0 || model->is_sigmoid) || !(model->start < model->end) || !(model->end < 1e30)) return UPLIFT_INVALID;
    if (!(content->threshold >= 1e-12 && content->threshold <= 0.1) || content->looks > content->entries) return UPLIFT_INVALID;
    if (!(fabs(content->bound_factor) <= 1e30)) return UPLIFT_INVALID;
    cube->dim = UPLIFT_CAST(int, content->dim);
    cube->present = UPLIFT_CAST(int, content->known[UPLIFT_DISTANCE]->length);
    if (uplift_value(cube, UPLIFT_NODES, 0) != 0 || uplift_value(cube, UPLIFT_NODES, cube->dim - 1) != 1) return UPLIFT_INVALID;
    for (int k = 1; k < cube->dim; ++k) {
        float low = UPLIFT_CAST(float, uplift_value(cube, UPLIFT_NODES, k - 1));
        if (UPLIFT_CAST(float, uplift_value(cube, UPLIFT_NODES, k)) <= low) return UPLIFT_INVALID;
    }
    if (content->known[UPLIFT_POINTS] && !uplift_check_points(cube)) return UPLIFT_INVALID;
    for (int row = 0; row < cube->present; ++row)
        if (uplift_misses(cube, row)) cube->is_inexact = 1;
    return UPLIFT_OK;
}

/* Number of the node in a row of the file. */
static int uplift_node_number(const uplift_cube *cube, int row)
{
    return cube->content.known[UPLIFT_POINTS] ? UPLIFT_CAST(int, uplift_value(cube, UPLIFT_POINTS, row)) : row;
}

/* Give rows to the nodes of a scene, and after them to absent nodes whose cells touch boxes. */
static int uplift_index_nodes(uplift_cube *cube, const uplift_touch *touches, int touch_count)
{
    const int room = cube->present + touch_count, lines = cube->dim * cube->dim;
    int next = 0, touch = 0, absent = cube->present;
    cube->points = UPLIFT_CAST(int *, uplift_allocate(room, sizeof *cube->points));
    cube->rows = UPLIFT_CAST(int *, uplift_allocate(room, sizeof *cube->rows));
    cube->lines = UPLIFT_CAST(int *, uplift_allocate(lines + 1, sizeof *cube->lines));
    if (!cube->points || !cube->rows || !cube->lines) return UPLIFT_NO_MEMORY;
    while (next < cube->present || touch < touch_count) {
        int count = cube->point_count++;
        int node = next < cube->present ? uplift_node_number(cube, next) : touches[touch].cell;
        if (touch < touch_count && touches[touch].cell < node) node = touches[touch].cell;
        cube->points[count] = node;
        if (next < cube->present && uplift_node_number(cube, next) == node) cube->rows[count] = next++;
        else cube->rows[count] = absent++;
        while (touch < touch_count && touches[touch].cell == node) touch += 1;
        cube->lines[node / cube->dim + 1] = count + 1;
    }
    for (int line = 1; line <= lines; ++line)
        if (cube->lines[line] < cube->lines[line - 1]) cube->lines[line] = cube->lines[line - 1];
    cube->absent_row = absent;
    return UPLIFT_OK;
}

/* Write the multipliers of the nodes: less steep ones where colours are not exact (docs/cube-file.md, Exact colours). */
static int uplift_fill_rows(uplift_cube *cube)
{
    const uplift_array *nodes = cube->content.known[UPLIFT_COEFFICIENTS];
    for (int row = 0; row < cube->present; ++row) {
        double most = uplift_misses(cube, row) ? 500 : 1e300;
        if (!uplift_store(cube, nodes, row, most, cube->numbers + row * cube->stride)) return UPLIFT_INVALID;
    }
    return UPLIFT_OK;
}

static int uplift_fill_entries(uplift_cube *cube)
{
    const uplift_array *entries = cube->content.known[UPLIFT_ATLAS_ENTRY_COEFFICIENTS];
    if (!entries) entries = cube->content.known[UPLIFT_ATLAS_COEFFICIENTS];
    for (int entry = 0; entry < cube->content.entries; ++entry) {
        int low[3], high[3];
        uplift_make_box(cube, entry, cube->numbers + cube->boxes + 12 * entry, low, high);
        if (!uplift_store(cube, entries, entry, 1e300, cube->numbers + cube->entries + entry * cube->entry_count))
            return UPLIFT_INVALID;
    }
    return UPLIFT_OK;
}

/* Mark the cells around a node, whose answers are moved, by negative tags. */
static void uplift_mark_cells(uplift_cube *cube, int node)
{
    const int position[3] = {node / cube->dim / cube->dim, node / cube->dim % cube->dim, node % cube->dim};
    for (int corner = 0; corner < 8; ++corner) {
        int low[3] = {position[0] - corner / 4, position[1] - corner / 2 % 2, position[2] - corner % 2}, is_cell = 1, row;
        for (int k = 0; k < 3; ++k) is_cell = is_cell && low[k] >= 0 && low[k] < cube->dim - 1;
        if (!is_cell) continue;
        row = uplift_row(cube, (low[0] * cube->dim + low[1]) * cube->dim + low[2]);
        if (!cube->points || row != cube->absent_row) {
            float *tag = cube->numbers + cube->tag + row * cube->stride;
            *tag = *tag == 0 ? -1.0f : -fabsf(*tag);
        }
    }
}

/* Write the lists of entries whose boxes touch a cell, and the tags of cells: where their list is, negative if answers in
   the cell are moved. */
static void uplift_fill_lists(uplift_cube *cube, const uplift_touch *touches, int touch_count)
{
    float *lists = cube->numbers + cube->lists;
    int length = 1 + cube->is_inexact;
    for (int k = 0; k < touch_count;) {
        int end = k, at = length++;
        cube->numbers[cube->tag + uplift_row(cube, touches[k].cell) * cube->stride] = UPLIFT_CAST(float, at);
        for (; end < touch_count && touches[end].cell == touches[k].cell; ++end)
            lists[length++] = UPLIFT_CAST(float, touches[end].entry);
        lists[at] = UPLIFT_CAST(float, end - k);
        k = end;
    }
    for (int row = 0; row < cube->present; ++row)
        if (uplift_misses(cube, row)) uplift_mark_cells(cube, uplift_node_number(cube, row));
}

/* Write the cells of an axis: the nodes below and above, 2 above the last, and the reciprocal of the step, rounded up; and
   the last cell up to the start of each of 1024 bins. */
static void uplift_fill_axis(uplift_cube *cube)
{
    float *cells = cube->numbers + cube->cells, *bins = cube->numbers + cube->bins;
    int low = 0;
    for (int k = 0; k < cube->dim - 1; ++k) {
        const float below = UPLIFT_CAST(float, uplift_value(cube, UPLIFT_NODES, k));
        const float above = UPLIFT_CAST(float, uplift_value(cube, UPLIFT_NODES, k + 1)), step = above - below;
        cells[4 * k] = below;
        cells[4 * k + 1] = k < cube->dim - 2 ? above : 2;
        cells[4 * k + 2] = 1 / step;
        if (step * cells[4 * k + 2] < 1) cells[4 * k + 2] *= 1.00000012f;
    }
    for (int bin = 0; bin <= 1024; ++bin) {
        while (cells[4 * low + 1] <= UPLIFT_CAST(float, bin) / 1024) low += 1;
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
    cube->samples = sensor->samples;
    cube->first = UPLIFT_CAST(float, sensor->first);
    cube->step = UPLIFT_CAST(float, sensor->step);
    cube->margin = UPLIFT_CAST(float, cube->content.threshold / 2);
    return UPLIFT_OK;
}

static double uplift_warped(const double terms[6], double x)
{
    return terms[0] * tanh(terms[1] * (x - terms[2])) + terms[3] * tanh(terms[4] * (x - terms[5]));
}

/* Set the range of wavelengths; 0 for a warp that is not known. */
static int uplift_set_range(uplift_cube *cube)
{
    static const struct {
        const char *name;
        double terms[6];
    } warps[] = {${warps}};
    const uplift_model *model = &cube->content.model;
    double low = model->start, high = model->end;
    cube->start = UPLIFT_CAST(float, low);
    cube->end = UPLIFT_CAST(float, high);
    if (model->is_sigmoid) return 1;
    for (size_t k = 0; k < sizeof warps / sizeof *warps; ++k) {
        const double *terms = warps[k].terms;
        if (!uplift_is(model->warp, warps[k].name)) continue;
        cube->is_warped = terms[0] != 0;
        for (int term = 0; term < 6; ++term) cube->warp[term] = UPLIFT_CAST(float, terms[term]);
        low = cube->is_warped ? uplift_warped(terms, low) : low;
        high = cube->is_warped ? uplift_warped(terms, high) : high;
        cube->low = UPLIFT_CAST(float, low);
        cube->scale = UPLIFT_CAST(float, 1 / (high - low));
        return high > low && fabs(1 / (high - low)) < 1e30;
    }
    return 0;
}

/* Give the next section of the table its position, and return where it ends. */
static long long uplift_add_section(int *position, long long start, long long size)
{
    *position = UPLIFT_CAST(int, start);
    return start + size;
}

/* Make the table of a cube whose content is checked. */
static int uplift_make_table(uplift_cube *cube, const uplift_sensor *sensor, const uplift_touch *touches, int touch_count)
{
    const int is_sparse = cube->content.known[UPLIFT_POINTS] != NULL, entries = cube->content.entries;
    long long total;
    int result = is_sparse ? uplift_index_nodes(cube, touches, touch_count) : UPLIFT_OK;
    if (result != UPLIFT_OK) return result;
    total = UPLIFT_CAST(long long, cube->stride) * (is_sparse ? cube->absent_row + 1 : cube->present);
    total = uplift_add_section(&cube->entries, total, UPLIFT_CAST(long long, entries) * cube->entry_count);
    total = uplift_add_section(&cube->cells, total, 4 * (cube->dim - 1));
    total = uplift_add_section(&cube->bins, total, 1025);
    total = uplift_add_section(&cube->lists, total, 2 + 2 * touch_count);
    total = uplift_add_section(&cube->boxes, total, 12 * entries);
    if (cube->is_inexact) {
        cube->facet_count = uplift_list_facets(sensor, NULL);
        total = uplift_add_section(&cube->pull, total, 6 * sensor->samples);
        total = uplift_add_section(&cube->scales, total, 9);
        total = uplift_add_section(&cube->luminance, total, 3);
        total = uplift_add_section(&cube->facets, total, 4 * cube->facet_count);
    }
    /* positions in lists are floats, and in the table whole numbers */
    if (touch_count > 1 << 23 || total > 0x7FFFFFF0) return UPLIFT_TOO_LARGE;
    cube->numbers = UPLIFT_CAST(float *, uplift_allocate(total, sizeof(float)));
    if (!cube->numbers) return UPLIFT_NO_MEMORY;
    uplift_fill_axis(cube);
    uplift_fill_lists(cube, touches, touch_count);
    result = uplift_fill_entries(cube);
    if (result == UPLIFT_OK && cube->is_inexact) result = uplift_fill_moves(cube, sensor);
    return result == UPLIFT_OK ? uplift_fill_rows(cube) : result;
}

/* Make the table, with memory that is needed until it is made. */
static int uplift_build(uplift_cube *cube)
{
    uplift_sensor sensor;
    const int touch_count = uplift_list_touches(cube, NULL);
    uplift_touch *touches = UPLIFT_CAST(uplift_touch *, uplift_allocate(touch_count, sizeof *touches));
    int result = UPLIFT_OK;
    if (!touches) return UPLIFT_NO_MEMORY;
    uplift_list_touches(cube, touches);
    memset(&sensor, 0, sizeof sensor);
    if (cube->is_inexact) result = uplift_read_sensor(cube, &sensor);
    if (result == UPLIFT_OK) result = uplift_make_table(cube, &sensor, touches, touch_count);
    free(touches);
    return result;
}
