
/* Use the first functions that can evaluate a cube: others would be slower. */
static void uplift_choose(uplift_cube *cube)
{
    static const struct {
        int count, is_sigmoid, is_warped, is_inexact, is_sparse;
        const uplift_kernel *functions;
    } kernels[] = {${kernels}};
    const uplift_content *content = &cube->content;
    const int is_sparse = uplift_has(content, UPLIFT_SPARSE);
    int k = 0;
    while (kernels[k].count < content->model.count || kernels[k].is_sigmoid != content->model.is_sigmoid
        || kernels[k].is_warped != cube->is_warped || kernels[k].is_inexact < cube->is_inexact
        || kernels[k].is_sparse < is_sparse) k += 1;
    cube->kernel = kernels[k].functions;
    cube->tag = kernels[k].count;
    cube->stride = kernels[k].count / 4 * 4 + 4;
    cube->entry_count = content->model.is_sigmoid ? 3 : UPLIFT_MOST_COUNT;
}

/* Read the file of a cube unless an error came before. Return the cube, or release it and return NULL. */
static uplift_cube *uplift_read(uplift_cube *cube, int result, int *error)
{
    if (result == UPLIFT_OK) result = uplift_read_header(&cube->content);
    if (result == UPLIFT_OK) result = uplift_read_metadata(&cube->content);
    if (result == UPLIFT_OK) result = uplift_check_digest(&cube->content);
    if (result == UPLIFT_OK) result = uplift_find_arrays(&cube->content);
    if (result == UPLIFT_OK) result = uplift_check(cube);
    if (result == UPLIFT_OK) result = uplift_set_range(cube) ? UPLIFT_OK : UPLIFT_INVALID;
    if (result == UPLIFT_OK) uplift_choose(cube);
    if (result == UPLIFT_OK) result = uplift_build(cube);
    if (error) *error = result;
    if (result == UPLIFT_OK) return cube;
    uplift_close(cube);
    return NULL;
}

#ifndef UPLIFT_NO_FILES
uplift_cube *uplift_open(const char *path, int *error)
{
    uplift_cube *cube = UPLIFT_CAST(uplift_cube *, uplift_allocate(1, sizeof *cube));
    int result = cube ? uplift_acquire(path, &cube->content.file) : UPLIFT_NO_MEMORY;
    return uplift_read(cube, result, error);
}
#endif

uplift_cube *uplift_open_memory(const void *bytes, size_t size, int *error)
{
    uplift_cube *cube = UPLIFT_CAST(uplift_cube *, uplift_allocate(1, sizeof *cube));
    if (cube) {
        cube->content.file.bytes = UPLIFT_CAST(const unsigned char *, bytes);
        cube->content.file.size = size;
    }
    return uplift_read(cube, cube ? UPLIFT_OK : UPLIFT_NO_MEMORY, error);
}

void uplift_close(uplift_cube *cube)
{
    if (!cube) return;
#ifndef UPLIFT_NO_FILES
    uplift_release(&cube->content.file);
#endif
    free(cube->content.text);
    free(cube->numbers);
    free(cube->points);
    free(cube->rows);
    free(cube->lines);
    free(cube);
}

const char *uplift_message(int result)
{
    static const char *const messages[] = {
        "no error",
        "the file cannot be opened or read",
        "out of memory",
        "the file is not a cube, or is damaged",
        "the file has a format that this reader does not know",
        "the file has a part that this reader does not know",
        "the file is damaged: its content does not match its digest",
        "the file has values that no cube has",
        "the cube has more numbers than this reader can address",
        "the cube needs a sensor of evenly spaced wavelengths, at most ${samples}",
        "the colour is not in the scene of the cube",
        "the cube has no standard errors",
        "coefficients are not moved to exact colours here"};
    int is_known = result >= 0 && result < UPLIFT_CAST(int, sizeof messages / sizeof *messages);
    return is_known ? messages[result] : "unknown result";
}

/* The eight nodes and the entry of a colour, and their weights. */
typedef struct {
    int rows[8], entry;
    float weights[8], lattice_weight;
    int position[3];
} uplift_place;

/* Find the nodes of a colour; 0 if the cube lacks one of them. */
static int uplift_find(const uplift_cube *cube, const float rgb[3], uplift_place *place)
{
    float sides[6];
    int first, is_present = 1;
    place->entry = cube->kernel->place(cube, rgb, &place->lattice_weight, sides, &first);
    place->position[0] = first / cube->dim / cube->dim;
    place->position[1] = first / cube->dim % cube->dim;
    place->position[2] = first % cube->dim;
    for (int corner = 0; corner < 8; ++corner) {
        int step = (corner / 4 * cube->dim + corner / 2 % 2) * cube->dim + corner % 2;
        place->rows[corner] = uplift_row(cube, first + step);
        place->weights[corner] = sides[corner / 4] * sides[2 + corner / 2 % 2] * sides[4 + corner % 2];
        is_present = is_present && place->rows[corner] < cube->present;
    }
    return is_present;
}

