/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading point clouds in any supported format. */
#include "config.h"

#include "media/kind.h"
#include "media/points/draco_shim.h"
#include "media/points/ply.h"
#include "media/points/points.h"
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

adcgs_status adcgs_points_read(adcgs_points *out, const char *path, adcgs_error *error)
{
    *out = (adcgs_points){0};
    uint8_t *data;
    size_t bytes;
    ADCGS_TRY(adcgs_kind_check(path, ADCGS_WANT_POINTS, error));
    ADCGS_TRY(adcgs_file_load(&data, &bytes, path, FILE_MAX, error));
    adcgs_status status;
    if (adcgs_ply_is(data, bytes))
        status = adcgs_ply_parse(out, data, bytes, path, error);
    else if (bytes >= 5 && !memcmp(data, "DRACO", 5))
        status = adcgs_draco_parse(out, data, bytes, path, error);
    else if (bytes >= 6 && !memcmp(data, "\x93NUMPY", 6))
        status = adcgs_npy_parse(out, data, bytes, path, error);
    else
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: neither a PLY nor a Draco nor an NPY file", path);
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
