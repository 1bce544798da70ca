/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing point clouds. */
#include "config.h"

#include "media/points/draco_shim.h"
#include "media/points/points.h"
#include "media/splats/offset.h"
#include "system/atomic.h"
#include "system/extension.h"

#include <stdlib.h>
#include <strings.h>

static adcgs_status write_ply(const adcgs_points *points, const double offset[3], const char *path, adcgs_error *error)
{
    adcgs_atomic atomic;
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    fputs("ply\nformat binary_little_endian 1.0\n", atomic.file);
    if (adcgs_offset_is(offset))
        fprintf(atomic.file, "comment offset %.17g %.17g %.17g\n", offset[0], offset[1], offset[2]);
    fprintf(atomic.file,
            "element vertex %u\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
            points->n);
    for (uint32_t i = 0; i < points->n; i++) {
        uint8_t record[15];
        for (int a = 0; a < 3; a++)
            adcgs_store_le32(record + 4 * a, adcgs_float_bits((float)points->position[i][a]));
        memcpy(record + 12, points->colour[i], 3);
        fwrite(record, sizeof record, 1, atomic.file);
    }
    return adcgs_atomic_commit(&atomic, error);
}

adcgs_status adcgs_ply_write(const adcgs_points *points, const char *path, adcgs_error *error)
{
    return write_ply(points, (const double[3]){0.0, 0.0, 0.0}, path, error);
}

adcgs_status adcgs_draco_write(const adcgs_points *points, const char *path, adcgs_error *error)
{
    const adcgs_draco *draco;
    uint8_t *data;
    size_t bytes;
    ADCGS_TRY(adcgs_draco_get(&draco, path, error));
    ADCGS_TRY(draco->encode(&data, &bytes, points, path, error));
    const adcgs_status status = adcgs_atomic_save(path, data, bytes, error);
    free(data);
    return status;
}

adcgs_status adcgs_points_write(const adcgs_points *points, const double offset[3], const char *path, adcgs_error *error)
{
    const char *const extension = adcgs_extension(path);
    if (!strcasecmp(extension, "ply"))
        return write_ply(points, offset, path, error);
    if (!strcasecmp(extension, "drc"))
        return adcgs_draco_write(points, path, error);
    return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the name of points must end in .ply or .drc", path);
}