int uplift_reflectances(
    const uplift_cube *cube, const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    uplift_place place;
    if (cube->points && !uplift_find(cube, rgb, &place)) {
        for (int k = 0; k < count; ++k) reflectances[k] = 0;
        return UPLIFT_NOT_IN_SCENE;
    }
    cube->kernel->reflectances(cube, rgb, wavelengths, count, reflectances);
    return UPLIFT_OK;
}

int uplift_reflectances_n(
    const uplift_cube *cube, const float *rgb, int n, const float *wavelengths, int count, float *reflectances)
{
    int result = UPLIFT_OK;
    for (int i = 0; i < n; ++i, rgb += 3, reflectances += count) {
        int found = uplift_reflectances(cube, rgb, wavelengths, count, reflectances);
        if (found != UPLIFT_OK) result = found;
    }
    return result;
}

/* Weighted error of nodes, times a factor, and of the entry of a colour; that of a look is expected, as those of nodes. */
static int uplift_expected_error(const uplift_cube *cube, const float rgb[3], double factor, float *error)
{
    uplift_place place;
    double sum = 0;
    *error = 0;
    if (!cube->content.known[UPLIFT_STANDARD_ERROR]) return UPLIFT_NO_ERRORS;
    if (!uplift_find(cube, rgb, &place)) return UPLIFT_NOT_IN_SCENE;
    for (int corner = 0; corner < 8; ++corner)
        sum += UPLIFT_CAST(double, place.weights[corner])
            * uplift_value(cube, UPLIFT_STANDARD_ERROR, place.rows[corner]);
    sum *= factor;
    if (place.entry >= 0) {
        double weight = UPLIFT_CAST(double, place.lattice_weight);
        double entry_error = uplift_value(cube, UPLIFT_ATLAS_ERROR, place.entry);
        if (place.entry >= cube->content.entries - cube->content.looks) entry_error *= factor;
        sum = weight * sum + (1 - weight) * entry_error;
    }
    *error = UPLIFT_CAST(float, sum);
    return UPLIFT_OK;
}

int uplift_standard_error(const uplift_cube *cube, const float rgb[3], float *error)
{
    return uplift_expected_error(cube, rgb, 1, error);
}

int uplift_error_bound(const uplift_cube *cube, const float rgb[3], float *error)
{
    return uplift_expected_error(cube, rgb, cube->content.bound_factor, error);
}

int uplift_coefficient_count(const uplift_cube *cube)
{
    return UPLIFT_CAST(int, cube->content.model.count);
}

/* Whether coefficients of a colour would have to be moved: a corner of its cell shares a cell with a node that has not its
   own colour. Absent ones count as if they had. */
static int uplift_is_moved(const uplift_cube *cube, const uplift_place *place)
{
    for (int corner = 0; corner < 8 * cube->is_inexact; ++corner)
        for (int step = 0; step < 27 && place->weights[corner] > 0; ++step) {
            const int red = place->position[0] + corner / 4 + step / 9 - 1;
            const int green = place->position[1] + corner / 2 % 2 + step / 3 % 3 - 1;
            const int blue = place->position[2] + corner % 2 + step % 3 - 1, last = cube->dim - 1;
            int row;
            if (red < 0 || red > last || green < 0 || green > last || blue < 0 || blue > last) continue;
            row = uplift_row(cube, (red * cube->dim + green) * cube->dim + blue);
            if (row < cube->present && uplift_misses(cube, row)) return 1;
        }
    return 0;
}

int uplift_coefficients(const uplift_cube *cube, const float rgb[3], float *coefficients)
{
    const long long count = cube->content.model.count;
    uplift_place place;
    int result = UPLIFT_OK;
    if (!uplift_find(cube, rgb, &place)) result = UPLIFT_NOT_IN_SCENE;
    else if (uplift_is_moved(cube, &place)) result = UPLIFT_NO_COEFFICIENTS;
    for (int k = 0; k < count; ++k) {
        double sum = 0, weight = UPLIFT_CAST(double, place.lattice_weight);
        for (int corner = 0; corner < 8 && result == UPLIFT_OK; ++corner)
            sum += UPLIFT_CAST(double, place.weights[corner])
                * uplift_value(cube, UPLIFT_COEFFICIENTS, place.rows[corner] * count + k);
        if (place.entry >= 0 && result == UPLIFT_OK)
            sum = weight * sum + (1 - weight) * uplift_value(cube, UPLIFT_ATLAS_COEFFICIENTS, place.entry * count + k);
        coefficients[k] = UPLIFT_CAST(float, sum);
    }
    return result;
}

#define UP_POP
#endif
#endif
