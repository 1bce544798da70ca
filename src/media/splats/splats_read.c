/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading splats in the format that the first bytes identify. */
#include "config.h"

#include "media/kind.h"
#include "media/points/ply.h"
#include "media/splats/glb.h"
#include "media/splats/splats_ply.h"
#include "media/splats/spz.h"
#include "system/file.h"

#include <stdio.h>
#include <stdlib.h>

#define FILE_MAX ((uint64_t)8 << 30) /* bytes of a file that is read; chosen by hand, not measured */
#define BEGINNING 4 /* bytes that identify a format; definition (the longest magic number, of PLY, SPZ and GLB) */

int adcgs_splats_is(const char *path)
{
    uint8_t start[BEGINNING];
    FILE *file;
    if (adcgs_file_open(&file, path, NULL) != ADCGS_OK)
        return 0;
    const size_t n = fread(start, 1, sizeof start, file);
    fclose(file);
    return adcgs_ply_is(start, n) || adcgs_spz_is(start, n) || adcgs_glb_is(start, n);
}

/** Reduce colours whose harmonics are all zero to degree 0. */
static void drop_zeros(adcgs_splats *s)
{
    const size_t n = (size_t)s->n * 3 * (size_t)((s->degree + 1) * (s->degree + 1) - 1);
    for (size_t i = 0; i < n; i++)
        if (s->harmonics[i] != 0.0f)
            return;
    free(s->harmonics);
    s->harmonics = NULL;
    s->degree = 0;
}

adcgs_status adcgs_splats_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    *out = (adcgs_splats){0};
    const adcgs_status status = adcgs_ply_is(data, bytes)   ? adcgs_splats_parse_ply(out, data, bytes, path, error)
                                : adcgs_spz_is(data, bytes) ? adcgs_spz_parse(out, data, bytes, path, error)
                                : adcgs_glb_is(data, bytes)
                                    ? adcgs_glb_parse(out, data, bytes, path, error)
                                    : adcgs_fail(error, ADCGS_ERR_DATA, "%s: not splats, expected PLY, SPZ or GLB", path);
    if (status == ADCGS_OK)
        drop_zeros(out);
    else
        adcgs_splats_free(out);
    return status;
}

adcgs_status adcgs_splats_read(adcgs_splats *out, const char *path, adcgs_error *error)
{
    uint8_t *data;
    size_t bytes;
    *out = (adcgs_splats){0};
    ADCGS_TRY(adcgs_kind_check(path, ADCGS_WANT_SPLATS, error));
    ADCGS_TRY(adcgs_file_load(&data, &bytes, path, FILE_MAX, error));
    const adcgs_status status = adcgs_splats_parse(out, data, bytes, path, error);
    free(data);
    return status;
}
