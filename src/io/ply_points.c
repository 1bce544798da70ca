/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Points in PLY files. */
#include "config.h"

#include "io/ply.h"
#include "io/points.h"

enum { X, Y, Z, RED, GREEN, BLUE, ROLES };

/** Convert to 8 bits; the maximum of an integer type, and 1 of a float type, is white. */
static uint8_t to_colour(adcgs_ply_type type, double value)
{
    static const double white[ADCGS_PLY_TYPES] = {127.0, 255.0, 32767.0, 65535.0, 2147483647.0, 4294967295.0, 1.0, 1.0};
    const double v = value / white[type];
    return (uint8_t)((v > 0.0 ? v < 1.0 ? v : 1.0 : 0.0) * 255.0 + 0.5);
}

static void take(void *user, uint64_t vertex, const adcgs_ply_property *property, double value)
{
    const adcgs_points *points = user;
    if (property->role <= Z)
        points->position[vertex][property->role] = value;
    else
        points->colour[vertex][property->role - RED] = to_colour(property->type, value);
}

/** Assign roles to properties. \return a bit for each role found */
static unsigned give_roles(adcgs_ply *ply)
{
    static const char *const names[ROLES] = {"x", "y", "z", "red", "green", "blue"};
    static const char *const aliases[ROLES] = {"x", "y", "z", "r", "g", "b"};
    unsigned roles = 0;
    for (int i = 0; i < ROLES; i++) {
        adcgs_ply_property *p = adcgs_ply_find(ply, names[i]);
        if (!p)
            p = adcgs_ply_find(ply, aliases[i]);
        if (p) {
            p->role = i;
            roles |= 1u << i;
        }
    }
    return roles;
}

static adcgs_status read_vertices(adcgs_ply *ply, adcgs_points *out)
{
    const unsigned roles = give_roles(ply);
    if ((roles & 7) != 7)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: the vertices have no x, y and z", ply->path);
    ADCGS_TRY(adcgs_points_alloc(out, ply->vertex.count, ply->path, ply->error));
    out->coloured = roles >> RED != 0;
    const adcgs_status status = adcgs_ply_vertices(ply, take, out);
    if (status != ADCGS_OK)
        adcgs_points_free(out);
    return status;
}

adcgs_status adcgs_ply_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    adcgs_ply *ply;
    *out = (adcgs_points){0};
    ADCGS_TRY(adcgs_ply_open(&ply, data, bytes, path, error));
    const adcgs_status status = read_vertices(ply, out);
    adcgs_ply_close(&ply);
    return status;
}
