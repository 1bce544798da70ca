/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reads TSOG version 4 (OpsiClear): SOG with images of times. Time runs from 0 to 1. A timeline of type 0 is discrete: a splat is
 * shown in one of N frames, each of which lasts 1 / N; states have the splats that are shown. One of type 1 is continuous:
 * positions are linear in time, opacities fade with a half in the exponent. Without a timeline the splats are static.
 */
#include "config.h"

#include "media/arrays/zip_read.h"
#include "media/dynamic/motion.h"
#include "media/dynamic/dynamic_readers.h"
#include "media/dynamic/tsog_meta.h"
#include "media/image/webp.h"
#include "media/splats/sog.h"
#include "media/splats/splat_set.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define IMAGE_MAX ((uint64_t)1 << 30) /* bytes of an image's file */
#define SPARE 65536                   /* pixels that images may have beyond twice the splats */
#define SIGMA_MIN 1e-8                /* shortest duration, of the clip's; a stored 0 is raised to it */

typedef struct state {
    adcgs_motion motion; /**< discrete: only the splats */
    uint16_t *frame;     /**< [n] frames of discrete splats; else NULL */
} state;

typedef struct reader {
    adcgs_dynamic *dynamic;
    adcgs_error *error;
    adcgs_zip_archive zip;
    adcgs_tsog_meta meta;
    adcgs_splats splats;
} reader;

static int is_tsog(const uint8_t *data, size_t bytes)
{
    adcgs_zip_archive zip;
    uint8_t *text = NULL;
    size_t n = 0;
    const int found = adcgs_zip_is(data, bytes) && adcgs_zip_open(&zip, data, bytes, "", NULL) == ADCGS_OK &&
                      adcgs_zip_unpack(&text, &n, &zip, "meta.json", ADCGS_TSOG_TEXT_MAX, NULL) == ADCGS_OK &&
                      adcgs_tsog_meta_is(text, n);
    free(text);
    return found;
}

/* ---- Images of times ---- */

static adcgs_status load_image(const reader *r, adcgs_webp *out, const char *name)
{
    const uint32_t n = r->splats.n;
    uint8_t *packed;
    size_t bytes;
    ADCGS_TRY(adcgs_zip_unpack(&packed, &bytes, &r->zip, name, IMAGE_MAX, r->error));
    const adcgs_status status = adcgs_webp_parse(out, packed, bytes, 2 * (uint64_t)n + SPARE, r->zip.path, name, r->error);
    free(packed);
    if (status == ADCGS_OK && (uint64_t)out->width * (uint64_t)out->height < n)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s: %dx%d pixels, expected one for each of %u splats", r->zip.path, name,
                          out->width, out->height, n);
    return status;
}

/** Values of 8 or 16 bits of each splat in the first channels: [n][channels], from free(). */
static adcgs_status load_values(const reader *r, const adcgs_tsog_image *image, size_t channels, uint16_t **out)
{
    adcgs_webp parts[2] = {{0}};
    adcgs_status status = ADCGS_OK;
    for (int k = 0; k < image->n && status == ADCGS_OK; k++)
        status = load_image(r, &parts[k], image->name[k]);
    *out = status == ADCGS_OK ? malloc(r->splats.n * channels * sizeof **out) : NULL;
    if (status == ADCGS_OK && !*out)
        status = adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", r->zip.path, r->splats.n);
    for (size_t i = 0; *out && i < r->splats.n * channels; i++) {
        const size_t byte = i / channels * 4 + i % channels;
        (*out)[i] = (uint16_t)(parts[0].pixels[byte] | (image->n > 1 ? parts[1].pixels[byte] << 8 : 0));
    }
    adcgs_webp_clear(&parts[0]);
    adcgs_webp_clear(&parts[1]);
    return status;
}

