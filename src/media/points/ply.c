/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Parsing PLY: a header that declares elements and their properties, then the
 * elements in that order, as text or binary.
 */
#include "config.h"

#include "media/points/ply_numbers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define LINE_MAX_BYTES 1024 /* of a declaration; comments may be longer; chosen by hand, not measured */

int adcgs_ply_is(const uint8_t *data, size_t bytes)
{
    return bytes >= 4 && !memcmp(data, "ply", 3) && (data[3] == '\n' || data[3] == '\r');
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
        kind = adcgs_ply_type_of(item);
        count_kind = adcgs_ply_type_of(count);
        if (count_kind > ADCGS_PLY_UINT32)
            return bad_header(r, "the count of a list must be an integer");
    } else if (sscanf(line, "property %15s %63s", type, name) == 2) {
        kind = adcgs_ply_type_of(type);
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

/* ---- The header ---- */

/** The element that a line declares; NULL if there are too many. `other` holds those that are not kept. */
static adcgs_ply_element *begin_element(adcgs_ply *r, const char *name, uint64_t count, adcgs_ply_element *other)
{
    adcgs_ply_element *e = other;
    if (!r->has_vertex) {
        r->has_vertex = !strcmp(name, "vertex");
        if (!r->has_vertex && r->n_before == ADCGS_PLY_BEFORE)
            return NULL;
        e = r->has_vertex ? &r->vertex : &r->before[r->n_before++];
    } else if (!r->has_after) {
        r->has_after = 1;
        e = &r->after;
    }
    snprintf(e->name, sizeof e->name, "%s", name);
    e->count = count;
    e->n = 0;
    e->at = NULL;
    return e;
}

static adcgs_status parse_header(adcgs_ply *r)
{
    char line[LINE_MAX_BYTES], name[64];
    adcgs_ply_element *current = NULL, other;
    int has_format = 0;
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
            current = begin_element(r, name, count, &other);
            if (!current)
                return bad_header(r, "too many elements before the vertices");
        } else if (!strncmp(line, "property ", 9) && current)
            ADCGS_TRY(parse_property(r, line, current));
        else
            return bad_header(r, "malformed PLY header");
    }
    return has_format && r->has_vertex ? ADCGS_OK : bad_header(r, "PLY header without format or vertices");
}

/** Read the header and the elements before the vertices. */
static adcgs_status open_vertices(adcgs_ply *r)
{
    ADCGS_TRY(parse_header(r));
    for (int i = 0; i < r->n_before; i++) {
        ADCGS_TRY(adcgs_ply_check_count(r, &r->before[i]));
        r->before[i].at = r->at;
        r->before[i].line = r->line;
        ADCGS_TRY(adcgs_ply_read(r, &r->before[i], NULL, NULL));
    }
    return adcgs_ply_check_count(r, &r->vertex);
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
    ply->line = ply->n_before = ply->has_vertex = ply->has_after = 0;
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

adcgs_ply_property *adcgs_ply_find_in(adcgs_ply_element *element, const char *name)
{
    for (int j = 0; j < element->n; j++)
        if (!element->properties[j].is_list && !strcmp(element->properties[j].name, name))
            return &element->properties[j];
    return NULL;
}

adcgs_ply_property *adcgs_ply_find(adcgs_ply *ply, const char *name)
{
    return adcgs_ply_find_in(&ply->vertex, name);
}

adcgs_ply_element *adcgs_ply_find_element(adcgs_ply *ply, const char *name)
{
    for (int i = 0; i < ply->n_before; i++)
        if (!strcmp(ply->before[i].name, name))
            return &ply->before[i];
    return ply->has_after && !strcmp(ply->after.name, name) ? &ply->after : NULL;
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
