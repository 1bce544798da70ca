/* SPDX-License-Identifier: BSD-2-Clause */
/** \file From a training run to a stream. */
#include "encode/encode.h"

#include "encode/quantise.h"
#include "encode/stored_cameras.h"
#include "model/inter.h"
#include "model/model_priv.h"
#include "render/render.h"
#include "stream/input.h"
#include "train/rate/levels.h"
#include "train/scene_frame.h"

#include <math.h>

#define PARTS_MAX 100000 /* ticks per frame, at most; chosen by hand, not measured */
/* Ticks: rounding error at which a time still counts as a whole number; arithmetic of binary64. */
#define TICK_WITHIN 1e-6

adcgs_status adcgs_encode_quantise_hook(const adcgs_fmodel *f, const adcgs_quantise_options *options, adcgs_error *error)
{
    adcgs_model model;
    const adcgs_status status = adcgs_quantise(&model, f, options, error);
    adcgs_model_clear(&model, NULL);
    return status;
}

/** Copies a string into memory that adcgs_stream_clear() frees. */
static char *copy_text(const char *text, adcgs_error *error)
{
    const size_t n = strlen(text) + 1;
    char *copy = adcgs_alloc(NULL, n, 1, error);
    if (copy)
        memcpy(copy, text, n);
    return copy;
}

static adcgs_status set_notes(adcgs_stream *s, const adcgs_encode_note *notes, uint32_t n, adcgs_error *error)
{
    s->meta = adcgs_alloc(NULL, n, sizeof *s->meta, error);
    for (uint32_t i = 0; s->meta && i < n; i++) {
        s->n_meta = i + 1;
        s->meta[i].key = copy_text(notes[i].key, error);
        s->meta[i].value = copy_text(notes[i].value, error);
        if (!s->meta[i].key || !s->meta[i].value)
            return adcgs_alloc_status(error);
    }
    return s->meta ? ADCGS_OK : adcgs_alloc_status(error);
}

/** True if the times are whole numbers of ticks, with `parts` ticks a frame. */
static int are_whole(const adcgs_scene *scene, const double *at, uint32_t n, uint32_t parts)
{
    for (uint32_t i = 0; i < n; i++) {
        const double ticks = at[i] * (double)scene->rate.num / (double)scene->rate.den * parts;
        if (fabs(ticks - rint(ticks)) > TICK_WITHIN)
            return 0;
    }
    return 1;
}

/** The time up to which a part's model is valid, crossfade included, in seconds. */
static double reach_of(const adcgs_cuts *cuts, uint32_t part)
{
    return cuts->at[part + 1] + (cuts->reach ? cuts->reach[part] : 0);
}

static int are_all_whole(const adcgs_scene *scene, const adcgs_cuts *cuts, uint32_t parts)
{
    int whole = are_whole(scene, cuts->at, cuts->n + 1, parts);
    for (uint32_t i = 0; i < cuts->n && whole; i++) {
        const double until = reach_of(cuts, i);
        whole = are_whole(scene, &until, 1, parts);
    }
    return whole;
}

/**
 * Makes a tick one frame, or the largest whole fraction of a frame in which the scene's duration, its cuts and the ends of
 * crossfades are whole numbers. Times are then exact for any offsets of the cameras.
 */
static void set_time(adcgs_stream *s, const adcgs_scene *scene, const adcgs_cuts *cuts)
{
    uint32_t parts = 1;
    s->rate_num = scene->rate.num;
    s->rate_den = scene->rate.den;
    while (parts < PARTS_MAX && (uint64_t)s->rate_num * (parts + 1) <= UINT32_MAX && !are_all_whole(scene, cuts, parts))
        parts++;
    s->timebase_num = s->rate_den;
    s->timebase_den = s->rate_num * parts;
}

/** The tick nearest to a time of the scene, in seconds. */
static int64_t nearest_tick(const adcgs_stream *s, double time)
{
    return (int64_t)rint(time * s->timebase_den / s->timebase_num);
}

adcgs_status adcgs_encode_begin(adcgs_stream *s, const adcgs_scene *scene, const adcgs_cuts *cuts, const adcgs_encode_note *notes,
                                uint32_t n_notes, adcgs_error *error)
{
    adcgs_stream_init(s);
    s->level = 0; /* the lowest level that fits */
    ADCGS_TRY(adcgs_scene_frame(scene, s->scene_origin, &s->scene_scale, error));
    memcpy(s->background, scene->background, sizeof s->background);
    s->screen_filter = ADCGS_SCREEN_FILTER;
    s->colour_space = scene->colour_space;
    s->axes = scene->axes;
    s->units = scene->units;
    set_time(s, scene, cuts);
    ADCGS_TRY(adcgs_stored_cameras_choose(s, scene, error));
    ADCGS_TRY(set_notes(s, notes, n_notes, error));
    s->segments = adcgs_alloc(NULL, cuts->n, sizeof *s->segments, error);
    return s->segments ? ADCGS_OK : adcgs_alloc_status(error);
}

void adcgs_encode_place(adcgs_stream *s, const adcgs_cuts *cuts, uint32_t part, adcgs_model *model)
{
    const int64_t begin = nearest_tick(s, cuts->at[part]), end = nearest_tick(s, cuts->at[part + 1]);
    adcgs_model *to = &s->segments[s->n_segments++];
    *to = *model;
    memset(model, 0, sizeof *model);
    s->params = to->params;
    to->time_start = adcgs_ticks_to_seconds(s, begin);
    to->time_end = adcgs_ticks_to_seconds(s, end);
    to->reach = adcgs_ticks_to_seconds(s, nearest_tick(s, reach_of(cuts, part)) - end);
    s->start_ticks = s->n_segments == 1 ? begin : s->start_ticks;
    s->duration_ticks = end - s->start_ticks;
}