/** A stored value between its channel's bounds. */
static double spread(const adcgs_tsog_image *image, size_t channel, uint16_t value)
{
    const double low = image->low[channel], high = image->high[channel];
    return low + (high - low) * (value / (image->n > 1 ? 65535.0 : 255.0));
}

/* ---- Continuous ---- */

static adcgs_status take_times(const reader *r, adcgs_motion *m)
{
    uint16_t *values;
    ADCGS_TRY(load_values(r, &r->meta.timeline, 2, &values));
    for (uint32_t i = 0; i < r->splats.n; i++) {
        m->centre[i] = (float)spread(&r->meta.timeline, 0, values[2 * (size_t)i]);
        m->sigma[i] = (float)fmax(spread(&r->meta.timeline, 1, values[2 * (size_t)i + 1]), SIGMA_MIN);
    }
    free(values);
    return ADCGS_OK;
}

static adcgs_status take_velocities(const reader *r, adcgs_motion *m)
{
    uint16_t *values;
    ADCGS_TRY(load_values(r, &r->meta.velocity, 3, &values));
    for (uint32_t i = 0; i < r->splats.n; i++)
        for (size_t a = 0; a < 3; a++)
            m->motion[0][a][i] = (float)spread(&r->meta.velocity, a, values[3 * (size_t)i + a]);
    free(values);
    return ADCGS_OK;
}

/** Frames and rate: a stated duration is the unit of time. \return the unit, in seconds */
static double set_clock(reader *r)
{
    adcgs_dynamic *const d = r->dynamic;
    const double seconds = r->meta.seconds;
    adcgs_dynamic_set_clock(d, r->meta.rate, 0);
    if (!(seconds > 0.0) || d->options.frames)
        return ADCGS_MAX(d->frames - 1, 1) / adcgs_fps_value(d->rate);
    d->frames = (uint32_t)fmin(fmax(floor(seconds * adcgs_fps_value(d->rate) + 0.5), 1.0), ADCGS_DYNAMIC_FRAMES_MAX);
    return seconds;
}

static adcgs_status open_continuous(reader *r)
{
    adcgs_motion *const m = &((state *)r->dynamic->state)->motion;
    adcgs_splats base = r->splats;
    r->splats.block = r->splats.harmonics = NULL; /* n stays */
    ADCGS_TRY(adcgs_motion_take(m, &base, r->meta.velocity.n > 0, 0, r->zip.path, r->error));
    ADCGS_TRY(take_times(r, m));
    if (r->meta.velocity.n)
        ADCGS_TRY(take_velocities(r, m));
    adcgs_motion_stretch(m, set_clock(r));
    r->dynamic->n = m->base.n;
    r->dynamic->has_identity = r->dynamic->is_continuous = 1;
    return adcgs_motion_check(m, r->zip.path, r->error);
}

/* ---- Discrete and static ---- */

static uint32_t count_in_frame(const state *s, uint32_t frame)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->motion.base.n; i++)
        n += !s->frame || s->frame[i] == frame;
    return n;
}

/** Splats of one frame; without a timeline there is one frame, which has all of them. */
static adcgs_status open_discrete(reader *r)
{
    adcgs_dynamic *const d = r->dynamic;
    state *const s = d->state;
    const uint32_t frames = r->meta.kind == ADCGS_TSOG_DISCRETE ? r->meta.frames : 1;
    adcgs_fps rate = r->meta.rate;
    if (r->meta.seconds > 0.0)
        rate = adcgs_fps_of(fmin(fmax(frames / r->meta.seconds, ADCGS_FPS_MIN), ADCGS_FPS_MAX));
    adcgs_dynamic_set_clock(d, rate, 0);
    d->frames = frames; /* also if the options state a number */
    if (r->meta.kind == ADCGS_TSOG_DISCRETE) {
        ADCGS_TRY(load_values(r, &r->meta.timeline, 1, &s->frame));
        for (uint32_t i = 0; i < r->splats.n; i++)
            s->frame[i] = (uint16_t)ADCGS_MIN(s->frame[i] / r->meta.delta, frames - 1);
    }
    s->motion.base = r->splats;
    r->splats = (adcgs_splats){0};
    d->n = count_in_frame(s, 0);
    d->has_identity = r->meta.kind == ADCGS_TSOG_STATIC;
    return ADCGS_OK;
}

