/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing splats in the format of the file name's extension. */
#include "config.h"

#include "media/splats/glb.h"
#include "media/splats/sog.h"
#include "media/splats/splats_ply.h"
#include "media/splats/spz.h"
#include "system/atomic.h"
#include "system/extension.h"

#include <stdlib.h>
#include <strings.h>

typedef adcgs_status (*put_fn)(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                               adcgs_error *error);

static const struct {
    const char *extension;
    put_fn put;
    uint8_t axes; /**< SPZ and GLB define theirs; programs show PLY and SOG with y down */
} formats[] = {{"ply", adcgs_splats_put_ply, ADCGS_SPLATS_Y_DOWN},
               {"spz", adcgs_spz_put, ADCGS_SPLATS_Y_UP},
               {"glb", adcgs_glb_put, ADCGS_SPLATS_Y_UP},
               {"sog", adcgs_sog_put, ADCGS_SPLATS_Y_DOWN}};

#define SQRT_HALF 0.70710678118654752 /* cosine and sine of half a quarter turn; arithmetic */
#define FORMATS (sizeof formats / sizeof *formats)

/** Quarter turns about x from these axes to y up. */
static const int to_y_up[] =
    {[ADCGS_SPLATS_UP_UNKNOWN] = 0, [ADCGS_SPLATS_Y_UP] = 0, [ADCGS_SPLATS_Z_UP] = 3, [ADCGS_SPLATS_Y_DOWN] = 2};

/** Index of a file name's format; FORMATS for an unknown one. */
static size_t format_of(const char *path)
{
    size_t i = 0;
    while (i < FORMATS && strcasecmp(adcgs_extension(path), formats[i].extension))
        i++;
    return i;
}

adcgs_status adcgs_splats_check_name(const char *path, const adcgs_splats_style *style, adcgs_error *error)
{
    const size_t format = format_of(path);
    if (format == FORMATS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the name of splats must end in " ADCGS_SPLATS_NAMES, path);
    if (style->rest_degree && formats[format].put != adcgs_splats_put_ply)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: only PLY has f_rest_*", path);
    if (style->spz_version && formats[format].put != adcgs_spz_put)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: only SPZ has a version to choose", path);
    return ADCGS_OK;
}

uint8_t adcgs_splats_axes_for(const char *path, const adcgs_splats_style *style, uint8_t axes)
{
    const size_t format = format_of(path);
    if (axes == ADCGS_SPLATS_UP_UNKNOWN || style->axes == ADCGS_SPLATS_KEEP || format == FORMATS)
        return axes;
    return style->axes ? style->axes : formats[format].axes;
}

/** A point after this number of quarter turns about x. */
static void turn_point(double to[3], const double from[3], int quarters)
{
    const double y[4] = {from[1], -from[2], -from[1], from[2]}, z[4] = {from[2], from[1], -from[2], -from[1]};
    to[0] = from[0];
    to[1] = y[quarters];
    to[2] = z[quarters];
}

/** A copy turned by quarters about x, without harmonics, since no format writes them. */
static adcgs_status turn_copy(adcgs_splats *out, const adcgs_splats *s, int quarters, const char *path, adcgs_error *error)
{
    static const double turns[4][2] = {{1.0, 0.0}, {SQRT_HALF, SQRT_HALF}, {0.0, 1.0}, {SQRT_HALF, -SQRT_HALF}}; /* w, x */
    const double *const t = turns[quarters];
    ADCGS_TRY(adcgs_splats_alloc(out, s->n, path, error));
    for (uint32_t i = 0; i < s->n; i++) {
        const double q[4] = {(double)s->rotation[0][i], (double)s->rotation[1][i], (double)s->rotation[2][i],
                             (double)s->rotation[3][i]};
        const double mean[3] = {(double)s->mean[0][i], (double)s->mean[1][i], (double)s->mean[2][i]};
        double turned[3];
        turn_point(turned, mean, quarters);
        out->rotation[0][i] = (float)(t[0] * q[0] - t[1] * q[1]);
        out->rotation[1][i] = (float)(t[0] * q[1] + t[1] * q[0]);
        out->rotation[2][i] = (float)(t[0] * q[2] - t[1] * q[3]);
        out->rotation[3][i] = (float)(t[0] * q[3] + t[1] * q[2]);
        out->opacity[i] = s->opacity[i];
        for (int a = 0; a < 3; a++) {
            out->mean[a][i] = (float)turned[a];
            out->scale[a][i] = s->scale[a][i];
            out->colour[a][i] = s->colour[a][i];
        }
    }
    turn_point(out->offset, s->offset, quarters);
    out->antialiased = s->antialiased;
    return ADCGS_OK;
}

adcgs_status adcgs_splats_write(const adcgs_splats *splats, const adcgs_splats_style *style, const char *path, adcgs_error *error)
{
    adcgs_atomic atomic;
    adcgs_splats turned = {0};
    ADCGS_TRY(adcgs_splats_check_name(path, style, error));
    const size_t format = format_of(path);
    const uint8_t axes = adcgs_splats_axes_for(path, style, splats->axes);
    const int quarters = (4 + to_y_up[splats->axes] - to_y_up[axes]) % 4;
    if (quarters)
        ADCGS_TRY(turn_copy(&turned, splats, quarters, path, error));
    turned.axes = axes;
    adcgs_status status = adcgs_atomic_open(&atomic, path, error);
    if (status == ADCGS_OK) {
        status = formats[format].put(quarters ? &turned : splats, style, atomic.file, path, error);
        if (status == ADCGS_OK)
            status = adcgs_atomic_commit(&atomic, error);
        else
            adcgs_atomic_abort(&atomic);
    }
    adcgs_splats_free(&turned);
    return status;
}
