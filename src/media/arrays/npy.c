/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reading NPY: a magic number, the length of a header, a header with the text
 * of a Python dictionary, the numbers. Only tables with the expected number of
 * columns are accepted; for any other file the error states the reason.
 */
#include "config.h"

#include "media/arrays/npy.h"
#include "media/points/points.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define MAGIC_BYTES 6                 /* bytes before the version; definition (numpy.lib.format) */
#define DIMENSIONS_MAX 4              /* dimensions of an array */
#define COUNT_MAX ((uint64_t)1 << 40) /* upper bound of one dimension; no file is that large */

/* Bits of the keys that the header had; definition, the keys are those of numpy.lib.format. */
enum { SEEN_DESCR = 1, SEEN_ORDER = 2, SEEN_SHAPE = 4, SEEN_ALL = 7 };

typedef struct reader {
    const char *at, *end; /**< of the header */
    const char *path;
    adcgs_error *error;
    int seen;
    int item_bytes; /**< 4 or 8 */
    int n_dimensions;
    uint64_t shape[DIMENSIONS_MAX];
} reader;

static adcgs_status bad(const reader *r, const char *key, const char *what)
{
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: header: %s%s%s", r->path, key, *key ? ": " : "", what);
}

static void skip_blanks(reader *r)
{
    while (r->at < r->end && (*r->at == ' ' || *r->at == '\n'))
        r->at++;
}

/** Take the next character, after blanks, if it is c. */
static int accept_char(reader *r, char c)
{
    skip_blanks(r);
    if (r->at == r->end || *r->at != c)
        return 0;
    r->at++;
    return 1;
}

/** Take a word that comes next, after blanks. */
static int take_word(reader *r, const char *word)
{
    const size_t n = strlen(word);
    skip_blanks(r);
    if ((size_t)(r->end - r->at) < n || memcmp(r->at, word, n))
        return 0;
    r->at += n;
    return 1;
}

/** Take a string in single or double quotes, without escapes. */
static int take_string(reader *r, char text[16])
{
    skip_blanks(r);
    if (r->at == r->end || (*r->at != '\'' && *r->at != '"'))
        return 0;
    const char quote = *r->at++;
    for (int i = 0; i < 16 && r->at < r->end; i++) {
        text[i] = *r->at++;
        if (text[i] == quote) {
            text[i] = 0;
            return 1;
        }
    }
    return 0;
}

static adcgs_status read_descr(reader *r)
{
    char text[16];
    if (!take_string(r, text))
        return bad(r, "descr", "expected a string");
    if (strcmp(text, "<f4") && strcmp(text, "<f8"))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: header: descr: %.16s, expected <f4 or <f8", r->path, text);
    r->item_bytes = text[2] - '0';
    return ADCGS_OK;
}

static adcgs_status read_order(reader *r)
{
    if (take_word(r, "True"))
        return bad(r, "fortran_order", "True, expected False");
    return take_word(r, "False") ? ADCGS_OK : bad(r, "fortran_order", "expected False");
}

static adcgs_status read_shape(reader *r)
{
    const char *expected = "expected a tuple of whole numbers";
    if (!accept_char(r, '('))
        return bad(r, "shape", expected);
    while (!accept_char(r, ')')) {
        uint64_t value = 0;
        const char *first = r->at;
        for (; r->at < r->end && *r->at >= '0' && *r->at <= '9' && value < COUNT_MAX; r->at++)
            value = 10 * value + (uint64_t)(*r->at - '0');
        if (r->at == first || r->n_dimensions == DIMENSIONS_MAX || value >= COUNT_MAX)
            return bad(r, "shape", expected);
        r->shape[r->n_dimensions++] = value;
        skip_blanks(r);
        if (!accept_char(r, ',') && (r->at == r->end || *r->at != ')'))
            return bad(r, "shape", expected);
    }
    return ADCGS_OK;
}

static adcgs_status read_item(reader *r)
{
    static const struct {
        const char *key;
        adcgs_status (*read)(reader *);
    } items[] = {{"descr", read_descr}, {"fortran_order", read_order}, {"shape", read_shape}};
    char key[16];
    if (!take_string(r, key))
        return bad(r, "", "expected a key in quotes");
    for (int i = 0; i < (int)ADCGS_COUNTOF(items); i++)
        if (!strcmp(key, items[i].key)) {
            if (r->seen & 1 << i)
                return bad(r, key, "given twice");
            r->seen |= 1 << i;
            return accept_char(r, ':') ? items[i].read(r) : bad(r, key, "expected a colon");
        }
    return bad(r, key, "unknown key");
}

