
struct uplift_cube {
    uplift_content content;
    /* The lookup for its number of coefficients, see below. */
    void (*reflectances)(const uplift_cube *, const float *, int, const float *, int, float *);
    /* The table of exported programs, and the constants that locate its sections. */
    float *numbers;
    int entries, cells, bins, lists, boxes, pull, scales, luminance, facets, facet_count, samples, dim, stride, tag;
    int entry_count, is_warped, is_inexact; /* numbers of an entry in the table */
    float first, step, margin, start, end, low, scale, warp[6];
    /* A cube of a scene: numbers of nodes that have a row, ascending, their rows, and where the numbers of each line of
       nodes along blue begin. Rows from `present` on belong to nodes that are absent. */
    int *points, *rows, *lines, point_count, present, absent_row;
};

/* A number of an array that lookups need. */
static double uplift_value(const uplift_cube *cube, int array, long long index)
{
    return uplift_number_at(cube->content.known[array], index);
}

/* Whether the node in a row has not its own colour. */
static int uplift_misses(const uplift_cube *cube, int row)
{
    return uplift_value(cube, UPLIFT_DISTANCE, row) > cube->content.threshold;
}

/* Row of a node in the table and in the arrays of the file; that of an absent node has no spectrum. */
static int uplift_find_row(const uplift_cube *cube, int index)
{
    int low = cube->lines[index / cube->dim], high = cube->lines[index / cube->dim + 1];
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (cube->points[middle] < index) low = middle + 1;
        else high = middle;
    }
    return low < cube->point_count && cube->points[low] == index ? cube->rows[low] : cube->absent_row;
}

static inline int uplift_row(const uplift_cube *cube, int index)
{
    return cube->points ? uplift_find_row(cube, index) : index;
}

/* Multipliers p of moments c, or 0: the bounded maximum-entropy spectrum (Peters et al. 2019), by Schur's algorithm (1917).
   docs/cube-file.md, Spectra, has the steps. */
static int uplift_try_multipliers(const double *c, int count, double *p)
{
    const double pi = 3.14159265358979323846;
    double real[UPLIFT_MOST_COUNT], imaginary[UPLIFT_MOST_COUNT];
    double u[UPLIFT_MOST_COUNT], v[UPLIFT_MOST_COUNT], a[UPLIFT_MOST_COUNT], b[UPLIFT_MOST_COUNT];
    double tangent = tan(pi / 2 * c[0]), scale = 2, sine = sin(pi * c[0]), cosine = cos(pi * c[0]);
    int is_valid = c[0] >= 0 && c[0] <= 1;
    /* exp(iX), X = pi sum c_l z^l */
    for (int order = 0; order < count; ++order) {
        double sum_real = order == 0, sum_imaginary = 0;
        for (int k = 0; k < order; ++k) {
            double slope = pi * (order - k) * c[order - k];
            sum_real -= slope * imaginary[k];
            sum_imaginary += slope * real[k];
        }
        real[order] = sum_real / (order ? order : 1);
        imaginary[order] = sum_imaginary / (order ? order : 1);
    }
    for (int k = 0; k < count; ++k) {
        u[k] = k + 1 < count ? imaginary[k + 1] : 0;
        v[k] = sine * real[k] + cosine * imaginary[k];
        a[k] = b[k] = k == 0;
    }
    for (int order = 0; order < count - 1; ++order) {
        double g = u[0] / v[0];
        for (int k = 0; k < count - 2 - order; ++k) {
            double held = u[k + 1] - g * v[k + 1];
            v[k] -= g * u[k];
            u[k] = held;
        }
        for (int k = 0; k <= (order + 1) / 2; ++k) {
            int mirror = order + 1 - k;
            double first = a[k], second = b[k];
            a[k] += g * a[mirror];
            b[k] -= g * b[mirror];
            if (mirror != k) {
                a[mirror] += g * first;
                b[mirror] -= g * second;
            }
        }
        scale *= 1 - g * g;
        is_valid = is_valid && g * g < 1;
    }
    for (int lag = 0; lag < count; ++lag) {
        double first = 0, second = 0;
        for (int k = 0; k + lag < count; ++k) {
            first += a[k] * a[k + lag];
            second += b[k] * b[k + lag];
        }
        p[lag] = (tangent * first - second / tangent) / scale;
        is_valid = is_valid && uplift_is_finite(p + lag);
    }
    return is_valid;
}

