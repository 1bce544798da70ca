/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reading splats in the format that the first bytes identify. */
#include "config.h"

#include "media/arrays/zip_read.h"
#include "media/kind.h"
#include "media/points/ply.h"
#include "media/splats/dot_splat.h"
#include "media/splats/glb.h"
#include "media/splats/ksplat.h"
#include "media/splats/sog.h"
#include "media/splats/splat_look.h"
#include "media/splats/splats_ply.h"
#include "media/splats/spz.h"
#include "system/file.h"

#include <stdio.h>
#include <stdlib.h>

#define FILE_MAX ((uint64_t)8 << 30) /* bytes of a file that is read; chosen by hand, not measured */

typedef adcgs_status (*parse_fn)(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

/** The reader of a file of `size` bytes that begins with n bytes; NULL for an unknown format. */
static parse_fn find_reader(const uint8_t *data, size_t n, uint64_t size)
{
    return adcgs_ply_is(data, n)               ? adcgs_splats_parse_ply
           : adcgs_spz_is(data, n)             ? adcgs_spz_parse
           : adcgs_glb_is(data, n)             ? adcgs_glb_parse
           : adcgs_zip_is(data, n)             ? adcgs_sog_parse
           : adcgs_ksplat_is(data, n, size)    ? adcgs_ksplat_parse
           : adcgs_dot_splat_is(data, n, size) ? adcgs_dot_splat_parse
                                               : NULL;
}

int adcgs_splats_is(const char *path)
{
    const adcgs_kind *const kind = adcgs_kind_at(path);
    return kind->class == ADCGS_KIND_SPLATS && kind->is_read;
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

/** Complete splats that have been read, or clear them after a failure. */
static void finish(adcgs_splats *out, adcgs_status status)
{
    if (status == ADCGS_OK)
        drop_zeros(out);
    else
        adcgs_splats_free(out);
}

adcgs_status adcgs_splats_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    *out = (adcgs_splats){0};
    const parse_fn parse = find_reader(data, bytes, bytes);
    const adcgs_status status = parse ? parse(out, data, bytes, path, error)
                                      : adcgs_fail(error, ADCGS_ERR_DATA, "%s: not splats, expected " ADCGS_SPLATS_FORMATS, path);
    finish(out, status);
    return status;
}

adcgs_status adcgs_splats_read(adcgs_splats *out, const char *path, adcgs_error *error)
{
    uint8_t *data;
    size_t bytes;
    *out = (adcgs_splats){0};
    ADCGS_TRY(adcgs_kind_check(path, ADCGS_WANT_SPLATS, error));
    ADCGS_TRY(adcgs_file_load(&data, &bytes, path, FILE_MAX, error));
    adcgs_status status;
    if (adcgs_sog_meta_is(data, bytes)) {
        status = adcgs_sog_parse_meta(out, data, bytes, path, error);
        finish(out, status);
    } else
        status = adcgs_splats_parse(out, data, bytes, path, error);
    free(data);
    return status;
}