static adcgs_status read_dictionary(reader *r)
{
    if (!accept_char(r, '{'))
        return bad(r, "", "expected a dictionary");
    while (!accept_char(r, '}')) {
        ADCGS_TRY(read_item(r));
        skip_blanks(r);
        if (!accept_char(r, ',') && (r->at == r->end || *r->at != '}'))
            return bad(r, "", "expected a comma or the end of the dictionary");
    }
    skip_blanks(r);
    if (r->at != r->end)
        return bad(r, "", "something follows the dictionary");
    if (r->seen != SEEN_ALL)
        return bad(r, r->seen & SEEN_DESCR ? r->seen & SEEN_ORDER ? "shape" : "fortran_order" : "descr", "missing");
    return ADCGS_OK;
}

/** Find the header's text; its position depends on the format's version. */
static adcgs_status find_header(reader *r, const uint8_t *data, size_t bytes)
{
    const size_t fixed = MAGIC_BYTES + 2;
    if (bytes < fixed + 4)
        return bad(r, "", "the file ends early");
    if (data[MAGIC_BYTES] < 1 || data[MAGIC_BYTES] > 3 || data[MAGIC_BYTES + 1] != 0)
        return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: NPY format %d.%d, expected 1.0, 2.0 or 3.0", r->path,
                          data[MAGIC_BYTES], data[MAGIC_BYTES + 1]);
    const int is_short = data[MAGIC_BYTES] == 1;
    const size_t begin = fixed + (is_short ? 2 : 4);
    const size_t length = is_short ? adcgs_load_le16(data + fixed) : adcgs_load_le32(data + fixed);
    if (length > bytes - begin)
        return bad(r, "", "the file ends early");
    r->at = (const char *)data + begin;
    r->end = r->at + length;
    return ADCGS_OK;
}

/** Read the header; *found: number of bytes behind it. */
static adcgs_status read_header(reader *r, const uint8_t *data, size_t bytes, uint64_t *found)
{
    if (bytes < MAGIC_BYTES || memcmp(data, "\x93NUMPY", MAGIC_BYTES))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: not an NPY file", r->path);
    ADCGS_TRY(find_header(r, data, bytes));
    ADCGS_TRY(read_dictionary(r));
    *found = bytes - (size_t)((const uint8_t *)r->end - data);
    return ADCGS_OK;
}

static adcgs_status set_table(adcgs_npy *out, const reader *r, uint64_t rows, uint32_t columns, uint64_t found, const char *what)
{
    const uint64_t expected = rows * columns * (uint64_t)r->item_bytes;
    if (found != expected)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %llu bytes behind the header, expected %llu for %llu %s", r->path,
                          (unsigned long long)found, (unsigned long long)expected, (unsigned long long)rows, what);
    *out = (adcgs_npy){.rows = rows, .columns = columns, .item_bytes = r->item_bytes, .numbers = (const uint8_t *)r->end};
    return ADCGS_OK;
}

adcgs_status adcgs_npy_open(adcgs_npy *out, const uint8_t *data, size_t bytes, uint32_t columns, const char *what,
                            const char *path, adcgs_error *error)
{
    reader r = {.path = path, .error = error};
    uint64_t found;
    *out = (adcgs_npy){0};
    ADCGS_TRY(read_header(&r, data, bytes, &found));
    if (r.n_dimensions != 2 || r.shape[1] != columns)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: header: shape: expected (n, %u)", path, columns);
    return set_table(out, &r, r.shape[0], columns, found, what);
}

adcgs_status adcgs_npy_open_frames(adcgs_npy *out, uint64_t *frames, const uint8_t *data, size_t bytes, uint32_t columns,
                                   const char *path, adcgs_error *error)
{
    reader r = {.path = path, .error = error};
    uint64_t found;
    *out = (adcgs_npy){0};
    ADCGS_TRY(read_header(&r, data, bytes, &found));
    if (r.n_dimensions != 3 || r.shape[2] != columns)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: header: shape: expected (frames, n, %u)", path, columns);
    *frames = r.shape[0];
    if (r.shape[1] && *frames >= COUNT_MAX / r.shape[1])
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: header: shape: %llu frames of %llu rows, expected fewer than 2^40 rows",
                          path, (unsigned long long)*frames, (unsigned long long)r.shape[1]);
    return set_table(out, &r, *frames * r.shape[1], columns, found, "rows");
}

double adcgs_npy_value(const adcgs_npy *table, size_t row, uint32_t column)
{
    const uint8_t *p = table->numbers + (row * table->columns + column) * (size_t)table->item_bytes;
    return table->item_bytes == 4 ? (double)adcgs_bits_float(adcgs_load_le32(p)) : adcgs_bits_double(adcgs_load_le64(p));
}

adcgs_status adcgs_npy_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    adcgs_npy table;
    *out = (adcgs_points){0};
    ADCGS_TRY(adcgs_npy_open(&table, data, bytes, 3, "points", path, error));
    ADCGS_TRY(adcgs_points_alloc(out, table.rows, path, error));
    for (uint32_t i = 0; i < out->n; i++)
        for (uint32_t a = 0; a < 3; a++)
            out->position[i][a] = adcgs_npy_value(&table, i, a);
    return ADCGS_OK;
}
