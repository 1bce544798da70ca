/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Parsing PLY: a header that declares elements and their properties, then the
 * elements in that order, as text or binary.
 */
#include "config.h"

#include "media/points/ply.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define LINE_MAX_BYTES 1024 /* of a declaration; comments may be longer; chosen by hand, not measured */

static const struct {
    const char *name, *alias;
    int bytes;
} scalars[ADCGS_PLY_TYPES] = {{"char", "int8", 1}, {"uchar", "uint8", 1}, {"short", "int16", 2},   {"ushort", "uint16", 2},
                              {"int", "int32", 4}, {"uint", "uint32", 4}, {"float", "float32", 4}, {"double", "float64", 8}};

int adcgs_ply_is(const uint8_t *data, size_t bytes)
{
    return bytes >= 4 && !memcmp(data, "ply", 3) && (data[3] == '\n' || data[3] == '\r');
}

const char *adcgs_ply_type_name(adcgs_ply_type type)
{
    return scalars[type].name;
}

static adcgs_status bad_header(adcgs_ply *r, const char *what)
{
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: line %d: %s", r->path, r->line, what);
}

/* ---- The lines of a header ---- */

static int is_blank(uint8_t c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/** The line at `at` without surrounding white space. \return the start of the next line; NULL if the line has no end */
static const uint8_t *find_line(const adcgs_ply *r, const uint8_t *at, const uint8_t **line, size_t *n)
{
    const uint8_t *stop = memchr(at, r->line_end, (size_t)(r->end - at));
    const uint8_t *const next = stop ? stop + 1 : NULL;
    while (stop && stop > at && is_blank(stop[-1]))
        stop--;
    while (stop && stop > at && is_blank(*at))
        at++;
    *line = at;
    *n = stop ? (size_t)(stop - at) : 0;
    return next;
}

/** True if a line begins with a word; *behind: start of the text after it. */
static int has_word(const uint8_t *line, size_t n, const char *word, size_t *behind)
{
    *behind = strlen(word);
    if (n < *behind || memcmp(line, word, *behind) || (n > *behind && !is_blank(line[*behind])))
        return 0;
    while (*behind < n && is_blank(line[*behind]))
        ++*behind;
    return 1;
}

static int is_comment(const uint8_t *line, size_t n)
{
    size_t behind;
    return has_word(line, n, "comment", &behind) || has_word(line, n, "obj_info", &behind);
}

/** Next header line as text: "" for a comment, which may have any length and any bytes. */
static adcgs_status next_line(adcgs_ply *r, char *text)
{
    const uint8_t *line;
    size_t n;
    r->line++;
    r->at = find_line(r, r->at, &line, &n);
    if (!r->at) {
        r->at = r->end;
        return bad_header(r, "PLY header ends early");
    }
    *text = 0;
    if (is_comment(line, n))
        return ADCGS_OK;
    int is_text = n < LINE_MAX_BYTES;
    for (size_t i = 0; i < n && is_text; i++)
        is_text = (line[i] >= ' ' && line[i] != 0x7f) || is_blank(line[i]);
    if (!is_text)
        return bad_header(r, "malformed PLY header");
    memcpy(text, line, n);
    text[n] = 0;
    return ADCGS_OK;
}

int adcgs_ply_comment(const adcgs_ply *ply, const char **at, size_t *n)
{
    const uint8_t *next = *at ? find_line(ply, (const uint8_t *)*at, (const uint8_t **)at, n) : ply->header;
    const uint8_t *line;
    size_t behind;
    while (next && (next = find_line(ply, next, &line, n))) {
        if (has_word(line, *n, "end_header", &behind))
            return 0;
        if (!has_word(line, *n, "comment", &behind))
            continue;
        *at = (const char *)line + behind;
        *n -= behind;
        return 1;
    }
    return 0;
}

/* ---- Declarations ---- */

static int find_scalar(const char *name)
{
    for (int i = 0; i < ADCGS_PLY_TYPES; i++)
        if (!strcmp(name, scalars[i].name) || !strcmp(name, scalars[i].alias))
            return i;
    return -1;
}

static adcgs_status parse_property(adcgs_ply *r, const char *line, adcgs_ply_element *e)
{
    char type[16], count[16], item[16], name[sizeof e->properties[0].name] = "";
    if (e->n == ADCGS_PLY_PROPERTIES)
        return bad_header(r, "more than 1024 properties");
    adcgs_ply_property *p = &e->properties[e->n++];
    *p = (adcgs_ply_property){.role = -1};
    int kind, count_kind = ADCGS_PLY_INT8;
    if (sscanf(line, "property list %15s %15s %63s", count, item, name) == 3) {
        p->is_list = 1;
        kind = find_scalar(item);
        count_kind = find_scalar(count);
        if (count_kind > ADCGS_PLY_UINT32)
            return bad_header(r, "the count of a list must be an integer");
    } else if (sscanf(line, "property %15s %63s", type, name) == 2) {
        kind = find_scalar(type);
    } else
        return bad_header(r, "malformed property");
    memcpy(p->name, name, sizeof name);
    if (kind < 0 || count_kind < 0)
        return bad_header(r, "unknown type of a property");
    p->type = (adcgs_ply_type)kind;
    p->count_type = (adcgs_ply_type)count_kind;
    return ADCGS_OK;
}

static adcgs_status parse_format(adcgs_ply *r, const char *line)
{
    char name[32], version[8];
    if (sscanf(line, "format %31s %7s", name, version) != 2 || strcmp(version, "1.0"))
        return bad_header(r, "malformed format");
    if (!strcmp(name, "ascii"))
        r->form = ADCGS_PLY_ASCII;
    else if (!strcmp(name, "binary_little_endian"))
        r->form = ADCGS_PLY_LITTLE;
    else if (!strcmp(name, "binary_big_endian"))
        r->form = ADCGS_PLY_BIG;
    else
        return bad_header(r, "unknown format");
    return ADCGS_OK;
}

/* ---- Numbers ---- */

/** The number at r->at as an unsigned integer in host order. */
static uint64_t load_bytes(const adcgs_ply *r, int bytes)
{
    uint64_t value = 0;
    for (int i = 0; i < bytes; i++)
        value |= (uint64_t)r->at[r->form == ADCGS_PLY_BIG ? bytes - 1 - i : i] << 8 * i;
    return value;
}

static double convert(adcgs_ply_type type, uint64_t bits)
{
    switch (type) {
    case ADCGS_PLY_INT8:
        return (int8_t)(uint8_t)bits;
    case ADCGS_PLY_INT16:
        return (int16_t)(uint16_t)bits;
    case ADCGS_PLY_INT32:
        return (int32_t)(uint32_t)bits;
    case ADCGS_PLY_FLOAT32:
        return (double)adcgs_bits_float((uint32_t)bits);
    case ADCGS_PLY_FLOAT64:
        return adcgs_bits_double(bits);
    default:
        return (double)bits;
    }
}

/** Read one number of text, separated by white space. The data ends with a zero byte, where strtod() stops. */
static int read_text(adcgs_ply *r, double *out)
{
    while (r->at < r->end && isspace(*r->at)) {
        r->line += *r->at == '\n';
        r->at++;
    }
    char *stop;
    const char *start = (const char *)r->at;
    *out = strtod(start, &stop);
    if (stop == start || r->at == r->end)
        return -1;
    r->at = (const uint8_t *)stop;
    return r->at < r->end && !isspace(*r->at) ? -1 : 0;
}

static int read_number(adcgs_ply *r, adcgs_ply_type type, double *out)
{
    if (r->form == ADCGS_PLY_ASCII)
        return read_text(r, out);
    const int bytes = scalars[type].bytes;
    if (r->end - r->at < bytes)
        return -1;
    *out = convert(type, load_bytes(r, bytes));
    r->at += bytes;
    return 0;
}

static int skip_list(adcgs_ply *r, const adcgs_ply_property *p)
{
    double count, value;
    if (read_number(r, p->count_type, &count) || !(count >= 0.0 && count <= 1e9))
        return -1;
    const uint64_t n = (uint64_t)count;
    if (r->form != ADCGS_PLY_ASCII) {
        const uint64_t bytes = n * (uint64_t)scalars[p->type].bytes;
        if ((uint64_t)(r->end - r->at) < bytes)
            return -1;
        r->at += bytes;
        return 0;
    }
    for (uint64_t i = 0; i < n; i++)
        if (read_text(r, &value))
            return -1;
    return 0;
}

/** Read the items of an element: pass their numbers to take(), or skip them if it is NULL. */
static adcgs_status read_element(adcgs_ply *r, const adcgs_ply_element *e, adcgs_ply_take_fn take, void *user)
{
    for (uint64_t i = 0; i < e->count; i++)
        for (int j = 0; j < e->n; j++) {
            const adcgs_ply_property *p = &e->properties[j];
            double value = 0.0;
            if (p->is_list ? skip_list(r, p) : read_number(r, p->type, &value)) {
                if (r->form == ADCGS_PLY_ASCII && r->at < r->end)
                    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: line %d: expected a number", r->path, r->line);
                return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: ends in item %llu of %llu", r->path, (unsigned long long)i,
                                  (unsigned long long)e->count);
            }
            if (take && p->role >= 0)
                take(user, i, p, value);
        }
    return ADCGS_OK;
}

