/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Runs that end one after the other, written to a growing stream. */
#include "session/live_stream.h"

#include "model/model_priv.h"
#include "stream/push.h"

#include <math.h>

#define NEAR 1e-5 /* tolerance for rounding of stored cameras, relative to 1; arithmetic of binary32 */
#define LEVEL 3   /* the level of a growing stream, since its length is unknown; definition */

/** Passes the written bytes to the reader. */
static adcgs_status read_back(adcgs_encode_live *e, const adcgs_buffer *out, size_t begin, adcgs_error *error)
{
    for (size_t at = begin; at < out->size;) {
        size_t used;
        adcgs_arrival arrived;
        ADCGS_TRY(adcgs_push_take(e->reader, out->data + at, out->size - at, &used, &arrived, error));
        at += used;
    }
    return ADCGS_OK;
}

/** Checks that the last segment read equals the one written. */
static adcgs_status compare(const adcgs_encode_live *e, const adcgs_model *written, adcgs_error *error)
{
    adcgs_model read;
    adcgs_error difference;
    int drawable;
    ADCGS_TRY(adcgs_push_peek(e->reader, &read, &drawable, error));
    const int same = drawable && adcgs_model_equal(written, &read, &difference);
    adcgs_model_clear(&read, NULL);
    return same       ? ADCGS_OK
           : drawable ? adcgs_fail(error, ADCGS_ERR_INTERNAL, "the segment written decodes to another model: %s", difference.text)
                      : adcgs_fail(error, ADCGS_ERR_INTERNAL, "the segment written cannot be decoded");
}

adcgs_status adcgs_encode_live_open(adcgs_encode_live *e, const adcgs_scene *whole, const adcgs_cuts *cuts, uint32_t max_anchors,
                                    const adcgs_encode_note *notes, uint32_t n_notes, adcgs_cpu_level cpu, adcgs_pool *pool,
                                    adcgs_error *error)
{
    const adcgs_read_options options = {.cpu = cpu, .pool = pool};
    *e = (adcgs_encode_live){.max_anchors = max_anchors};
    adcgs_stream_init(&e->back);
    ADCGS_TRY(adcgs_encode_begin(&e->front, whole, cuts, notes, n_notes, error));
    e->front.level = LEVEL;
    return adcgs_push_create(&e->reader, &e->back, &options, error);
}

adcgs_status adcgs_encode_live_continue(adcgs_encode_live *e, adcgs_stream *resumed, uint32_t max_anchors, adcgs_cpu_level cpu,
                                        adcgs_pool *pool, adcgs_error *error)
{
    const adcgs_read_options options = {.cpu = cpu, .pool = pool};
    *e = (adcgs_encode_live){.front = *resumed, .max_anchors = max_anchors};
    resumed->cameras = NULL;
    resumed->meta = NULL;
    resumed->n_cameras = resumed->n_meta = 0;
    e->front.segments = NULL;
    e->front.n_segments = e->front.first_segment = 0;
    e->front.level = LEVEL;
    adcgs_stream_init(&e->back);
    return adcgs_push_create(&e->reader, &e->back, &options, error);
}

/** True if two poses are equal within rounding. scale: the size of the scene, for translations. */
static int are_near(const adcgs_camera *a, const adcgs_camera *b, double scale)
{
    for (int i = 0; i < 12; i++)
        if (!(fabs(a->cam_to_world[i] - b->cam_to_world[i]) <= NEAR * (i % 4 == 3 ? scale : 1)))
            return 0;
    return 1;
}

adcgs_status adcgs_encode_live_check(const adcgs_encode_live *e, const adcgs_scene *scene, adcgs_error *error)
{
    for (uint32_t i = 0; i < e->front.n_cameras; i++) {
        const adcgs_camera *const c = &e->front.cameras[i].camera;
        const adcgs_scene_view *v = scene->views[ADCGS_SPLIT_TRAIN], *const end = v + scene->n_views[ADCGS_SPLIT_TRAIN];
        while (v < end && strcmp(v->camera.name, c->name) != 0)
            v++;
        if (v == end || v->camera.width != c->width || v->camera.height != c->height ||
            fabs(v->camera.fx - c->fx) > NEAR * c->fx || !are_near(&v->camera, c, e->front.scene_scale))
            return adcgs_fail(error, ADCGS_ERR_USAGE,
                              "the stream's camera %s is not one of the scene's: continue the stream "
                              "with its own scene",
                              c->name);
    }
    return ADCGS_OK;
}

/** Creates the stream from the first segment, which sets the values that all segments share. */
static adcgs_status begin(adcgs_encode_live *e, adcgs_model *model, adcgs_error *error)
{
    if (e->grow)
        return ADCGS_OK;
    model->predicted = 0;
    e->front.params = model->params;
    ADCGS_TRY(adcgs_seconds_to_ticks(&e->front, model->time_start, &e->front.start_ticks, error));
    return adcgs_grow_create(&e->grow, &e->front, ADCGS_MAX(e->max_anchors, model->n), error);
}

adcgs_status adcgs_encode_live_add(adcgs_encode_live *e, adcgs_model *model, adcgs_buffer *out, adcgs_error *error)
{
    const size_t size = out->size;
    ADCGS_TRY(begin(e, model, error));
    ADCGS_TRY(adcgs_grow_segment(e->grow, e->model.n ? &e->model : NULL, model, out, error));
    adcgs_status status = read_back(e, out, size, error);
    if (status == ADCGS_OK)
        status = compare(e, model, error);
    if (status != ADCGS_OK) {
        out->size = size;
        error->status = ADCGS_ERR_INTERNAL;
        return ADCGS_ERR_INTERNAL;
    }
    adcgs_stream_forget(&e->back, e->back.n_segments ? e->back.n_segments - 1 : 0, NULL); /* prediction needs only the last */
    adcgs_model_clear(&e->model, NULL);
    e->model = *model;
    memset(model, 0, sizeof *model);
    return ADCGS_OK;
}

adcgs_status adcgs_encode_live_end(adcgs_encode_live *e, adcgs_buffer *out, adcgs_error *error)
{
    const size_t begin = out->size;
    ADCGS_TRY(adcgs_grow_end(e->grow, out, error));
    return read_back(e, out, begin, error);
}

void adcgs_encode_live_clear(adcgs_encode_live *e)
{
    adcgs_grow_free(&e->grow);
    adcgs_push_free(&e->reader);
    adcgs_stream_clear(&e->front, NULL);
    adcgs_stream_clear(&e->back, NULL);
    adcgs_model_clear(&e->model, NULL);
}
