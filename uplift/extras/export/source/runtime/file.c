
/* Bytes of a file. Those that the reader mapped or allocated are also `owned`. */
typedef struct {
    const unsigned char *bytes;
    unsigned char *owned;
    size_t size;
} uplift_bytes;

#ifdef UPLIFT_MMAP

static void uplift_release(uplift_bytes *file)
{
    if (file->owned) munmap(file->owned, file->size);
}

static int uplift_acquire(const char *path, uplift_bytes *file)
{
    struct stat about;
    void *mapped = MAP_FAILED;
    int descriptor = open(path, O_RDONLY);
    int is_file = descriptor >= 0 && fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
    if (is_file && about.st_size > 0) {
        file->size = UPLIFT_CAST(size_t, about.st_size);
        mapped = mmap(NULL, file->size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    }
    if (descriptor >= 0) close(descriptor);
    if (is_file && about.st_size == 0) return UPLIFT_NOT_A_CUBE;
    if (mapped == MAP_FAILED) return UPLIFT_NO_FILE;
    file->bytes = file->owned = UPLIFT_CAST(unsigned char *, mapped);
    return UPLIFT_OK;
}

#elif !defined(UPLIFT_NO_FILES)

static void uplift_release(uplift_bytes *file)
{
    free(file->owned);
}

static int uplift_acquire(const char *path, uplift_bytes *file)
{
    int result = UPLIFT_NO_FILE;
    FILE *stream = fopen(path, "rb");
    long size = stream && fseek(stream, 0, SEEK_END) == 0 ? ftell(stream) : -1;
    if (size >= 0 && fseek(stream, 0, SEEK_SET) == 0) {
        file->size = UPLIFT_CAST(size_t, size);
        file->owned = UPLIFT_CAST(unsigned char *, malloc(file->size + 1));
        file->bytes = file->owned;
        if (!file->owned) result = UPLIFT_NO_MEMORY;
        else if (fread(file->owned, 1, file->size, stream) == file->size) result = UPLIFT_OK;
    }
    if (stream) fclose(stream);
    return result;
}

#endif

/* A little-endian whole number of up to eight bytes. */
static unsigned long long uplift_word(const unsigned char *bytes, int size)
{
    unsigned long long word = 0;
    for (int k = size - 1; k >= 0; --k) word = word << 8 | bytes[k];
    return word;
}

/* SHA-256, FIPS 180-4. */
typedef struct {
    unsigned int state[8];
    unsigned char block[64];
    unsigned long long length;
} uplift_hash;

static const unsigned int uplift_round_constants[64] = {
${constants}};

static unsigned int uplift_turn(unsigned int x, int bits)
{
    return x >> bits | x << (32 - bits);
}

static void uplift_hash_block(uplift_hash *hash, const unsigned char *block)
{
    unsigned int words[64], s[8];
    for (int k = 0; k < 16; ++k)
        words[k] = UPLIFT_CAST(unsigned int, block[4 * k]) << 24 | UPLIFT_CAST(unsigned int, block[4 * k + 1]) << 16
            | UPLIFT_CAST(unsigned int, block[4 * k + 2]) << 8 | block[4 * k + 3];
    for (int k = 16; k < 64; ++k) {
        unsigned int low = words[k - 15], high = words[k - 2];
        low = uplift_turn(low, 7) ^ uplift_turn(low, 18) ^ low >> 3;
        high = uplift_turn(high, 17) ^ uplift_turn(high, 19) ^ high >> 10;
        words[k] = words[k - 16] + low + words[k - 7] + high;
    }
    memcpy(s, hash->state, sizeof s);
    for (int k = 0; k < 64; ++k) {
        unsigned int choice = (s[4] & s[5]) ^ (~s[4] & s[6]);
        unsigned int majority = (s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]);
        unsigned int first = uplift_turn(s[4], 6) ^ uplift_turn(s[4], 11) ^ uplift_turn(s[4], 25);
        unsigned int second = uplift_turn(s[0], 2) ^ uplift_turn(s[0], 13) ^ uplift_turn(s[0], 22);
        first += s[7] + choice + uplift_round_constants[k] + words[k];
        second += majority;
        memmove(s + 1, s, 7 * sizeof *s);
        s[4] += first;
        s[0] = first + second;
    }
    for (int k = 0; k < 8; ++k) hash->state[k] += s[k];
}

static void uplift_hash_start(uplift_hash *hash)
{
    static const unsigned int start[8] = {
${start}};
    memcpy(hash->state, start, sizeof start);
    hash->length = 0;
}

static void uplift_hash_add(uplift_hash *hash, const unsigned char *bytes, size_t size)
{
    size_t held = UPLIFT_CAST(size_t, hash->length % 64);
    hash->length += size;
    while (size > 0) {
        size_t count = size < 64 - held ? size : 64 - held;
        if (held == 0 && count == 64) {
            uplift_hash_block(hash, bytes);
        } else {
            memcpy(hash->block + held, bytes, count);
            if (held + count == 64) uplift_hash_block(hash, hash->block);
        }
        held = (held + count) % 64;
        bytes += count;
        size -= count;
    }
}