/* Multipliers of the coefficients in a row of an array, with as little grey as necessary; 0 if no spectrum has them. */
static int uplift_multipliers(const uplift_cube *cube, const uplift_array *array, int row, double *p)
{
    static const double greys[] = {0, 1e-10, 1e-8, 1e-6, 1e-4};
    const int count = UPLIFT_CAST(int, array->shape[1]);
    double given[UPLIFT_MOST_COUNT] = {0}, mixed[UPLIFT_MOST_COUNT];
    for (int k = 0; k < count; ++k) given[k] = p[k] = uplift_number_at(array, row * array->shape[1] + k);
    if (cube->content.model.is_sigmoid) return 1;
    for (int turn = 0; turn < 5; ++turn) {
        for (int k = 0; k < count; ++k) mixed[k] = (1 - greys[turn]) * given[k];
        mixed[0] += 0.5 * greys[turn];
        if (uplift_try_multipliers(mixed, count, p)) return 1;
    }
    return 0;
}

/* Write the multipliers of a row of an array in single precision, scaled to a sum of at most `most`; 0 for numbers with
   which spectra cannot be evaluated. */
static int uplift_store(const uplift_cube *cube, const uplift_array *array, int row, double most, float *stored)
{
    const int count = UPLIFT_CAST(int, array->shape[1]);
    const double limit = cube->content.model.is_sigmoid ? 1e18 : 1e30;
    double p[UPLIFT_MOST_COUNT], size = 0;
    if (!uplift_multipliers(cube, array, row, p)) return 0;
    for (int k = 0; k < count; ++k) {
        if (!uplift_is_finite(p + k) || fabs(p[k]) > limit) return 0;
        size += fabs(p[k]);
    }
    for (int k = 0; k < count; ++k) stored[k] = UPLIFT_CAST(float, size > most ? p[k] * (most / size) : p[k]);
    return 1;
}

/* Index of the last node up to x, at most that before the last. */
static int uplift_cell(const uplift_cube *cube, double x)
{
    int low = 0, high = cube->dim - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (uplift_value(cube, UPLIFT_NODES, middle) <= x) low = middle;
        else high = middle;
    }
    return low;
}

/* Set the lower and the upper face of the box of an entry along an axis. It has no face at the edge of the lattice where
   the entry is there: rounding would decide. */
static void uplift_set_faces(const uplift_cube *cube, double centre, double reach, double faces[2])
{
    int last = cube->dim - 1, cell = uplift_cell(cube, centre);
    double first = uplift_value(cube, UPLIFT_NODES, cell), next = uplift_value(cube, UPLIFT_NODES, cell + 1);
    double position = cell + (centre - first) / (next - first);
    for (int side = 0; side < 2; ++side) {
        double at = position + (side ? reach : -reach);
        int low = at < 0 ? 0 : UPLIFT_CAST(int, at);
        low = low < last ? low : last - 1;
        at = at < 0 ? 0 : at > last ? last : at;
        first = uplift_value(cube, UPLIFT_NODES, low);
        next = uplift_value(cube, UPLIFT_NODES, low + 1);
        faces[side] = first + (at - low) * (next - first);
    }
    if (centre < 1e-6) faces[0] = 2 * centre - faces[1];
    else if (centre > 1 - 1e-6) faces[1] = 2 * centre - faces[0];
}

/* Write the box of an entry, along each axis its centre, what rounding left of it, and reciprocals of the distances to the
   lower and upper faces. Set the first and last cells that it touches along each axis. */
