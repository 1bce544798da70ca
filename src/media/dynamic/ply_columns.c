/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Columns of a PLY file. */
#include "config.h"

#include "media/dynamic/ply_columns.h"

#include <ctype.h>

int adcgs_ply_declares(const uint8_t *data, size_t bytes, const char *property)
{
    const char *const end = strstr((const char *)data, "end_header"); /* a zero byte follows the data */
    const size_t n = strlen(property);
    for (const char *at = (const char *)data; (at = strstr(at, property)) && (!end || at < end); at += n)
        if ((size_t)(at - (const char *)data) + n <= bytes && at > (const char *)data && at[-1] == ' ' &&
            (isspace((unsigned char)at[n]) || !at[n]))
            return 1;
    return 0;
}

void adcgs_ply_splat_columns(adcgs_ply_column columns[ADCGS_PLY_SPLAT_COLUMNS], const adcgs_splats *s)
{
    const adcgs_ply_column all[ADCGS_PLY_SPLAT_COLUMNS] = {
        {"x", s->mean[0], 1},         {"y", s->mean[1], 1},         {"z", s->mean[2], 1},         {"f_dc_0", s->colour[0], 1},
        {"f_dc_1", s->colour[1], 1},  {"f_dc_2", s->colour[2], 1},  {"opacity", s->opacity, 1},   {"scale_0", s->scale[0], 1},
        {"scale_1", s->scale[1], 1},  {"scale_2", s->scale[2], 1},  {"rot_0", s->rotation[0], 1}, {"rot_1", s->rotation[1], 1},
        {"rot_2", s->rotation[2], 1}, {"rot_3", s->rotation[3], 1},
    };
    memcpy(columns, all, sizeof all);
}

static void take(void *user, uint64_t vertex, const adcgs_ply_property *property, double value)
{
    const adcgs_ply_column *const column = (const adcgs_ply_column *)user + property->role;
    column->to[vertex * column->stride] = (float)value;
}

adcgs_status adcgs_ply_find_columns(adcgs_ply *ply, const adcgs_ply_column *columns, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        adcgs_ply_property *const p = adcgs_ply_find(ply, columns[i].name);
        if (!p)
            return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: no property %s", ply->path, columns[i].name);
        if (p->type != ADCGS_PLY_FLOAT32 && p->type != ADCGS_PLY_FLOAT64)
            return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: the property %s is of type %s, expected float or double",
                              ply->path, columns[i].name, adcgs_ply_type_name(p->type));
        p->role = (int)i;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_ply_columns(adcgs_ply *ply, const adcgs_ply_column *columns, size_t n)
{
    ADCGS_TRY(adcgs_ply_find_columns(ply, columns, n));
    return adcgs_ply_vertices(ply, take, (void *)(uintptr_t)columns);
}
