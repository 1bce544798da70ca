/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reading PLY: a header that declares elements and their properties, then the
 * elements in that order, as text or binary. Every count is held against the
 * bytes that are there before anything is allocated.
 */
#include "config.h"

#include "io/points.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PROPERTIES_MAX 256
#define LINE_MAX_BYTES 1024

typedef enum scalar { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, SCALARS } scalar;

static const struct {
    const char *name, *alias;
    int bytes;
} scalars[SCALARS] = {{"char", "int8", 1}, {"uchar", "uint8", 1}, {"short", "int16", 2},  {"ushort", "uint16", 2},
                      {"int", "int32", 4}, {"uint", "uint32", 4}, {"float", "float32", 4}, {"double", "float64", 8}};

typedef enum format { ASCII, LITTLE, BIG } format;

enum { ROLE_NONE = -1, ROLE_X, ROLE_Y, ROLE_Z, ROLE_RED, ROLE_GREEN, ROLE_BLUE, ROLES };

typedef struct property {
    scalar type;
    scalar count_type; /**< of a list */
    int is_list;
    int role;
} property;

typedef struct element {
    uint64_t count;
    int n;
    int is_vertex;
    property properties[PROPERTIES_MAX];
} element;

typedef struct reader {
    const uint8_t *at, *end;
    const char *path;
    adcgs_error *error;
    format form;
    int line;
} reader;

static adcgs_status bad_header(reader *r, const char *what)
{
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: line %d: %s", r->path, r->line, what);
}

/** Next header line without its end, as text. */
static adcgs_status next_line(reader *r, char *line)
{
    size_t n = 0;
    r->line++;
    while (r->at < r->end && *r->at != '\n') {
        const uint8_t c = *r->at++;
        if (c == '\r')
            continue;
        if (n + 1 >= LINE_MAX_BYTES || c < 0x09 || c > 0x7e)
            return bad_header(r, "malformed PLY header");
        line[n++] = (char)c;
    }
    if (r->at == r->end)
        return bad_header(r, "PLY header ends early");
    r->at++;
    line[n] = 0;
    return ADCGS_OK;
}

static int find_scalar(const char *name)
{
    for (int i = 0; i < SCALARS; i++)
        if (!strcmp(name, scalars[i].name) || !strcmp(name, scalars[i].alias))
            return i;
    return -1;
}

static int find_role(const char *name)
{
    static const char *const names[ROLES] = {"x", "y", "z", "red", "green", "blue"};
    static const char *const aliases[ROLES] = {"x", "y", "z", "r", "g", "b"};
    for (int i = 0; i < ROLES; i++)
        if (!strcmp(name, names[i]) || !strcmp(name, aliases[i]))
            return i;
    return ROLE_NONE;
}

static adcgs_status parse_property(reader *r, const char *line, element *e)
{
    char type[16], count[16], item[16], name[64];
    if (e->n == PROPERTIES_MAX)
        return bad_header(r, "more than 256 properties");
    property *p = &e->properties[e->n++];
    *p = (property){.role = ROLE_NONE};
    int kind, count_kind = INT8;
    if (sscanf(line, "property list %15s %15s %63s", count, item, name) == 3) {
        p->is_list = 1;
        kind = find_scalar(item);
        count_kind = find_scalar(count);
        if (count_kind > UINT32)
            return bad_header(r, "the count of a list must be an integer");
    } else if (sscanf(line, "property %15s %63s", type, name) == 2) {
        kind = find_scalar(type);
        p->role = e->is_vertex ? find_role(name) : ROLE_NONE;
    } else
        return bad_header(r, "malformed property");
    if (kind < 0 || count_kind < 0)
        return bad_header(r, "unknown type of a property");
    p->type = (scalar)kind;
    p->count_type = (scalar)count_kind;
    return ADCGS_OK;
}

static adcgs_status parse_format(reader *r, const char *line)
{
    char name[32], version[8];
    if (sscanf(line, "format %31s %7s", name, version) != 2 || strcmp(version, "1.0"))
        return bad_header(r, "malformed format");
    if (!strcmp(name, "ascii"))
        r->form = ASCII;
    else if (!strcmp(name, "binary_little_endian"))
        r->form = LITTLE;
    else if (!strcmp(name, "binary_big_endian"))
        r->form = BIG;
    else
        return bad_header(r, "unknown format");
    return ADCGS_OK;
}

/** Bytes of a number at r->at as an unsigned integer in host order. */
static uint64_t load(const reader *r, int bytes)
{
    uint64_t value = 0;
    for (int i = 0; i < bytes; i++)
        value |= (uint64_t)r->at[r->form == BIG ? bytes - 1 - i : i] << 8 * i;
    return value;
}

static double convert(scalar type, uint64_t bits)
{
    switch (type) {
    case INT8:
        return (int8_t)(uint8_t)bits;
    case INT16:
        return (int16_t)(uint16_t)bits;
    case INT32:
        return (int32_t)(uint32_t)bits;
    case FLOAT32:
        return (double)adcgs_bits_float((uint32_t)bits);
    case FLOAT64:
        return adcgs_bits_double(bits);
    default:
        return (double)bits;
    }
}

/** One number of text; white space separates. The data ends with a zero byte, where strtod() stops. */
static int read_text(reader *r, double *out)
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

static int read_number(reader *r, scalar type, double *out)
{
    if (r->form == ASCII)
        return read_text(r, out);
    const int bytes = scalars[type].bytes;
    if (r->end - r->at < bytes)
        return -1;
    *out = convert(type, load(r, bytes));
    r->at += bytes;
    return 0;
}