static void uplift_make_box(const uplift_cube *cube, int entry, float box[12], int low[3], int high[3])
{
    const double reach = uplift_value(cube, UPLIFT_ATLAS_REACH, entry);
    for (int k = 0; k < 3; ++k) {
        double centre = uplift_value(cube, UPLIFT_ATLAS_RGB, 3 * entry + k), faces[2];
        int cell = uplift_cell(cube, centre);
        uplift_set_faces(cube, centre, reach, faces);
        low[k] = uplift_cell(cube, faces[0]);
        high[k] = uplift_cell(cube, faces[1]);
        low[k] = low[k] > cell - 1 ? low[k] : cell - 1;
        high[k] = high[k] < cell + 1 ? high[k] : cell + 1;
        box[4 * k] = UPLIFT_CAST(float, centre);
        box[4 * k + 1] = UPLIFT_CAST(float, centre - UPLIFT_CAST(double, box[4 * k]));
        box[4 * k + 2] = UPLIFT_CAST(float, centre > faces[0] ? 1 / (centre - faces[0]) : 0);
        box[4 * k + 3] = UPLIFT_CAST(float, faces[1] > centre ? 1 / (faces[1] - centre) : 0);
    }
}

/* A cell that the box of an entry touches. */
typedef struct {
    int cell, entry;
} uplift_touch;

static int uplift_order_touches(const void *one, const void *other)
{
    const uplift_touch *a = UPLIFT_CAST(const uplift_touch *, one), *b = UPLIFT_CAST(const uplift_touch *, other);
    return a->cell != b->cell ? a->cell - b->cell : a->entry - b->entry;
}

/* List the cells that boxes touch, by cell and entry; count only, without `touches`. */
static int uplift_list_touches(const uplift_cube *cube, uplift_touch *touches)
{
    int count = 0;
    for (int entry = 0; entry < cube->content.entries; ++entry) {
        int low[3], high[3];
        float box[12];
        if (!(uplift_value(cube, UPLIFT_ATLAS_REACH, entry) > 0)) continue;
        uplift_make_box(cube, entry, box, low, high);
        for (int red = low[0]; red <= high[0]; ++red)
            for (int green = low[1]; green <= high[1]; ++green)
                for (int blue = low[2]; blue <= high[2]; ++blue, ++count)
                    if (touches) {
                        touches[count].cell = (red * cube->dim + green) * cube->dim + blue;
                        touches[count].entry = entry;
                    }
    }
    if (touches) qsort(touches, UPLIFT_CAST(size_t, count), sizeof *touches, uplift_order_touches);
    return count;
}

/* The sensor: curves without the light (3, N), weights from reflectance to RGB (3, N), and weights of the luminance. */
typedef struct {
    double shapes[3][UPLIFT_SAMPLE_ROOM], weights[3][UPLIFT_SAMPLE_ROOM], luminance[3];
    double first, step;
    int samples;
} uplift_sensor;

/* The inverse of a matrix; 0 if it has none. */
static int uplift_invert(double m[3][3], double inverse[3][3])
{
    double determinant = 0;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            int a = (column + 1) % 3, b = (column + 2) % 3, c = (row + 1) % 3, d = (row + 2) % 3;
            inverse[row][column] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    for (int k = 0; k < 3; ++k) determinant += m[0][k] * inverse[k][0];
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            inverse[row][column] /= determinant;
            if (!uplift_is_finite(inverse[row] + column) || fabs(inverse[row][column]) > 1e30) return 0;
        }
    return 1;
}

