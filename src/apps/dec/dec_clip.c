/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --splats: one file of splats for a whole range of times. */
#include "config.h"

#include "apps/dec/dec_clip.h"

#include "media/dynamic/splat_paths.h"
#include "system/interrupt.h"
#include "system/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

/* Origin: chosen by hand, not measured. */
#define MEMORY ((size_t)256 << 20) /* bytes of samples at a time */
#define TOLERANCE 0.002            /* error of positions in scene units, about a pixel of an image of the whole scene */
#define CAMERAS_MAX 32             /* stored cameras in a file, at most */

/** Formats by the end of the file name. */
static const struct {
    const char *end;
    adcgs_piece_form form;
} formats[] = {{".ftgs.ply", ADCGS_PIECE_LINEAR}, {".splatv", ADCGS_PIECE_CUBIC}};

/** Index of the format; ADCGS_COUNTOF(formats) for another one. */
static size_t format_of(const char *target)
{
    const size_t n = strlen(target);
    size_t i = 0;
    while (i < ADCGS_COUNTOF(formats) &&
           (n < strlen(formats[i].end) || strcasecmp(target + n - strlen(formats[i].end), formats[i].end)))
        i++;
    return i;
}

int adcgs_dec_clip_is(const char *target)
{
    return format_of(target) < ADCGS_COUNTOF(formats);
}

/** One writing of a clip. */
typedef struct clip {
    adcgs_decoder *decoder;
    const adcgs_camera_path *frames;
    const char *target;
    adcgs_dec_rows rows;
    adcgs_pieces pieces;
} clip;

/** Samples the rows first..first+paths->n of a span. */
static adcgs_status sample(const clip *c, const adcgs_dec_span *span, uint32_t first, const adcgs_splat_paths *paths,
                           adcgs_error *error)
{
    for (uint32_t f = 0; f < paths->frames; f++) {
        adcgs_primitives p;
        ADCGS_TRY(adcgs_dec_rows_at(span, c->decoder, c->frames->frame[paths->first + f].time, &p, c->target, error));
        for (uint32_t i = 0; i < span->slots; i++) {
            const uint32_t row = span->row[i];
            if (row == ADCGS_DEC_NO_ROW || row < first || row - first >= paths->n)
                continue;
            adcgs_path_sample *const s = &paths->sample[(size_t)(row - first) * paths->frames + f];
            adcgs_splats one = {.n = 1, .opacity = &s->opacity};
            for (int a = 0; a < 4; a++)
                one.rotation[a] = &s->rotation[a];
            for (int a = 0; a < 3; a++) {
                one.mean[a] = &s->mean[a];
                one.scale[a] = &s->scale[a];
                one.colour[a] = &s->colour[a];
            }
            if (!adcgs_splats_take_one(&one, 0, &p, i, c->rows.origin, c->rows.scale))
                s->opacity = 0.0f;
        }
    }
    return ADCGS_OK;
}

/** Fits the rows of a span in parts, for which the memory suffices. */
static adcgs_status fit_span(clip *c, const adcgs_dec_span *span, adcgs_piece_form form, adcgs_error *error)
{
    const uint32_t total = span->begin.n;
    const size_t bytes = (size_t)span->frames * sizeof(adcgs_path_sample);
    const uint32_t part = (uint32_t)ADCGS_MIN(ADCGS_MAX(MEMORY / bytes, 1), (size_t)total);
    adcgs_path_sample *const samples = malloc((size_t)part * bytes + 1);
    adcgs_status status = samples ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", c->target);
    for (uint32_t first = 0; first < total && status == ADCGS_OK && !adcgs_interrupted(); first += part) {
        const adcgs_splat_paths paths = {.n = ADCGS_MIN(part, total - first),
                                         .clip = (uint32_t)c->frames->n,
                                         .first = (uint32_t)span->first,
                                         .frames = (uint32_t)span->frames,
                                         .tolerance = TOLERANCE * c->rows.scale,
                                         .sample = samples};
        status = sample(c, span, first, &paths, error);
        if (status == ADCGS_OK)
            status = adcgs_pieces_add(&c->pieces, &paths, form, c->target, error);
    }
    free(samples);
    return status;
}

/** Cameras of viewers: the stored ones. */
static adcgs_status write_splatv(const clip *c, const adcgs_info *info, adcgs_error *error)
{
    adcgs_camera camera[CAMERAS_MAX];
    const int n = ADCGS_MIN(info->cameras, CAMERAS_MAX);
    for (int i = 0; i < n; i++)
        ADCGS_TRY(adcgs_get_camera(c->decoder, i, &camera[i], error));
    if (n)
        return adcgs_splatv_write(&c->pieces, camera, n, c->target, error);
    return adcgs_splatv_write(&c->pieces, &c->frames->frame[0].camera, c->frames->frame[0].camera.width > 0, c->target, error);
}

static adcgs_status make(clip *c, const adcgs_info *info, adcgs_piece_form form, adcgs_error *error)
{
    char comment[128];
    ADCGS_TRY(adcgs_dec_rows_find(&c->rows, c->decoder, info, c->frames, c->target, error));
    memcpy(c->pieces.offset, c->rows.offset, sizeof c->pieces.offset);
    c->pieces.clip = (uint32_t)c->frames->n;
    for (size_t i = 0; i < c->rows.n; i++)
        ADCGS_TRY(fit_span(c, &c->rows.span[i], form, error));
    if (adcgs_interrupted())
        return ADCGS_OK;
    snprintf(comment, sizeof comment, "adcgs %s, %g frames/s from %.9g s", PACKAGE_VERSION, c->frames->frame_rate,
             c->frames->frame[0].time);
    return form == ADCGS_PIECE_CUBIC ? write_splatv(c, info, error) : adcgs_ftgs_write(&c->pieces, comment, c->target, error);
}

adcgs_status adcgs_dec_clip_write(const adcgs_cli *cli, adcgs_decoder *decoder, const adcgs_info *info,
                                  const adcgs_camera_path *frames, const char *input, const char *target, adcgs_error *error)
{
    clip c = {.decoder = decoder, .frames = frames, .target = target};
    const adcgs_status status = make(&c, info, formats[format_of(target)].form, error);
    if (status == ADCGS_OK && !adcgs_interrupted())
        adcgs_cli_note(
            cli,
            "%s: 1 file, %d frames at %g frames/s: %u rows for %u splats; %u splat%s above the tolerance, the worst %.1f "
            "times",
            input, frames->n, frames->frame_rate, c.pieces.n, c.rows.total, c.pieces.above, adcgs_s((uint64_t)c.pieces.above),
            c.pieces.worst);
    free(c.pieces.piece);
    adcgs_dec_rows_free(&c.rows);
    return status;
}
