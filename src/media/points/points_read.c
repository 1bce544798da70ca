/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading point clouds in any supported format. */
#include "config.h"

#include "media/kind.h"
#include "media/points/draco_shim.h"
#include "media/points/ply.h"
#include "media/points/points.h"
#include "media/splats/ply_packed.h"
#include "media/splats/splats.h"
#include "system/file.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define FILE_MAX ((uint64_t)8 << 30) /* bytes of a file that is read; chosen by hand, not measured */

static adcgs_status check_finite(const adcgs_points *points, const char *path, adcgs_error *error)
{
    for (uint32_t i = 0; i < points->n; i++)
        for (int a = 0; a < 3; a++)
            if (!(fabs(points->position[i][a]) <= (double)FLT_MAX))
                return adcgs_fail(error, ADCGS_ERR_DATA, "%s: vertex %u: %c is not a finite number", path, i, "xyz"[a]);
    return ADCGS_OK;
}

static uint8_t to_byte(float v)
{
    return (uint8_t)(255.0f * fminf(fmaxf(v, 0.0f), 1.0f) + 0.5f);
}

/** Take the centres of all splats, with the colours seen from any direction. */
static adcgs_status read_splats(adcgs_points *out, const char *path, adcgs_error *error)
{
    adcgs_splats s;
    ADCGS_TRY(adcgs_splats_read(&s, path, error));
    const adcgs_status status = adcgs_points_alloc(out, s.n, path, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < s.n; i++)
        for (int a = 0; a < 3; a++) {
            out->position[i][a] = s.offset[a] + (double)s.mean[a][i];
            out->colour[i][a] = to_byte(s.colour[a][i]);
        }
    out->coloured = status == ADCGS_OK;
    adcgs_splats_free(&s);
    return status;
}

/** True for PLY with plain positions, also of splats. */
static int is_plain_ply(const uint8_t *data, size_t bytes)
{
    if (!adcgs_ply_is(data, bytes))
        return 0;
    adcgs_ply *ply;
    if (adcgs_ply_open(&ply, data, bytes, "", NULL) != ADCGS_OK)
        return 1; /* its reader reports the error */
    const int is_packed = adcgs_ply_packed_is(ply);
    adcgs_ply_close(&ply);
    return !is_packed;
}

/** Read a file that is in memory. Formats of splats are read again by path, since they may consist of several files. */
static adcgs_status read_points(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    if (is_plain_ply(data, bytes))
        return adcgs_ply_parse(out, data, bytes, path, error);
    if (bytes >= 5 && !memcmp(data, "DRACO", 5))
        return adcgs_draco_parse(out, data, bytes, path, error);
    if (bytes >= 6 && !memcmp(data, "\x93NUMPY", 6))
        return adcgs_npy_parse(out, data, bytes, path, error);
    if (adcgs_ply_is(data, bytes) || adcgs_splats_is(path))
        return read_splats(out, path, error);
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no points, expected PLY, Draco, NPY or splats", path);
}

adcgs_status adcgs_points_read(adcgs_points *out, const char *path, adcgs_error *error)
{
    *out = (adcgs_points){0};
    uint8_t *data;
    size_t bytes;
    ADCGS_TRY(adcgs_kind_check(path, ADCGS_WANT_POINTS, error));
    ADCGS_TRY(adcgs_file_load(&data, &bytes, path, FILE_MAX, error));
    adcgs_status status = read_points(out, data, bytes, path, error);
    free(data);
    if (status == ADCGS_OK)
        status = check_finite(out, path, error);
    if (status == ADCGS_OK)
        adcgs_points_round(out);
    else
        adcgs_points_free(out);
    return status;
}

adcgs_status adcgs_draco_parse(adcgs_points *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    const adcgs_draco *draco;
    *out = (adcgs_points){0};
    ADCGS_TRY(adcgs_draco_get(&draco, path, error));
    return draco->parse(out, data, bytes, path, error);
}
