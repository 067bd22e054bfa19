
/* Types of arrays: their names in the file and in digests, and the bytes of a number. */
enum { UPLIFT_F64, UPLIFT_F32, UPLIFT_U8, UPLIFT_I32, UPLIFT_I16, UPLIFT_U32, UPLIFT_TYPES };

static const struct {
    const char *name, *hashed;
    int size;
} uplift_types[UPLIFT_TYPES] = {{"F64", " <f8 (", 8}, {"F32", " <f4 (", 4}, {"U8", " |u1 (", 1},
                                {"I32", " <i4 (", 4}, {"I16", " <i2 (", 2}, {"U32", " <u4 (", 4}};

typedef struct {
    uplift_string name;
    int type, rank;
    long long shape[4], length, begin, end;
    const unsigned char *bytes;
} uplift_array;

/* Arrays that lookups need: the letters of their axes, 1 for each of their types, the range of their numbers, and 1 more
   than the feature of files that have them. */
enum {
    ${arrays},
    UPLIFT_KNOWN
};

static const struct {
    const char *name, *shape;
    int types;
    double low, high;
    int feature;
} uplift_schema[UPLIFT_KNOWN] = {${schema}};

typedef struct {
    int is_sigmoid;
    long long count;
    double start, end;
    uplift_string warp;
} uplift_model;

typedef struct {
    uplift_bytes file;
    uplift_array arrays[UPLIFT_ARRAYS]; /* in the order of their names */
    const uplift_array *known[UPLIFT_KNOWN];
    int array_count;
    char *text; /* of the metadata */
    size_t text_length;
    uplift_string digest;
    unsigned int features;
    int entries, looks;
    long long dim;
    uplift_model model, entry_model;
    double threshold, bound_factor;
} uplift_content;

static const char *const uplift_features[] = {${features}};
enum { UPLIFT_DEBUG, UPLIFT_ERRORS, UPLIFT_LEFT_OUT, UPLIFT_CAMERA, UPLIFT_SPARSE };

static int uplift_has(const uplift_content *content, int feature)
{
    return UPLIFT_CAST(int, content->features >> feature & 1);
}

/* A number of an array of F64, F32 or U32. */
static double uplift_number_at(const uplift_array *array, long long index)
{
    int size = uplift_types[array->type].size;
    unsigned long long word = uplift_word(array->bytes + index * size, size);
    unsigned int half = UPLIFT_CAST(unsigned int, word);
    double value;
    float single;
    memcpy(&value, &word, sizeof value);
    memcpy(&single, &half, sizeof single);
    if (array->type == UPLIFT_F32) return UPLIFT_CAST(double, single);
    return array->type == UPLIFT_F64 ? value : UPLIFT_CAST(double, word);
}

/* Compare names as bytes, which is the order of their characters. */
static int uplift_compare(uplift_string one, uplift_string other)
{
    size_t length = one.length < other.length ? one.length : other.length;
    int order = length ? memcmp(one.text, other.text, length) : 0;
    return order ? order : (one.length > other.length) - (one.length < other.length);
}

/* Read the description of an array, {"dtype": "F64", "shape": [2, 3], "data_offsets": [0, 48]}; 0 if it is not valid. */
static int uplift_read_array(uplift_json description, uplift_array *array)
{
    const uplift_string type = uplift_string_of(description, "dtype");
    uplift_json shape = uplift_member(description, "shape"), offsets = uplift_member(description, "data_offsets");
    while (array->type < UPLIFT_TYPES && !uplift_is(type, uplift_types[array->type].name)) array->type += 1;
    array->length = 1;
    uplift_expect(&shape, '[');
    while (uplift_next(&shape, &array->rank, ']')) {
        long long size = uplift_read_size(&shape);
        if (array->rank > 4 || (size > 0 && array->length > (1LL << 50) / size)) return 0;
        array->shape[array->rank - 1] = size;
        array->length *= size;
    }
    uplift_expect(&offsets, '[');
    array->begin = uplift_read_size(&offsets);
    uplift_expect(&offsets, ',');
    array->end = uplift_read_size(&offsets);
    if (shape.failed || offsets.failed || array->type == UPLIFT_TYPES) return 0;
    return array->end - array->begin == array->length * uplift_types[array->type].size;
}

/* Copy the text of the metadata: {"uplift": "..."}. */
static int uplift_copy_text(uplift_json metadata, uplift_content *content)
{
    uplift_string text = uplift_string_of(metadata, "uplift");
    if (content->text) return UPLIFT_NOT_A_CUBE;
    content->text = UPLIFT_CAST(char *, malloc(text.length + 1));
    if (!content->text) return UPLIFT_NO_MEMORY;
    content->text_length = uplift_unescape(text, content->text);
    return content->text_length ? UPLIFT_OK : UPLIFT_NOT_A_CUBE;
}

