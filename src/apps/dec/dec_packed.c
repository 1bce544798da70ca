/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --splats: one file of splats with the values of all frames. */
#include "config.h"

#include "apps/dec/dec_packed.h"

#include "media/dynamic/fourdgs_write.h"
#include "media/dynamic/splat4d_write.h"
#include "system/extension.h"
#include "system/interrupt.h"

#include <stdlib.h>
#include <strings.h>

/* Origin: chosen by hand, not measured. */
#define MEMORY ((uint64_t)4 << 30) /* bytes of all frames' splats, at most */
#define HIDDEN 1e-6f               /* opacity below which a row is hidden; dec_rows.c gives hidden rows less */
#define SPLAT_BYTES 56u            /* bytes of a splat without harmonics; arithmetic: 14 numbers */

int adcgs_dec_packed_is(const char *target)
{
    return !strcasecmp(adcgs_extension(target), "splat4d") || !strcasecmp(adcgs_extension(target), "4dgs");
}

/** Copies the rows of a frame to user[frame]. */
static adcgs_status keep_frame(void *user, int frame, const adcgs_splats *rows, adcgs_error *error)
{
    adcgs_splats *const out = (adcgs_splats *)user + frame;
    ADCGS_TRY(adcgs_splats_copy(out, rows, "splats", error));
    for (uint32_t row = 0; row < out->n; row++)
        if (out->opacity[row] < HIDDEN)
            out->opacity[row] = 0.0f;
    return ADCGS_OK;
}

static adcgs_status write_rows(const adcgs_dec_rows *rows, adcgs_decoder *decoder, const adcgs_camera_path *frames,
                               const char *target, adcgs_error *error)
{
    if ((uint64_t)rows->total * (uint64_t)frames->n > MEMORY / SPLAT_BYTES)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "%s: %u splats in %d frames need over 4 GiB: give a shorter --time A:B", target,
                          rows->total, frames->n);
    adcgs_splats *const all = calloc((size_t)frames->n, sizeof *all);
    if (!all)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", target);
    adcgs_status status = adcgs_dec_rows_each(rows, decoder, frames, target, keep_frame, all, error);
    const adcgs_splat_clip clip = {.frames = all, .n_frames = (uint32_t)frames->n, .fps = frames->frame_rate};
    if (status == ADCGS_OK && !adcgs_interrupted())
        status = strcasecmp(adcgs_extension(target), "4dgs") ? adcgs_splat4d_write(&clip, target, error)
                                                             : adcgs_fourdgs_write(&clip, target, error);
    for (int i = 0; i < frames->n; i++)
        adcgs_splats_free(&all[i]);
    free(all);
    return status;
}

adcgs_status adcgs_dec_packed_write(uint32_t *n, adcgs_decoder *decoder, const adcgs_info *info, const adcgs_camera_path *frames,
                                    const char *target, adcgs_error *error)
{
    adcgs_dec_rows rows;
    adcgs_status status = adcgs_dec_rows_find(&rows, decoder, info, frames, target, error);
    *n = rows.total;
    if (status == ADCGS_OK && !adcgs_interrupted())
        status = write_rows(&rows, decoder, frames, target, error);
    adcgs_dec_rows_free(&rows);
    return status;
}
