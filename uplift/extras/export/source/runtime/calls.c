
/* Use the first lookup that can evaluate a cube: others would be slower. */
static void uplift_choose(uplift_cube *cube)
{
    static const struct {
        int count, is_sigmoid;
        void (*reflectances)(const uplift_cube *, const float *, int, const float *, int, float *);
    } lookups[] = {${choices}};
    const uplift_model *model = &cube->content.model;
    int k = 0;
    while (lookups[k].count < model->count || lookups[k].is_sigmoid != model->is_sigmoid) k += 1;
    cube->reflectances = lookups[k].reflectances;
    cube->tag = lookups[k].count;
    cube->stride = lookups[k].count / 4 * 4 + 4;
    cube->entry_count = model->is_sigmoid ? 3 : UPLIFT_MOST_COUNT;
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

/* The four nodes of a colour, their rows and weights, the weight of the lattice, and the entry. */
typedef struct {
    int nodes[4], rows[4], entry;
    float weights[UP_PLACE];
} uplift_place;

/* Find the nodes of a colour; 0 if the cube lacks one of them. */
static int uplift_find(const uplift_cube *cube, const float rgb[3], uplift_place *place)
{
    int is_present = 1;
    place->entry = up_locate(cube, rgb, place->nodes, place->weights);
    for (int k = 0; k < 4; ++k) {
        place->rows[k] = uplift_row(cube, place->nodes[k]);
        is_present = is_present && place->rows[k] < cube->present;
    }
    return is_present;
}

int uplift_reflectances_n(
    const uplift_cube *cube, const float *rgb, int n, const float *wavelengths, int count, float *reflectances)
{
    int result = UPLIFT_OK;
    if (!cube->points) cube->reflectances(cube, rgb, n, wavelengths, count, reflectances);
    else
        for (int i = 0; i < n; ++i, rgb += 3, reflectances += count) {
            uplift_place place;
            if (uplift_find(cube, rgb, &place)) {
                cube->reflectances(cube, rgb, 1, wavelengths, count, reflectances);
            } else {
                for (int k = 0; k < count; ++k) reflectances[k] = 0;
                result = UPLIFT_NOT_IN_SCENE;
            }
        }
    return result;
}

int uplift_reflectances(
    const uplift_cube *cube, const float rgb[3], const float *wavelengths, int count, float *reflectances)
{
    return uplift_reflectances_n(cube, rgb, 1, wavelengths, count, reflectances);
}

/* Weighted error of nodes, times a factor, and of the entry of a colour; that of a look is expected, as those of nodes. */
static int uplift_expected_error(const uplift_cube *cube, const float rgb[3], double factor, float *error)
{
    uplift_place place;
    double sum = 0;
    *error = 0;
    if (!cube->content.known[UPLIFT_STANDARD_ERROR]) return UPLIFT_NO_ERRORS;
    if (!uplift_find(cube, rgb, &place)) return UPLIFT_NOT_IN_SCENE;
    for (int k = 0; k < 4; ++k)
        sum += UPLIFT_CAST(double, place.weights[k]) * uplift_value(cube, UPLIFT_STANDARD_ERROR, place.rows[k]);
    sum *= factor;
    if (place.entry >= 0) {
        double weight = UPLIFT_CAST(double, place.weights[4]);
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

/* Whether coefficients of a colour would have to be moved: one of its nodes shares a cell with a node that has not its own
   colour. Absent ones count as if they had. */
static int uplift_is_moved(const uplift_cube *cube, const uplift_place *place)
{
    const int dim = cube->dim;
    for (int k = 0; k < 4 * cube->is_inexact; ++k)
        for (int step = 0; step < 27 && place->weights[k] > 0; ++step) {
            const int red = place->nodes[k] / dim / dim + step / 9 - 1;
            const int green = place->nodes[k] / dim % dim + step / 3 % 3 - 1, blue = place->nodes[k] % dim + step % 3 - 1;
            int row;
            if (red < 0 || red >= dim || green < 0 || green >= dim || blue < 0 || blue >= dim) continue;
            row = uplift_row(cube, (red * dim + green) * dim + blue);
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
        double sum = 0, weight = UPLIFT_CAST(double, place.weights[4]);
        for (int node = 0; node < 4 && result == UPLIFT_OK; ++node)
            sum += UPLIFT_CAST(double, place.weights[node])
                * uplift_value(cube, UPLIFT_COEFFICIENTS, place.rows[node] * count + k);
        if (place.entry >= 0 && result == UPLIFT_OK)
            sum = weight * sum + (1 - weight) * uplift_value(cube, UPLIFT_ATLAS_COEFFICIENTS, place.entry * count + k);
        coefficients[k] = UPLIFT_CAST(float, sum);
    }
    return result;
}