adcgs_status adcgs_encode_model(adcgs_model *model, const adcgs_stream *s, const adcgs_trainer *t, double begin, double end,
                                adcgs_error *error)
{
    const adcgs_quantise_options options = {.cpu = t->cpu};
    const adcgs_status status = adcgs_quantise(model, t->f, &options, error);
    model->time_start = adcgs_ticks_to_seconds(s, nearest_tick(s, begin));
    model->time_end = adcgs_ticks_to_seconds(s, nearest_tick(s, end));
    return status;
}

/** If no anchor moves any more, keeps the motion networks of the previous segment, so that none are sent. */
static adcgs_status keep_motion(adcgs_model *model, const adcgs_model *before, adcgs_error *error)
{
    static const int roles[] = {ADCGS_ROLE_COARSE, ADCGS_ROLE_FINE, ADCGS_ROLE_TIME};
    for (uint32_t i = 0; i < model->n; i++)
        if (!model->is_static[i])
            return ADCGS_OK;
    for (size_t i = 0; i < ADCGS_COUNTOF(roles); i++) {
        adcgs_net_release(&model->net[roles[i]], NULL);
        if (before->net[roles[i]].present)
            ADCGS_TRY(adcgs_net_copy(&model->net[roles[i]], &before->net[roles[i]], NULL, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_encode_predict(adcgs_model *model, const adcgs_model *before, adcgs_error *error)
{
    adcgs_error why;
    if (model->params.time_rows)
        ADCGS_TRY(keep_motion(model, before, error));
    model->predicted = (uint8_t)adcgs_inter_possible(before, model, &why);
    return model->predicted ? adcgs_inter_renew(model, before, error) : ADCGS_OK;
}

static adcgs_status add_segment(adcgs_stream *s, const adcgs_trainer *t, const adcgs_rdo *rdo, const adcgs_cuts *cuts,
                                uint32_t part, adcgs_error *error)
{
    const adcgs_quantise_options options = {.cpu = t->cpu, .rdo = rdo};
    adcgs_model model;
    const adcgs_status status = adcgs_quantise(&model, t->f, &options, error);
    adcgs_encode_place(s, cuts, part, &model);
    return status;
}

adcgs_status adcgs_encode_segment(adcgs_stream *s, const adcgs_trainer *t, const adcgs_cuts *cuts, uint32_t part,
                                  adcgs_error *error)
{
    return add_segment(s, t, NULL, cuts, part, error);
}

static adcgs_status make_stream(adcgs_stream *s, const adcgs_trainer *t, const adcgs_rdo *rdo, const adcgs_encode_note *notes,
                                uint32_t n_notes, adcgs_error *error)
{
    double ends[2] = {0, t->scene->duration};
    const adcgs_cuts cuts = {.n = 1, .at = ends};
    ADCGS_TRY(adcgs_encode_begin(s, t->scene, &cuts, notes, n_notes, error));
    return add_segment(s, t, rdo, &cuts, 0, error);
}

adcgs_status adcgs_encode_stream(adcgs_stream *s, const adcgs_trainer *t, const adcgs_encode_note *notes, uint32_t n_notes,
                                 adcgs_error *error)
{
    return make_stream(s, t, NULL, notes, n_notes, error);
}

/** Serialises. A refusal of the writer is a fault of the scene here, not of the caller. */
static adcgs_status write_scene(adcgs_stream *stream, adcgs_buffer *out, adcgs_error *error)
{
    const adcgs_status status = adcgs_stream_write(stream, out, error);
    if (status != ADCGS_ERR_USAGE)
        return status;
    const adcgs_error why = *error;
    return adcgs_fail(error, ADCGS_ERR_DATA, "the scene has a value that a stream cannot hold: %.180s", why.text);
}

adcgs_status adcgs_encode_bytes(adcgs_bytes *bytes, const adcgs_trainer *t, double strength, const adcgs_encode_note *notes,
                                uint32_t n_notes, adcgs_error *error)
{
    adcgs_stream stream;
    adcgs_buffer out;
    adcgs_rdo rdo;
    if (strength >= 0)
        ADCGS_TRY(adcgs_level_costs(t, strength, &rdo, error));
    adcgs_buffer_init(&out);
    adcgs_status status = make_stream(&stream, t, strength >= 0 ? &rdo : NULL, notes, n_notes, error);
    if (status == ADCGS_OK)
        status = write_scene(&stream, &out, error);
    *bytes = stream.bytes;
    adcgs_buffer_clear(&out);
    adcgs_stream_clear(&stream, NULL);
    return status;
}

/* ---- Proof ---- */

adcgs_status adcgs_encode_verified(adcgs_stream *stream, adcgs_buffer *out, adcgs_cpu_level cpu, adcgs_pool *pool,
                                   adcgs_error *error)
{
    ADCGS_TRY(write_scene(stream, out, error));
    adcgs_stream back;
    adcgs_span from = {.next = out->data, .left = out->size};
    const adcgs_read_options options = {.cpu = cpu, .pool = pool, .strict_end = 1};
    adcgs_stream_init(&back);
    adcgs_status status = adcgs_stream_read(&back, adcgs_span_read, &from, &options, NULL, NULL, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < stream->n_segments; i++) {
        adcgs_error difference;
        if (back.n_segments != stream->n_segments)
            status = adcgs_fail(error, ADCGS_ERR_INTERNAL, "the stream written has %u segments instead of %u", back.n_segments,
                                stream->n_segments);
        else if (!adcgs_model_equal(&stream->segments[i], &back.segments[i], &difference))
            status = adcgs_fail(error, ADCGS_ERR_INTERNAL, "the stream written decodes to another model: %s", difference.text);
    }
    adcgs_stream_clear(&back, NULL);
    return status;
}