static void copy_splat(adcgs_splats *out, uint32_t to, const adcgs_splats *from, uint32_t i)
{
    const size_t each = 3 * (size_t)((from->degree + 1) * (from->degree + 1) - 1);
    for (int a = 0; a < 3; a++) {
        out->mean[a][to] = from->mean[a][i];
        out->scale[a][to] = from->scale[a][i];
        out->colour[a][to] = from->colour[a][i];
    }
    for (int a = 0; a < 4; a++)
        out->rotation[a][to] = from->rotation[a][i];
    out->opacity[to] = from->opacity[i];
    if (each)
        memcpy(out->harmonics + to * each, from->harmonics + i * each, each * sizeof *out->harmonics);
}

static adcgs_status copy_frame(const adcgs_dynamic *d, uint32_t frame, adcgs_splats *out, adcgs_error *error)
{
    const state *const s = d->state;
    const adcgs_splats *const from = &s->motion.base;
    uint32_t n = 0;
    ADCGS_TRY(adcgs_splats_alloc(out, count_in_frame(s, frame), d->path, error));
    out->antialiased = from->antialiased;
    ADCGS_TRY(adcgs_splats_add_harmonics(out, out->n ? from->degree : 0, d->path, error));
    for (uint32_t i = 0; i < from->n; i++)
        if (!s->frame || s->frame[i] == frame)
            copy_splat(out, n++, from, i);
    return ADCGS_OK;
}

/* ---- The reader ---- */

static adcgs_status read_archive(reader *r, const uint8_t *text, size_t bytes)
{
    adcgs_dynamic *const d = r->dynamic;
    ADCGS_TRY(adcgs_tsog_meta_parse(&r->meta, text, bytes, d->path, r->error));
    if (r->meta.has_sound)
        snprintf(d->remark, sizeof d->remark, "the sound of the file is not read");
    ADCGS_TRY(adcgs_sog_parse_timeless(&r->splats, &r->zip, text, bytes, r->error));
    return r->meta.kind == ADCGS_TSOG_CONTINUOUS ? open_continuous(r) : open_discrete(r);
}

static adcgs_status open_tsog(adcgs_dynamic *d, adcgs_error *error)
{
    reader r = {.dynamic = d, .error = error};
    uint8_t *text;
    size_t bytes;
    d->state = calloc(1, sizeof(state));
    if (!d->state)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", d->path);
    ADCGS_TRY(adcgs_zip_open(&r.zip, d->data, d->bytes, d->path, error));
    ADCGS_TRY(adcgs_zip_unpack(&text, &bytes, &r.zip, "meta.json", ADCGS_TSOG_TEXT_MAX, error));
    const adcgs_status status = read_archive(&r, text, bytes);
    adcgs_splats_free(&r.splats);
    free(text);
    return status;
}

static adcgs_status state_at(const adcgs_dynamic *d, double seconds, adcgs_splats *out, adcgs_error *error)
{
    const state *const s = d->state;
    return d->is_continuous ? adcgs_motion_at(&s->motion, seconds, out, d->path, error)
                            : copy_frame(d, adcgs_dynamic_frame(d, seconds), out, error);
}

static void close_tsog(adcgs_dynamic *d)
{
    state *const s = d->state;
    if (s) {
        adcgs_motion_free(&s->motion);
        free(s->frame);
    }
    free(s);
    d->state = NULL;
}

const adcgs_dynamic_reader adcgs_dynamic_tsog = {"TSOG", is_tsog, 0, open_tsog, state_at, close_tsog};