/* Insert an array in the order of names; 0 if there is no room, or another of its name. */
static int uplift_insert_array(uplift_content *content, const uplift_array *array)
{
    int place = content->array_count, order = 1;
    if (place == UPLIFT_ARRAYS) return 0;
    for (; place > 0; --place) {
        order = uplift_compare(array->name, content->arrays[place - 1].name);
        if (order >= 0) break;
        content->arrays[place] = content->arrays[place - 1];
    }
    content->arrays[place] = *array;
    content->array_count += 1;
    return order != 0;
}

/* Read the header of the container, a safetensors file. Its arrays fill the rest of the file. */
static int uplift_read_header(uplift_content *content)
{
    const unsigned char *bytes = content->file.bytes;
    const long long size = UPLIFT_CAST(long long, content->file.size) - 8;
    long long length, total = 0;
    uplift_json json = {NULL, NULL, 0};
    int count = 0, result = UPLIFT_OK;
    if (size < 0) return UPLIFT_NOT_A_CUBE;
    if (uplift_word(bytes, 8) > UPLIFT_CAST(unsigned long long, size)) return UPLIFT_NOT_A_CUBE;
    length = UPLIFT_CAST(long long, uplift_word(bytes, 8));
    json.at = UPLIFT_CAST(const char *, UPLIFT_CAST(const void *, bytes + 8));
    json.end = json.at + length;
    uplift_expect(&json, '{');
    while (result == UPLIFT_OK && uplift_next(&json, &count, '}')) {
        uplift_array array;
        uplift_json description;
        memset(&array, 0, sizeof array);
        array.name = uplift_read_key(&json);
        description = json;
        uplift_skip(&json, UPLIFT_DEPTH);
        if (uplift_is(array.name, "__metadata__")) {
            result = uplift_copy_text(description, content);
            continue;
        }
        if (json.failed || !uplift_read_array(description, &array) || array.end > size - length) return UPLIFT_NOT_A_CUBE;
        if (array.name.length > 64 || memchr(array.name.text, '\\', array.name.length)) return UPLIFT_NOT_A_CUBE;
        array.bytes = bytes + 8 + length + array.begin;
        total += array.end - array.begin;
        if (!uplift_insert_array(content, &array)) return UPLIFT_NOT_A_CUBE;
    }
    if (result != UPLIFT_OK) return result;
    return json.failed || uplift_peek(&json) || !content->text || total != size - length ? UPLIFT_NOT_A_CUBE : UPLIFT_OK;
}

/* A model: its kind, number of coefficients and range of wavelengths. */
static uplift_model uplift_read_model(uplift_json table)
{
    uplift_model model;
    uplift_json phase = uplift_member(table, "phase");
    model.is_sigmoid = uplift_is(uplift_string_of(table, "name"), "sigmoid");
    model.count = model.is_sigmoid ? 3 : uplift_size_of(table, "count");
    if (model.is_sigmoid) phase = table;
    model.start = uplift_number_of(phase, "start");
    model.end = uplift_number_of(phase, "end");
    model.warp = uplift_string_of(phase, "warp");
    return model;
}

/* Whether entries have spectra of the model of the nodes, apart from their number of coefficients. */
static int uplift_is_model_of(const uplift_model *entries, const uplift_model *nodes)
{
    return entries->is_sigmoid == nodes->is_sigmoid && entries->start == nodes->start && entries->end == nodes->end
        && uplift_compare(entries->warp, nodes->warp) == 0;
}

static int uplift_read_features(uplift_json list, uplift_content *content)
{
    const int known = UPLIFT_CAST(int, sizeof uplift_features / sizeof *uplift_features);
    int count = 0, result = UPLIFT_OK;
    uplift_expect(&list, '[');
    while (uplift_next(&list, &count, ']')) {
        uplift_string name = uplift_read_string(&list);
        int feature = 0;
        while (feature < known && !uplift_is(name, uplift_features[feature])) feature += 1;
        if (feature < known) content->features |= 1U << feature;
        else result = UPLIFT_FEATURE;
    }
    return result;
}

/* Read the metadata. */
static int uplift_read_metadata(uplift_content *content)
{
    const uplift_json json = {content->text, content->text + content->text_length, 0};
    const uplift_json provenance = uplift_member(json, "provenance");
    uplift_json all = json, bound = uplift_member(uplift_member(provenance, "prior"), "error_bound");
    int result;
    uplift_skip(&all, UPLIFT_DEPTH);
    if (all.failed || all.at != all.end || !uplift_is(uplift_string_of(json, "format"), "uplift cube")) return UPLIFT_NOT_A_CUBE;
    if (uplift_size_of(json, "version") != UPLIFT_FORMAT) return UPLIFT_VERSION;
    result = uplift_read_features(uplift_member(json, "features"), content);
    content->digest = uplift_string_of(json, "digest");
    content->dim = uplift_size_of(json, "dim");
    content->entries = uplift_length_of(json, "entries");
    content->threshold = uplift_number_of(json, "threshold");
    content->model = uplift_read_model(uplift_member(json, "model"));
    content->entry_model = uplift_read_model(uplift_member(json, "entry_model"));
    content->looks = uplift_length_of(provenance, "looks");
    content->bound_factor = bound.failed ? 2 : uplift_read_number(&bound);
    if (result == UPLIFT_OK && !uplift_is_model_of(&content->entry_model, &content->model)) result = UPLIFT_INVALID;
    return result;
}