static int skip_list(reader *r, const property *p)
{
    double count, value;
    if (read_number(r, p->count_type, &count) || !(count >= 0.0 && count <= 1e9))
        return -1;
    const uint64_t n = (uint64_t)count;
    if (r->form != ASCII) {
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

/** Full range of the type is white. */
static uint8_t to_colour(scalar type, double value)
{
    static const double white[SCALARS] = {127.0, 255.0, 32767.0, 65535.0, 2147483647.0, 4294967295.0, 1.0, 1.0};
    const double v = value / white[type];
    return (uint8_t)((v > 0.0 ? v < 1.0 ? v : 1.0 : 0.0) * 255.0 + 0.5);
}

/** Read or, with no points, skip the items of an element. */
static adcgs_status read_element(reader *r, const element *e, adcgs_points *points)
{
    for (uint64_t i = 0; i < e->count; i++)
        for (int j = 0; j < e->n; j++) {
            const property *p = &e->properties[j];
            double value = 0.0;
            if (p->is_list ? skip_list(r, p) : read_number(r, p->type, &value)) {
                if (r->form == ASCII && r->at < r->end)
                    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: line %d: expected a number", r->path, r->line);
                return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: ends in item %llu of %llu", r->path, (unsigned long long)i,
                                  (unsigned long long)e->count);
            }
            if (!points || p->role == ROLE_NONE)
                continue;
            if (p->role <= ROLE_Z)
                points->position[i][p->role] = (float)value;
            else
                points->colour[i][p->role - ROLE_RED] = to_colour(p->type, value);
        }
    return ADCGS_OK;
}

/** Each item costs at least a byte per property (text: and a separator), so a count can be held against what is left. */
static adcgs_status check_count(reader *r, const element *e)
{
    uint64_t least = 0;
    for (int j = 0; j < e->n; j++)
        least += r->form == ASCII ? 2 : (uint64_t)scalars[e->properties[j].is_list ? e->properties[j].count_type
                                                                                    : e->properties[j].type].bytes;
    if (e->count && (!least || e->count > ((uint64_t)(r->end - r->at) + 1) / least))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %llu items declared, but only %llu bytes follow", r->path,
                          (unsigned long long)e->count, (unsigned long long)(r->end - r->at));
    return ADCGS_OK;
}

static adcgs_status read_vertices(reader *r, const element *e, adcgs_points *out)
{
    unsigned roles = 0;
    for (int j = 0; j < e->n; j++)
        if (e->properties[j].role != ROLE_NONE)
            roles |= 1u << e->properties[j].role;
    if ((roles & 7) != 7)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: the vertices have no x, y and z", r->path);
    ADCGS_TRY(adcgs_points_alloc(out, e->count, r->path, r->error));
    out->coloured = roles >> ROLE_RED != 0;
    const adcgs_status status = read_element(r, e, out);
    if (status != ADCGS_OK)
        adcgs_points_free(out);
    return status;
}

/** The header, up to and with the vertex element; elements before it are returned in `before`. */
static adcgs_status parse_header(reader *r, element *vertex, element *before, int *n_before, int max_before)
{
    char line[LINE_MAX_BYTES], name[64];
    element *current = NULL, after;
    int has_format = 0, has_vertex = 0;
    ADCGS_TRY(next_line(r, line)); /* "ply" */
    for (;;) {
        ADCGS_TRY(next_line(r, line));
        unsigned long long count;
        if (!strcmp(line, "end_header"))
            break;
        if (!strncmp(line, "comment", 7) || !strncmp(line, "obj_info", 8) || !*line)
            continue;
        if (!strncmp(line, "format ", 7)) {
            ADCGS_TRY(parse_format(r, line));
            has_format = 1;
        } else if (sscanf(line, "element %63s %20llu", name, &count) == 2) {
            const int is_vertex = !strcmp(name, "vertex") && !has_vertex;
            if (!is_vertex && !has_vertex && *n_before == max_before)
                return bad_header(r, "too many elements before the vertices");
            current = is_vertex ? vertex : has_vertex ? &after : &before[(*n_before)++];
            has_vertex |= is_vertex;
            current->count = count;
            current->n = 0;
            current->is_vertex = is_vertex;
        } else if (!strncmp(line, "property ", 9) && current)
            ADCGS_TRY(parse_property(r, line, current));
        else
            return bad_header(r, "malformed PLY header");
    }
    return has_format && has_vertex ? ADCGS_OK : bad_header(r, "PLY header without format or vertices");
}

#define BEFORE_MAX 4

typedef struct elements {
    element vertex, before[BEFORE_MAX];
    int n_before;
} elements;

adcgs_status adcgs_ply_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    *out = (adcgs_points){0};
    reader r = {.at = data, .end = data + bytes, .path = path, .error = error};
    elements *all = malloc(sizeof *all);
    if (!all)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    all->n_before = 0;
    adcgs_status status = parse_header(&r, &all->vertex, all->before, &all->n_before, BEFORE_MAX);
    for (int i = 0; i < all->n_before && status == ADCGS_OK; i++) {
        status = check_count(&r, &all->before[i]);
        if (status == ADCGS_OK)
            status = read_element(&r, &all->before[i], NULL);
    }
    if (status == ADCGS_OK)
        status = check_count(&r, &all->vertex);
    if (status == ADCGS_OK)
        status = read_vertices(&r, &all->vertex, out);
    free(all);
    return status;
}
