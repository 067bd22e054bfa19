
/* Arrays of a file, in the order of their names. */
enum { UPLIFT_F64, UPLIFT_F32, UPLIFT_U8, UPLIFT_I32, UPLIFT_I16, UPLIFT_U32, UPLIFT_TYPES };

typedef struct {
    uplift_string name;
    int type, rank;
    unsigned long long shape[4], length, begin, end;
    const unsigned char *bytes;
} uplift_array;

typedef struct {
    uplift_bytes file;
    uplift_array arrays[UPLIFT_ARRAYS];
    int array_count;
    char *text; /* of the metadata */
    size_t text_length;
    uplift_string digest, digest_entry;
    unsigned int features;
    int version, is_sigmoid, entries, outside, looks;
    unsigned long long dim, count, entry_count;
    double start, end, threshold, bound_factor;
    uplift_string warp;
} uplift_content;

static const char *const uplift_features[] = {${features}};
enum { UPLIFT_DEBUG, UPLIFT_ERRORS, UPLIFT_LEFT_OUT, UPLIFT_CAMERA, UPLIFT_SPARSE };

static int uplift_has(const uplift_content *content, int feature)
{
    return UPLIFT_CAST(int, content->features >> feature & 1);
}

static int uplift_item_size(int type)
{
    static const int sizes[UPLIFT_TYPES] = {8, 4, 1, 4, 2, 4};
    return sizes[type];
}

/* A number of an array. */
static double uplift_number_at(const uplift_array *array, size_t index)
{
    int size = uplift_item_size(array->type);
    unsigned long long word = uplift_word(array->bytes + index * UPLIFT_CAST(size_t, size), size);
    if (array->type == UPLIFT_F64) {
        double value;
        memcpy(&value, &word, sizeof value);
        return value;
    }
    if (array->type == UPLIFT_F32) {
        unsigned int half = UPLIFT_CAST(unsigned int, word);
        float value;
        memcpy(&value, &half, sizeof value);
        return value;
    }
    if (array->type == UPLIFT_I32) return word > 0x7FFFFFFF ? UPLIFT_CAST(double, word) - 4294967296.0 : UPLIFT_CAST(double, word);
    if (array->type == UPLIFT_I16) return word > 0x7FFF ? UPLIFT_CAST(double, word) - 65536.0 : UPLIFT_CAST(double, word);
    return UPLIFT_CAST(double, word);
}

/* Compare names as bytes, which is the order of their characters. */
static int uplift_compare(uplift_string one, uplift_string other)
{
    size_t length = one.length < other.length ? one.length : other.length;
    int order = length ? memcmp(one.text, other.text, length) : 0;
    return order ? order : (one.length > other.length) - (one.length < other.length);
}

/* Read the description of an array: {"dtype": "F64", "shape": [2, 3], "data_offsets": [0, 48]}. */
static void uplift_read_array(uplift_json *json, uplift_array *array)
{
    static const char *const types[UPLIFT_TYPES] = {"F64", "F32", "U8", "I32", "I16", "U32"};
    unsigned long long length = 1;
    int count = 0, keys = 0;
    array->type = -1;
    uplift_expect(json, '{');
    while (uplift_next(json, &count, '}')) {
        uplift_string key = uplift_read_key(json);
        if (uplift_is(key, "dtype")) {
            uplift_string type = uplift_read_string(json);
            for (int k = 0; k < UPLIFT_TYPES; ++k)
                if (uplift_is(type, types[k])) array->type = k;
            keys |= 1;
        } else if (uplift_is(key, "shape")) {
            int axis = 0;
            uplift_expect(json, '[');
            while (uplift_next(json, &axis, ']')) {
                unsigned long long size = uplift_read_size(json);
                if (axis > 4 || (size > 0 && length > (1ULL << 50) / size)) {
                    uplift_fail(json);
                } else {
                    array->shape[axis - 1] = size;
                    length *= size;
                }
            }
            array->rank = axis < 4 ? axis : 4;
            keys |= 2;
        } else if (uplift_is(key, "data_offsets")) {
            uplift_expect(json, '[');
            array->begin = uplift_read_size(json);
            uplift_expect(json, ',');
            array->end = uplift_read_size(json);
            uplift_expect(json, ']');
            keys |= 4;
        } else {
            uplift_fail(json);
        }
    }
    array->length = length;
    if (count != 3 || keys != 7 || array->type < 0 || array->begin > array->end) uplift_fail(json);
    else if (array->end - array->begin != length * UPLIFT_CAST(unsigned, uplift_item_size(array->type))) uplift_fail(json);
}

