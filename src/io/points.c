/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Point clouds: memory, and who reads what. */
#include "config.h"

#include "io/points.h"

#include "io/atomic.h"
#include "io/file.h"

#include <math.h>
#include <stdlib.h>

#define FILE_MAX ((uint64_t)8 << 30)

adcgs_status adcgs_points_alloc(adcgs_points *points, uint64_t n, const char *path, adcgs_error *error)
{
    *points = (adcgs_points){0};
    if (n > ADCGS_POINTS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %llu points, expected at most %u", path, (unsigned long long)n,
                          ADCGS_POINTS_MAX);
    const size_t count = (size_t)n + !n;
    points->position = malloc(count * sizeof *points->position);
    points->colour = malloc(count * sizeof *points->colour);
    if (!points->position || !points->colour) {
        adcgs_points_free(points);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu points", path, (unsigned long long)n);
    }
    memset(points->colour, 128, count * sizeof *points->colour);
    points->n = (uint32_t)n;
    return ADCGS_OK;
}

void adcgs_points_free(adcgs_points *points)
{
    free(points->position);
    free(points->colour);
    *points = (adcgs_points){0};
}

static adcgs_status check_finite(const adcgs_points *points, const char *path, adcgs_error *error)
{
    for (uint32_t i = 0; i < points->n; i++)
        for (int a = 0; a < 3; a++)
            if (!isfinite(points->position[i][a]))
                return adcgs_fail(error, ADCGS_ERR_DATA, "%s: vertex %u: %c is not a finite number", path, i, "xyz"[a]);
    return ADCGS_OK;
}

adcgs_status adcgs_points_read(adcgs_points *out, const char *path, adcgs_error *error)
{
    *out = (adcgs_points){0};
    uint8_t *data;
    size_t bytes;
    ADCGS_TRY(adcgs_file_load(&data, &bytes, path, FILE_MAX, error));
    adcgs_status status;
    if (bytes >= 4 && !memcmp(data, "ply", 3) && (data[3] == '\n' || data[3] == '\r'))
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
    if (status != ADCGS_OK)
        adcgs_points_free(out);
    return status;
}

adcgs_status adcgs_ply_write(const adcgs_points *points, const char *path, adcgs_error *error)
{
    adcgs_atomic atomic;
    ADCGS_TRY(adcgs_atomic_open(&atomic, path, error));
    fprintf(atomic.file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %u\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
            points->n);
    for (uint32_t i = 0; i < points->n; i++) {
        uint8_t record[15];
        for (int a = 0; a < 3; a++)
            adcgs_store_le32(record + 4 * a, adcgs_float_bits(points->position[i][a]));
        memcpy(record + 12, points->colour[i], 3);
        fwrite(record, sizeof record, 1, atomic.file);
    }
    return adcgs_atomic_commit(&atomic, error);
}
