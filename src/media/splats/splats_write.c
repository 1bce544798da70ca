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
    int turns; /**< files have y up; splats with known axes are turned */
} formats[] = {{"ply", adcgs_splats_put_ply, 0}, {"spz", adcgs_spz_put, 1}, {"glb", adcgs_glb_put, 1}, {"sog", adcgs_sog_put, 1}};

#define FORMATS (sizeof formats / sizeof *formats)

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
    return ADCGS_OK;
}

/** The rotation from these axes to y up, a quarter or half turn about x: w and x of its quaternion. */
static void turn_of(double turn[2], int axes)
{
    turn[0] = axes == ADCGS_SPLATS_Z_UP ? 0.70710678118654752 : 0.0;
    turn[1] = axes == ADCGS_SPLATS_Z_UP ? -0.70710678118654752 : 1.0;
}

/** A turned copy, without harmonics, since no format writes them. */
static adcgs_status turn_up(adcgs_splats *out, const adcgs_splats *s, const char *path, adcgs_error *error)
{
    double t[2];
    ADCGS_TRY(adcgs_splats_alloc(out, s->n, path, error));
    turn_of(t, s->axes);
    for (uint32_t i = 0; i < s->n; i++) {
        const double q[4] = {(double)s->rotation[0][i], (double)s->rotation[1][i], (double)s->rotation[2][i],
                             (double)s->rotation[3][i]};
        const int quarter = s->axes == ADCGS_SPLATS_Z_UP;
        out->mean[0][i] = s->mean[0][i];
        out->mean[1][i] = quarter ? s->mean[2][i] : -s->mean[1][i];
        out->mean[2][i] = quarter ? -s->mean[1][i] : -s->mean[2][i];
        out->rotation[0][i] = (float)(t[0] * q[0] - t[1] * q[1]);
        out->rotation[1][i] = (float)(t[0] * q[1] + t[1] * q[0]);
        out->rotation[2][i] = (float)(t[0] * q[2] - t[1] * q[3]);
        out->rotation[3][i] = (float)(t[0] * q[3] + t[1] * q[2]);
        out->opacity[i] = s->opacity[i];
        for (int a = 0; a < 3; a++) {
            out->scale[a][i] = s->scale[a][i];
            out->colour[a][i] = s->colour[a][i];
        }
    }
    out->offset[0] = s->offset[0];
    out->offset[1] = s->axes == ADCGS_SPLATS_Z_UP ? s->offset[2] : -s->offset[1];
    out->offset[2] = s->axes == ADCGS_SPLATS_Z_UP ? -s->offset[1] : -s->offset[2];
    out->axes = ADCGS_SPLATS_Y_UP;
    out->antialiased = s->antialiased;
    return ADCGS_OK;
}

adcgs_status adcgs_splats_write(const adcgs_splats *splats, const adcgs_splats_style *style, const char *path, adcgs_error *error)
{
    adcgs_atomic atomic;
    adcgs_splats turned = {0};
    ADCGS_TRY(adcgs_splats_check_name(path, style, error));
    const size_t format = format_of(path);
    const int turns = formats[format].turns && (splats->axes == ADCGS_SPLATS_Z_UP || splats->axes == ADCGS_SPLATS_Y_DOWN);
    if (turns)
        ADCGS_TRY(turn_up(&turned, splats, path, error));
    adcgs_status status = adcgs_atomic_open(&atomic, path, error);
    if (status == ADCGS_OK) {
        status = formats[format].put(turns ? &turned : splats, style, atomic.file, path, error);
        if (status == ADCGS_OK)
            status = adcgs_atomic_commit(&atomic, error);
        else
            adcgs_atomic_abort(&atomic);
    }
    adcgs_splats_free(&turned);
    return status;
}