/* Set the 64 hexadecimal digits of the hash. */
static void uplift_hash_end(uplift_hash *hash, char digits[64])
{
    unsigned char end[72] = {0x80};
    size_t padding = 1 + UPLIFT_CAST(size_t, (119 - hash->length % 64) % 64);
    unsigned long long bits = hash->length * 8;
    for (int k = 0; k < 8; ++k) end[padding + 7 - UPLIFT_CAST(size_t, k)] = UPLIFT_CAST(unsigned char, bits >> 8 * k & 255);
    uplift_hash_add(hash, end, padding + 8);
    for (int k = 0; k < 64; ++k) digits[k] = "0123456789abcdef"[hash->state[k / 8] >> (28 - 4 * (k % 8)) & 15];
}

/* JSON: a position in a text that is read value by value. `failed` stays set after the first mistake, and the position
   at the end. */
typedef struct {
    const char *at, *end;
    int failed;
} uplift_json;

/* A string between its quotes, as it is written. */
typedef struct {
    const char *text;
    size_t length;
} uplift_string;

static int uplift_is(uplift_string string, const char *word)
{
    return string.length == strlen(word) && memcmp(string.text, word, string.length) == 0;
}

static void uplift_fail(uplift_json *json)
{
    json->failed = 1;
    json->at = json->end;
}

/* The next character after blanks, 0 at the end. */
static char uplift_peek(uplift_json *json)
{
    while (json->at < json->end && (*json->at == ' ' || *json->at == '\t' || *json->at == '\n' || *json->at == '\r'))
        json->at += 1;
    return UPLIFT_CAST(char, json->at < json->end ? *json->at : 0);
}

/* Whether a character comes next; it is then read. */
static int uplift_take(uplift_json *json, char character)
{
    if (uplift_peek(json) != character) return 0;
    json->at += json->at < json->end;
    return !json->failed;
}

static void uplift_expect(uplift_json *json, char character)
{
    if (!uplift_take(json, character)) uplift_fail(json);
}

static uplift_string uplift_read_string(uplift_json *json)
{
    uplift_string string = {"", 0};
    const char *start;
    uplift_expect(json, '"');
    start = json->at;
    while (json->at < json->end && *json->at != '"') {
        if (UPLIFT_CAST(unsigned char, *json->at) < 32) uplift_fail(json);
        else json->at += *json->at == '\\' && json->end - json->at > 1 ? 2 : 1;
    }
    if (json->at < json->end) {
        string.text = start;
        string.length = UPLIFT_CAST(size_t, json->at - start);
    }
    uplift_expect(json, '"');
    return string;
}

/* Begin the next key of a table, or the next item of a list, after its opening bracket; 0 after the last one. */
static int uplift_next(uplift_json *json, int *count, char closing)
{
    if (uplift_take(json, closing)) return 0;
    if (*count > 0) uplift_expect(json, ',');
    *count += !json->failed;
    return !json->failed;
}

static uplift_string uplift_read_key(uplift_json *json)
{
    uplift_string key = uplift_read_string(json);
    uplift_expect(json, ':');
    return key;
}

/* A number, whatever the locale: strtod is not used. */
static double uplift_read_number(uplift_json *json)
{
    double value = 0, scale = 1;
    int digits = 0, exponent = 0, stated = 0, is_negative, is_shrinking;
    uplift_peek(json);
    is_negative = uplift_take(json, '-');
    for (; json->at < json->end && *json->at >= '0' && *json->at <= '9'; ++json->at, ++digits)
        value = value * 10 + (*json->at - '0');
    if (json->at < json->end && *json->at == '.')
        for (++json->at; json->at < json->end && *json->at >= '0' && *json->at <= '9'; ++json->at, ++digits)
            if (value < 1e17) {
                value = value * 10 + (*json->at - '0');
                exponent -= 1;
            }
    if (digits == 0 || digits > 400) uplift_fail(json);
    if (json->at < json->end && (*json->at == 'e' || *json->at == 'E')) {
        json->at += 1;
        is_shrinking = json->at < json->end && *json->at == '-';
        json->at += json->at < json->end && (*json->at == '-' || *json->at == '+');
        for (; json->at < json->end && *json->at >= '0' && *json->at <= '9'; ++json->at)
            stated = stated < 1000 ? stated * 10 + (*json->at - '0') : stated;
        exponent += is_shrinking ? -stated : stated;
    }
    for (int k = exponent < 0 ? -exponent : exponent; k > 0 && scale < 1e300; --k) scale *= 10;
    value = exponent < 0 ? value / scale : value * scale;
    return is_negative ? -value : value;
}

/* A whole number from 0 to 2^53. */
static long long uplift_read_size(uplift_json *json)
{
    double value = uplift_read_number(json);
    long long size = value >= 0 && value <= 9007199254740992.0 ? UPLIFT_CAST(long long, value) : -1;
    if (UPLIFT_CAST(double, size) != value) uplift_fail(json);
    return json->failed ? 0 : size;
}