static int uplift_read_sensor(const uplift_cube *cube, uplift_sensor *sensor)
{
    const long long samples = cube->content.known[UPLIFT_SENSOR_WAVELENGTHS]->length;
    const int is_camera = uplift_has(&cube->content, UPLIFT_CAMERA);
    double matrix[3][3], inverse[3][3], sums[3] = {0, 0, 0}, scale = 0;
    if (samples < 2) return UPLIFT_INVALID;
    if (samples > UPLIFT_SAMPLE_ROOM) return UPLIFT_UNSUPPORTED;
    sensor->samples = UPLIFT_CAST(int, samples);
    sensor->first = uplift_value(cube, UPLIFT_SENSOR_WAVELENGTHS, 0);
    sensor->step = uplift_value(cube, UPLIFT_SENSOR_WAVELENGTHS, 1) - sensor->first;
    if (!(sensor->step > 0) || sensor->first > 380) return UPLIFT_INVALID;
    if (uplift_value(cube, UPLIFT_SENSOR_WAVELENGTHS, samples - 1) < 780) return UPLIFT_INVALID;
    for (int k = 0; k < 9; ++k) matrix[k / 3][k % 3] = uplift_value(cube, UPLIFT_SENSOR_XYZ_TO_RGB, k);
    if (!uplift_invert(matrix, inverse)) return UPLIFT_INVALID;
    for (int k = 0; k < 3; ++k) sensor->luminance[k] = inverse[1][k];
    for (int k = 0; k < sensor->samples; ++k) {
        double even = sensor->first + k * sensor->step, power = uplift_value(cube, UPLIFT_SENSOR_POWER, k);
        if (!(fabs(uplift_value(cube, UPLIFT_SENSOR_WAVELENGTHS, k) - even) < 1e-6 * sensor->step)) return UPLIFT_UNSUPPORTED;
        scale += power * uplift_value(cube, UPLIFT_SENSOR_CMFS, 3 * k + 1);
        for (int channel = 0; channel < 3; ++channel) {
            double shape = 0;
            if (is_camera) shape = uplift_value(cube, UPLIFT_SENSOR_SENSITIVITIES, 3 * k + channel);
            else
                for (int axis = 0; axis < 3; ++axis)
                    shape += uplift_value(cube, UPLIFT_SENSOR_CMFS, 3 * k + axis) * matrix[channel][axis];
            sensor->shapes[channel][k] = shape;
            sums[channel] += shape * power;
        }
    }
    for (int channel = 0; channel < 3; ++channel) {
        double white = 0;
        for (int k = 0; k < sensor->samples; ++k) {
            double shape = sensor->shapes[channel][k], power = uplift_value(cube, UPLIFT_SENSOR_POWER, k);
            if (is_camera) shape = sensor->shapes[channel][k] /= sums[channel];
            sensor->weights[channel][k] = shape * power / (is_camera ? 1 : scale);
            white += sensor->weights[channel][k];
        }
        if (!uplift_is_finite(&white) || fabs(white - 1) > 1e-6) return UPLIFT_INVALID;
    }
    return UPLIFT_OK;
}

/* The inverse of L, where L L^T = W K^T; 0 if there is none. */
static int uplift_scale_colours(const uplift_sensor *sensor, double inverse[3][3])
{
    double lower[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column <= row; ++column) {
            double sum = 0;
            for (int k = 0; k < sensor->samples; ++k) sum += sensor->weights[row][k] * sensor->shapes[column][k];
            for (int k = 0; k < column; ++k) sum -= lower[row][k] * lower[column][k];
            lower[row][column] = row == column ? sqrt(sum) : sum / lower[column][column];
        }
    return uplift_invert(lower, inverse);
}

/* Write the facets of the solid of all colours of reflectances, normals and half the width along them: each pair of
   wavelengths spans two (MacAdam 1935). Return how many pairs do; count only, without `facets`. */
static int uplift_list_facets(const uplift_sensor *sensor, float *facets)
{
    int count = 0;
    for (int i = 0; i < sensor->samples; ++i)
        for (int j = i + 1; j < sensor->samples; ++j) {
            double cross[3], lengths[3] = {0, 0, 0}, width = 0;
            for (int k = 0; k < 3; ++k) {
                int a = (k + 1) % 3, b = (k + 2) % 3;
                cross[k] = sensor->weights[a][i] * sensor->weights[b][j] - sensor->weights[b][i] * sensor->weights[a][j];
                lengths[0] += cross[k] * cross[k];
                lengths[1] += sensor->weights[k][i] * sensor->weights[k][i];
                lengths[2] += sensor->weights[k][j] * sensor->weights[k][j];
            }
            if (!(sqrt(lengths[0]) > 1e-12 * sqrt(lengths[1]) * sqrt(lengths[2]))) continue;
            if (facets) {
                for (int k = 0; k < 3; ++k) cross[k] /= sqrt(lengths[0]);
                for (int k = 0; k < sensor->samples; ++k)
                    width += fabs(
                        cross[0] * sensor->weights[0][k] + cross[1] * sensor->weights[1][k] + cross[2] * sensor->weights[2][k]);
                for (int k = 0; k < 3; ++k) facets[4 * count + k] = UPLIFT_CAST(float, cross[k]);
                facets[4 * count + 3] = UPLIFT_CAST(float, width / 2);
            }
            count += 1;
        }
    return count;
}
