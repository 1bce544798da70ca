/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The elements of a PLY file: their numbers, as text or binary. */
#include "config.h"

#include "media/points/ply_numbers.h"

#include <ctype.h>
#include <stdlib.h>

static const struct {
    const char *name, *alias;
    int bytes;
} scalars[ADCGS_PLY_TYPES] = {{"char", "int8", 1}, {"uchar", "uint8", 1}, {"short", "int16", 2},   {"ushort", "uint16", 2},
                              {"int", "int32", 4}, {"uint", "uint32", 4}, {"float", "float32", 4}, {"double", "float64", 8}};

const char *adcgs_ply_type_name(adcgs_ply_type type)
{
    return scalars[type].name;
}

int adcgs_ply_type_of(const char *name)
{
    for (int i = 0; i < ADCGS_PLY_TYPES; i++)
        if (!strcmp(name, scalars[i].name) || !strcmp(name, scalars[i].alias))
            return i;
    return -1;
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

adcgs_status adcgs_ply_read(adcgs_ply *r, const adcgs_ply_element *e, adcgs_ply_take_fn take, void *user)
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

/* Each item takes at least one byte per property; in text, also a separator. */
adcgs_status adcgs_ply_check_count(adcgs_ply *r, const adcgs_ply_element *e)
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

adcgs_status adcgs_ply_vertices(adcgs_ply *ply, adcgs_ply_take_fn take, void *user)
{
    return adcgs_ply_read(ply, &ply->vertex, take, user);
}

/** Read an element that begins at a position, and return to the current one. */
static adcgs_status read_at(adcgs_ply *ply, const adcgs_ply_element *e, const uint8_t *begin, int line, adcgs_ply_take_fn take,
                            void *user)
{
    const uint8_t *const at = ply->at;
    const int line_at = ply->line;
    ply->at = begin;
    ply->line = line;
    const adcgs_status status = adcgs_ply_read(ply, e, take, user);
    ply->at = at;
    ply->line = line_at;
    return status;
}

adcgs_status adcgs_ply_survey(adcgs_ply *ply, adcgs_ply_take_fn take, void *user)
{
    return read_at(ply, &ply->vertex, ply->at, ply->line, take, user);
}

adcgs_status adcgs_ply_items(adcgs_ply *ply, const adcgs_ply_element *element, adcgs_ply_take_fn take, void *user)
{
    if (element->at)
        return read_at(ply, element, element->at, element->line, take, user);
    ADCGS_TRY(adcgs_ply_check_count(ply, element));
    return adcgs_ply_read(ply, element, take, user);
}