/** Check a count against the bytes left: each item takes at least one byte per property (text: and a separator). */
static adcgs_status check_count(adcgs_ply *r, const adcgs_ply_element *e)
{
    uint64_t least = 0;
    for (int j = 0; j < e->n; j++)
        least += r->form == ADCGS_PLY_ASCII
                     ? 2
                     : (uint64_t)scalars[e->properties[j].is_list ? e->properties[j].count_type : e->properties[j].type].bytes;
    if (e->count && (!least || e->count > ((uint64_t)(r->end - r->at) + 1) / least))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %llu items declared, but only %llu bytes follow", r->path,
                          (unsigned long long)e->count, (unsigned long long)(r->end - r->at));
    return ADCGS_OK;
}

/** The element that a line declares; NULL if there are too many. `after` holds an element that follows the vertices. */
static adcgs_ply_element *begin_element(adcgs_ply *r, const char *name, uint64_t count, int *has_vertex, adcgs_ply_element *after)
{
    adcgs_ply_element *e = after;
    if (!*has_vertex) {
        *has_vertex = !strcmp(name, "vertex");
        if (!*has_vertex && r->n_before == ADCGS_PLY_BEFORE)
            return NULL;
        e = *has_vertex ? &r->vertex : &r->before[r->n_before++];
    }
    e->count = count;
    e->n = 0;
    return e;
}

