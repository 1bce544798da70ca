/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Points in PLY files. */
#include "config.h"

#include "media/points/ply.h"
#include "media/points/points.h"
#include "media/splats/splats.h"

enum { X, Y, Z, RED, GREEN, BLUE, ROLES, DC = ROLES }; /* DC, DC + 1, DC + 2: colours of splats */

/* Largest value of float colours, relative to white at 1; larger ones mean that 255 is white. Chosen by hand, not measured. */
#define BRIGHT 8.0

typedef struct taker {
    adcgs_points *points;
    double offset[3];
    double most; /**< largest value of all colours, in the file's units */
} taker;

/** The value of white: the maximum of an integer type, or 255 or 65535 if no colour of a wide type is larger; else 1 or 255. */
static double find_white(adcgs_ply_type type, double most)
{
    static const double whites[ADCGS_PLY_TYPES] = {127.0, 255.0, 32767.0, 65535.0, 2147483647.0, 4294967295.0, 1.0, 1.0};
    if (type == ADCGS_PLY_FLOAT32 || type == ADCGS_PLY_FLOAT64)
        return most > BRIGHT ? 255.0 : 1.0;
    if (type < ADCGS_PLY_INT16)
        return whites[type];
    return most <= 255.0 ? 255.0 : most <= 65535.0 && whites[type] > 65535.0 ? 65535.0 : whites[type];
}

static uint8_t to_colour(double v)
{
    return (uint8_t)((v > 0.0 ? v < 1.0 ? v : 1.0 : 0.0) * 255.0 + 0.5);
}

static void find_most(void *user, uint64_t vertex, const adcgs_ply_property *property, double value)
{
    taker *t = user;
    if (property->role >= RED && value > t->most)
        t->most = value;
}

static void set_property(void *user, uint64_t vertex, const adcgs_ply_property *property, double value)
{
    const taker *t = user;
    if (property->role <= Z)
        t->points->position[vertex][property->role] = t->offset[property->role] + value;
    else
        t->points->colour[vertex][property->role % 3] =
            to_colour(property->role >= DC ? 0.5 + ADCGS_SPLATS_DC * value : value / find_white(property->type, t->most));
}

/** Assign roles to properties. \return a bit for each role found */
static unsigned give_roles(adcgs_ply *ply)
{
    static const char *const names[ROLES] = {"x", "y", "z", "red", "green", "blue"};
    static const char *const aliases[][ROLES] = {{"x", "y", "z", "r", "g", "b"},
                                                 {"x", "y", "z", "diffuse_red", "diffuse_green", "diffuse_blue"},
                                                 {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2"}};
    unsigned roles = 0;
    for (int i = 0; i < ROLES; i++) {
        adcgs_ply_property *p = adcgs_ply_find(ply, names[i]);
        for (size_t k = 0; !p && k < ADCGS_COUNTOF(aliases); k++)
            if ((p = adcgs_ply_find(ply, aliases[k][i])) && k == 2 && i >= RED)
                p->role = DC + i - RED;
        if (p) {
            p->role = p->role < 0 ? i : p->role;
            roles |= 1u << i;
        }
    }
    return roles;
}

/** True if the range of all colours decides which value is white; that of 8 bits and of splats' colours is fixed. */
static int has_wide_colours(const adcgs_ply *ply)
{
    for (int i = 0; i < ply->vertex.n; i++) {
        const adcgs_ply_property *const p = &ply->vertex.properties[i];
        if (p->role >= RED && p->role < DC && p->type >= ADCGS_PLY_INT16)
            return 1;
    }
    return 0;
}

static adcgs_status read_vertices(adcgs_ply *ply, adcgs_points *out)
{
    const unsigned roles = give_roles(ply);
    if ((roles & 7) != 7)
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: the vertices have no x, y and z", ply->path);
    ADCGS_TRY(adcgs_points_alloc(out, ply->vertex.count, ply->path, ply->error));
    out->coloured = roles >> RED != 0;
    taker t = {.points = out};
    adcgs_ply_offset(ply, t.offset);
    adcgs_status status = has_wide_colours(ply) ? adcgs_ply_survey(ply, find_most, &t) : ADCGS_OK;
    if (status == ADCGS_OK)
        status = adcgs_ply_vertices(ply, set_property, &t);
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