/* Read a value of any type. */
static void uplift_skip(uplift_json *json, int depth)
{
    static const char *const words[] = {"true", "false", "null"};
    int count = 0;
    char next = uplift_peek(json);
    if (depth == 0) {
        uplift_fail(json);
    } else if (next == '{') {
        json->at += 1;
        while (uplift_next(json, &count, '}')) {
            uplift_read_key(json);
            uplift_skip(json, depth - 1);
        }
    } else if (next == '[') {
        json->at += 1;
        while (uplift_next(json, &count, ']')) uplift_skip(json, depth - 1);
    } else if (next == '"') {
        uplift_read_string(json);
    } else if (next == '-' || (next >= '0' && next <= '9')) {
        uplift_read_number(json);
    } else {
        for (int k = 0; k < 3; ++k) {
            size_t length = strlen(words[k]);
            if (UPLIFT_CAST(size_t, json->end - json->at) >= length && memcmp(json->at, words[k], length) == 0) {
                json->at += length;
                return;
            }
        }
        uplift_fail(json);
    }
}

/* The value of a key in a table, or a position that has failed. */
static uplift_json uplift_member(uplift_json table, const char *key)
{
    int count = 0;
    uplift_expect(&table, '{');
    while (uplift_next(&table, &count, '}')) {
        if (uplift_is(uplift_read_key(&table), key)) return table;
        uplift_skip(&table, UPLIFT_DEPTH);
    }
    uplift_fail(&table);
    return table;
}

/* Values of keys in a table: empty, 0 or no items where there is none of this type. */
static uplift_string uplift_string_of(uplift_json table, const char *key)
{
    uplift_json value = uplift_member(table, key);
    return uplift_read_string(&value);
}

static double uplift_number_of(uplift_json table, const char *key)
{
    uplift_json value = uplift_member(table, key);
    return uplift_read_number(&value);
}

static long long uplift_size_of(uplift_json table, const char *key)
{
    uplift_json value = uplift_member(table, key);
    return uplift_read_size(&value);
}

static int uplift_length_of(uplift_json table, const char *key)
{
    uplift_json list = uplift_member(table, key);
    int count = 0;
    uplift_expect(&list, '[');
    while (uplift_next(&list, &count, ']')) uplift_skip(&list, UPLIFT_DEPTH);
    return count;
}

static int uplift_hex(uplift_json *json)
{
    int value = 0;
    for (int k = 0; k < 4; ++k) {
        char c = UPLIFT_CAST(char, json->at < json->end ? *json->at++ : 0);
        int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
        if (digit < 0) uplift_fail(json);
        value = value * 16 + (digit < 0 ? 0 : digit);
    }
    return value;
}

/* Write the text that a string stands for, which is not longer; return its length, or 0 if an escape is not valid. */
static size_t uplift_unescape(uplift_string string, char *text)
{
    static const char escapes[] = "\"\\/bfnrt", characters[] = "\"\\/\b\f\n\r\t";
    uplift_json json = {string.text, string.text + string.length, 0};
    char *out = text;
    while (json.at < json.end) {
        char c = *json.at++;
        const char *escape;
        if (c != '\\') {
            *out++ = c;
            continue;
        }
        c = UPLIFT_CAST(char, json.at < json.end ? *json.at++ : 0);
        escape = c ? strchr(escapes, c) : NULL;
        if (escape) {
            *out++ = characters[escape - escapes];
        } else if (c == 'u') {
            int code = uplift_hex(&json);
            if (code >= 0xD800 && code < 0xDC00 && json.end - json.at > 1 && json.at[0] == '\\' && json.at[1] == 'u') {
                int low;
                json.at += 2;
                low = uplift_hex(&json);
                if (low < 0xDC00 || low > 0xDFFF) uplift_fail(&json);
                code = 0x10000 + (code - 0xD800) * 0x400 + (low & 0x3FF);
            } else if (code >= 0xD800 && code < 0xE000) {
                uplift_fail(&json);
            }
            if (code < 0x80) {
                *out++ = UPLIFT_CAST(char, code);
            } else if (code < 0x800) {
                *out++ = UPLIFT_CAST(char, 0xC0 | code >> 6);
            } else if (code < 0x10000) {
                *out++ = UPLIFT_CAST(char, 0xE0 | code >> 12);
                *out++ = UPLIFT_CAST(char, 0x80 | (code >> 6 & 0x3F));
            } else {
                *out++ = UPLIFT_CAST(char, 0xF0 | code >> 18);
                *out++ = UPLIFT_CAST(char, 0x80 | (code >> 12 & 0x3F));
                *out++ = UPLIFT_CAST(char, 0x80 | (code >> 6 & 0x3F));
            }
            if (code >= 0x80) *out++ = UPLIFT_CAST(char, 0x80 | (code & 0x3F));
        } else {
            uplift_fail(&json);
        }
    }
    return json.failed ? 0 : UPLIFT_CAST(size_t, out - text);
}