/* Copy the text of the metadata: {"uplift": "..."}. */
static int uplift_copy_text(uplift_json *json, uplift_content *content)
{
    uplift_string key, text;
    uplift_expect(json, '{');
    key = uplift_read_key(json);
    text = uplift_read_string(json);
    uplift_expect(json, '}');
    if (json->failed || content->text || !uplift_is(key, "uplift")) return UPLIFT_NOT_A_CUBE;
    content->text = UPLIFT_CAST(char *, malloc(text.length + 1));
    if (!content->text) return UPLIFT_NO_MEMORY;
    content->text_length = uplift_unescape(text, content->text);
    return UPLIFT_OK;
}

/* Read the header of the container, a safetensors file, and sort its arrays. They must fill the rest of the file. */
static int uplift_read_header(uplift_content *content)
{
    const unsigned char *bytes = content->file.bytes;
    size_t size = content->file.size;
    unsigned long long length = size < 8 ? 0 : uplift_word(bytes, 8), total = 0;
    uplift_json json;
    int count = 0, result = UPLIFT_OK;
    if (size < 8 || length > size - 8) return UPLIFT_NOT_A_CUBE;
    json.at = UPLIFT_CAST(const char *, UPLIFT_CAST(const void *, bytes + 8));
    json.end = json.at + length;
    json.failed = 0;
    uplift_expect(&json, '{');
    while (result == UPLIFT_OK && uplift_next(&json, &count, '}')) {
        uplift_array array;
        int place = content->array_count;
        memset(&array, 0, sizeof array);
        array.name = uplift_read_key(&json);
        if (uplift_is(array.name, "__metadata__")) {
            result = uplift_copy_text(&json, content);
            continue;
        }
        uplift_read_array(&json, &array);
        if (array.name.length > 64 || memchr(array.name.text, '\\', array.name.length)) uplift_fail(&json);
        if (json.failed || place == UPLIFT_ARRAYS || array.end > size - 8 - length) return UPLIFT_NOT_A_CUBE;
        array.bytes = bytes + 8 + length + array.begin;
        total += array.end - array.begin;
        for (; place > 0 && uplift_compare(content->arrays[place - 1].name, array.name) >= 0; --place) {
            if (uplift_compare(content->arrays[place - 1].name, array.name) == 0) return UPLIFT_NOT_A_CUBE;
            content->arrays[place] = content->arrays[place - 1];
        }
        content->arrays[place] = array;
        content->array_count += 1;
    }
    if (result != UPLIFT_OK) return result;
    if (json.failed || uplift_peek(&json) || !content->text_length || total != size - 8 - length) return UPLIFT_NOT_A_CUBE;
    for (int k = 0; k < content->array_count; ++k)
        for (int other = 0; other < k; ++other) {
            const uplift_array *one = content->arrays + k, *two = content->arrays + other;
            if (one->begin < two->end && two->begin < one->end) return UPLIFT_NOT_A_CUBE;
        }
    return UPLIFT_OK;
}