static void uplift_hash_bytes(uplift_hash *hash, const char *text, size_t length)
{
    uplift_hash_add(hash, UPLIFT_CAST(const unsigned char *, UPLIFT_CAST(const void *, text)), length);
}

static void uplift_hash_text(uplift_hash *hash, const char *text)
{
    uplift_hash_bytes(hash, text, strlen(text));
}

static void uplift_hash_number(uplift_hash *hash, long long number)
{
    char digits[21];
    char *first = digits + sizeof digits - 1;
    *first = 0;
    do *--first = UPLIFT_CAST(char, '0' + number % 10);
    while (number /= 10);
    uplift_hash_text(hash, first);
}

/* Whether the file has the content of its digest. */
static int uplift_check_digest(const uplift_content *content)
{
    const size_t before = strlen("\"digest\":\""), after = strlen("\","); /* which are not hashed either */
    const char *start = content->digest.length == 64 ? content->digest.text - before : content->text;
    const char *rest = start + before + 64 + after, *end = content->text + content->text_length;
    char digits[64];
    uplift_hash hash;
    if (content->digest.length != 64 || start < content->text || rest > end) return UPLIFT_DAMAGED;
    uplift_hash_start(&hash);
    uplift_hash_bytes(&hash, content->text, UPLIFT_CAST(size_t, start - content->text));
    uplift_hash_bytes(&hash, rest, UPLIFT_CAST(size_t, end - rest));
    for (int k = 0; k < content->array_count; ++k) {
        const uplift_array *array = content->arrays + k;
        uplift_hash_bytes(&hash, array->name.text, array->name.length);
        uplift_hash_text(&hash, uplift_types[array->type].hashed);
        for (int axis = 0; axis < array->rank; ++axis) {
            if (axis > 0) uplift_hash_text(&hash, ", ");
            uplift_hash_number(&hash, array->shape[axis]);
        }
        uplift_hash_text(&hash, array->rank == 1 ? ",)" : ")");
        uplift_hash_add(&hash, array->bytes, UPLIFT_CAST(size_t, array->end - array->begin));
    }
    uplift_hash_end(&hash, digits);
    return memcmp(digits, content->digest.text, 64) == 0 ? UPLIFT_OK : UPLIFT_DAMAGED;
}

/* Whether a number is neither NaN nor infinite, by its bits: compilers may be told that none is. */
static int uplift_is_finite(const double *x)
{
    const unsigned long long exponent = 0x7ff0000000000000;
    unsigned long long bits;
    memcpy(&bits, x, sizeof bits);
    return (bits & exponent) != exponent;
}

/* The array of a name, or NULL. */
static const uplift_array *uplift_named(const uplift_content *content, const char *name)
{
    for (int k = 0; k < content->array_count; ++k)
        if (uplift_is(content->arrays[k].name, name)) return content->arrays + k;
    return NULL;
}

static int uplift_fits(const uplift_array *array, int known, const long long sizes[128])
{
    const char *shape = uplift_schema[known].shape;
    if (!array || !(uplift_schema[known].types >> array->type & 1)) return 0;
    if (array->rank != (shape[1] ? 2 : 1) || array->shape[0] != sizes[shape[0] & 127]) return 0;
    if (shape[1] && array->shape[1] != sizes[shape[2] & 127]) return 0;
    for (long long k = 0; k < array->length; ++k) {
        double value = uplift_number_at(array, k);
        if (!uplift_is_finite(&value) || value < uplift_schema[known].low || value > uplift_schema[known].high) return 0;
    }
    return 1;
}

/* Find the arrays that lookups need, and check their types, shapes and numbers. */
static int uplift_find_arrays(uplift_content *content)
{
    const uplift_array *points = uplift_named(content, "points"), *wavelengths = uplift_named(content, "sensor.wavelengths");
    const int is_sparse = uplift_has(content, UPLIFT_SPARSE);
    long long sizes[128] = {0};
    if (content->dim > UPLIFT_MOST_DIM || content->entries > 1 << 24) return UPLIFT_TOO_LARGE;
    if (!wavelengths || (is_sparse && !points)) return UPLIFT_INVALID;
    sizes['3'] = 3;
    sizes['D'] = content->dim;
    sizes['n'] = is_sparse ? points->length : content->dim * content->dim * content->dim;
    sizes['N'] = wavelengths->length;
    sizes['E'] = content->entries;
    sizes['C'] = content->model.count;
    sizes['K'] = content->entry_model.count;
    for (int k = 0; k < UPLIFT_KNOWN; ++k) {
        int feature = uplift_schema[k].feature;
        if (feature && !uplift_has(content, feature - 1)) continue;
        if (k == UPLIFT_ATLAS_ENTRY_COEFFICIENTS && sizes['K'] == sizes['C']) continue;
        content->known[k] = uplift_named(content, uplift_schema[k].name);
        if (!uplift_fits(content->known[k], k, sizes)) return UPLIFT_INVALID;
    }
    return UPLIFT_OK;
}