static adcgs_status parse_header(adcgs_ply *r)
{
    char line[LINE_MAX_BYTES], name[64];
    adcgs_ply_element *current = NULL, after;
    int has_format = 0, has_vertex = 0;
    ADCGS_TRY(next_line(r, line)); /* "ply" */
    for (;;) {
        ADCGS_TRY(next_line(r, line));
        unsigned long long count;
        if (!strcmp(line, "end_header"))
            break;
        if (!*line) /* a comment is empty, too */
            continue;
        if (!strncmp(line, "format ", 7)) {
            ADCGS_TRY(parse_format(r, line));
            has_format = 1;
        } else if (sscanf(line, "element %63s %20llu", name, &count) == 2) {
            current = begin_element(r, name, count, &has_vertex, &after);
            if (!current)
                return bad_header(r, "too many elements before the vertices");
        } else if (!strncmp(line, "property ", 9) && current)
            ADCGS_TRY(parse_property(r, line, current));
        else
            return bad_header(r, "malformed PLY header");
    }
    return has_format && has_vertex ? ADCGS_OK : bad_header(r, "PLY header without format or vertices");
}

/** Read the header and the elements before the vertices. */
static adcgs_status open_vertices(adcgs_ply *r)
{
    ADCGS_TRY(parse_header(r));
    for (int i = 0; i < r->n_before; i++) {
        ADCGS_TRY(check_count(r, &r->before[i]));
        ADCGS_TRY(read_element(r, &r->before[i], NULL, NULL));
    }
    return check_count(r, &r->vertex);
}

adcgs_status adcgs_ply_open(adcgs_ply **out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    adcgs_ply *ply = malloc(sizeof *ply);
    *out = NULL;
    if (!ply)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    ply->header = ply->at = data;
    ply->end = data + bytes;
    ply->line_end = bytes > 4 && data[3] == '\r' && data[4] != '\n' ? '\r' : '\n';
    ply->path = path;
    ply->error = error;
    ply->form = ADCGS_PLY_ASCII;
    ply->line = ply->n_before = 0;
    const adcgs_status status = open_vertices(ply);
    if (status != ADCGS_OK)
        adcgs_ply_close(&ply);
    *out = ply;
    return status;
}

void adcgs_ply_close(adcgs_ply **ply)
{
    free(*ply);
    *ply = NULL;
}

adcgs_ply_property *adcgs_ply_find(adcgs_ply *ply, const char *name)
{
    for (int j = 0; j < ply->vertex.n; j++)
        if (!ply->vertex.properties[j].is_list && !strcmp(ply->vertex.properties[j].name, name))
            return &ply->vertex.properties[j];
    return NULL;
}

adcgs_status adcgs_ply_vertices(adcgs_ply *ply, adcgs_ply_take_fn take, void *user)
{
    return read_element(ply, &ply->vertex, take, user);
}

adcgs_status adcgs_ply_survey(adcgs_ply *ply, adcgs_ply_take_fn take, void *user)
{
    const uint8_t *const at = ply->at;
    const int line = ply->line;
    const adcgs_status status = read_element(ply, &ply->vertex, take, user);
    ply->at = at;
    ply->line = line;
    return status;
}

void adcgs_ply_offset(const adcgs_ply *ply, double offset[3])
{
    const char *at = NULL;
    size_t n;
    offset[0] = offset[1] = offset[2] = 0.0;
    while (adcgs_ply_comment(ply, &at, &n)) {
        char text[128];
        double v[3];
        snprintf(text, sizeof text, "%.*s", (int)(n < sizeof text ? n : 0), at);
        if (sscanf(text, "offset %lf %lf %lf", &v[0], &v[1], &v[2]) == 3 && isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]))
            memcpy(offset, v, sizeof v);
    }
}