/* A model: its kind, number of coefficients and range of wavelengths. */
static void uplift_read_model(uplift_json *json, uplift_content *content, unsigned long long *count)
{
    uplift_string name = {"", 0};
    int keys = 0;
    *count = 3;
    uplift_expect(json, '{');
    while (uplift_next(json, &keys, '}')) {
        uplift_string key = uplift_read_key(json);
        if (uplift_is(key, "name")) {
            name = uplift_read_string(json);
        } else if (uplift_is(key, "count")) {
            *count = uplift_read_size(json);
        } else if (uplift_is(key, "start")) {
            content->start = uplift_read_number(json);
        } else if (uplift_is(key, "end")) {
            content->end = uplift_read_number(json);
        } else if (uplift_is(key, "phase")) {
            int parts = 0;
            uplift_expect(json, '{');
            while (uplift_next(json, &parts, '}')) {
                uplift_string part = uplift_read_key(json);
                if (uplift_is(part, "start")) content->start = uplift_read_number(json);
                else if (uplift_is(part, "end")) content->end = uplift_read_number(json);
                else if (uplift_is(part, "warp")) content->warp = uplift_read_string(json);
                else uplift_fail(json);
            }
        } else {
            uplift_fail(json);
        }
    }
    content->is_sigmoid = uplift_is(name, "sigmoid");
    if (!content->is_sigmoid && !uplift_is(name, "moments")) uplift_fail(json);
}

static int uplift_read_features(uplift_json *json, uplift_content *content)
{
    const int known = UPLIFT_CAST(int, sizeof uplift_features / sizeof *uplift_features);
    int count = 0, result = UPLIFT_OK;
    uplift_expect(json, '[');
    while (uplift_next(json, &count, ']')) {
        uplift_string name = uplift_read_string(json);
        int feature = 0;
        while (feature < known && !uplift_is(name, uplift_features[feature])) feature += 1;
        if (feature < known) content->features |= 1U << feature;
        else result = UPLIFT_FEATURE;
    }
    return result;
}

static void uplift_read_provenance(uplift_json *json, uplift_content *content)
{
    int count = 0;
    uplift_expect(json, '{');
    while (uplift_next(json, &count, '}')) {
        uplift_string key = uplift_read_key(json);
        if (uplift_is(key, "left_out")) {
            content->outside = uplift_read_length(json);
        } else if (uplift_is(key, "looks")) {
            content->looks = uplift_read_length(json);
        } else if (uplift_is(key, "prior")) {
            int parts = 0;
            uplift_expect(json, '{');
            while (uplift_next(json, &parts, '}')) {
                if (uplift_is(uplift_read_key(json), "error_bound")) content->bound_factor = uplift_read_number(json);
                else uplift_skip(json, UPLIFT_DEPTH);
            }
        } else {
            uplift_skip(json, UPLIFT_DEPTH);
        }
    }
}

/* Read the metadata. */
static int uplift_read_metadata(uplift_content *content)
{
    uplift_json json = {content->text, content->text + content->text_length, 0};
    uplift_string before = {"", 0}, format = {"", 0};
    unsigned long long version = 0;
    int count = 0, feature_result = UPLIFT_OK, has_entry_model = 0;
    double end = 0, start = 0;
    uplift_string warp = {"", 0};
    content->bound_factor = 2;
    uplift_expect(&json, '{');
    while (uplift_next(&json, &count, '}')) {
        const char *first = json.at;
        uplift_string key = uplift_read_key(&json);
        if (count > 1 && uplift_compare(before, key) >= 0) uplift_fail(&json);
        before = key;
        if (uplift_is(key, "digest")) {
            content->digest = uplift_read_string(&json);
            content->digest_entry.text = first;
            content->digest_entry.length = UPLIFT_CAST(size_t, json.at - first) + 1; /* with the comma */
            if (uplift_peek(&json) != ',') uplift_fail(&json);
        } else if (uplift_is(key, "dim")) {
            content->dim = uplift_read_size(&json);
        } else if (uplift_is(key, "entries")) {
            content->entries = uplift_read_length(&json);
        } else if (uplift_is(key, "entry_model")) {
            uplift_read_model(&json, content, &content->entry_count);
            has_entry_model = 1 + content->is_sigmoid;
            start = content->start;
            end = content->end;
            warp = content->warp;
        } else if (uplift_is(key, "features")) {
            feature_result = uplift_read_features(&json, content);
        } else if (uplift_is(key, "format")) {
            format = uplift_read_string(&json);
        } else if (uplift_is(key, "model")) {
            uplift_read_model(&json, content, &content->count);
        } else if (uplift_is(key, "provenance")) {
            uplift_read_provenance(&json, content);
        } else if (uplift_is(key, "threshold")) {
            content->threshold = uplift_read_number(&json);
        } else if (uplift_is(key, "version")) {
            version = uplift_read_size(&json);
        } else if (
            uplift_is(key, "space") || uplift_is(key, "illuminant") || uplift_is(key, "observer")
            || uplift_is(key, "reference")) {
            uplift_read_string(&json);
        } else {
            uplift_skip(&json, UPLIFT_DEPTH); /* a later version may have more, and is refused below */
        }
    }
    if (!uplift_is(format, "uplift cube")) return UPLIFT_NOT_A_CUBE;
    if (version != 3 && version != UPLIFT_FORMAT) return json.failed ? UPLIFT_NOT_A_CUBE : UPLIFT_VERSION;
    if (json.failed || json.at != json.end) return UPLIFT_NOT_A_CUBE;
    if (feature_result != UPLIFT_OK) return feature_result;
    content->version = UPLIFT_CAST(int, version);
    if (version == 3) {
        content->entry_count = content->count;
    } else if (
        !has_entry_model || has_entry_model != 1 + content->is_sigmoid || start != content->start || end != content->end
        || uplift_compare(warp, content->warp) != 0) {
        return UPLIFT_INVALID;
    }
    return UPLIFT_OK;
}

static const unsigned char *uplift_bytes_of(const char *text)
{
    return UPLIFT_CAST(const unsigned char *, UPLIFT_CAST(const void *, text));
}

static void uplift_hash_text(uplift_hash *hash, const char *text)
{
    uplift_hash_add(hash, uplift_bytes_of(text), strlen(text));
}

static void uplift_hash_number(uplift_hash *hash, unsigned long long number)
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
    static const char *const types[UPLIFT_TYPES] = {" <f8 (", " <f4 (", " |u1 (", " <i4 (", " <i2 (", " <u4 ("};
    const char *rest = content->digest_entry.text + content->digest_entry.length;
    const char *end = content->text + content->text_length;
    char digits[64];
    uplift_hash hash;
    if (content->digest.length != 64) return UPLIFT_DAMAGED;
    uplift_hash_start(&hash);
    uplift_hash_add(
        &hash, uplift_bytes_of(content->text), UPLIFT_CAST(size_t, content->digest_entry.text - content->text));
    uplift_hash_add(&hash, uplift_bytes_of(rest), UPLIFT_CAST(size_t, end - rest));
    for (int k = 0; k < content->array_count; ++k) {
        const uplift_array *array = content->arrays + k;
        uplift_hash_add(&hash, uplift_bytes_of(array->name.text), array->name.length);
        uplift_hash_text(&hash, types[array->type]);
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

/* The array of a name with numbers from `low` to `high`, of one of two types; NULL if there is none, or it is not valid.
   It has one axis if `width` is 0. */
static const uplift_array *uplift_find_array(
    const uplift_content *content, const char *name, int type, int other, unsigned long long length,
    unsigned long long width, double low, double high)
{
    for (int k = 0; k < content->array_count; ++k) {
        const uplift_array *array = content->arrays + k;
        if (!uplift_is(array->name, name)) continue;
        if (array->type != type && array->type != other) return NULL;
        if (array->rank != (width ? 2 : 1) || array->shape[0] != length || (width && array->shape[1] != width)) return NULL;
        for (size_t i = 0; i < array->length; ++i) {
            double value = uplift_number_at(array, i);
            if (!uplift_is_finite(&value) || value < low || value > high) return NULL;
        }
        return array;
    }
    return NULL;
}
