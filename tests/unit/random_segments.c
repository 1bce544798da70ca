/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Random valid streams for tests: segments, cameras, metadata. */
#include "random_model.h"

#include "model/model_priv.h"

#include <math.h>
#include <stdio.h>

static int draw(uint64_t *state, int lo, int hi)
{
    return (int)adcgs_random_range(state, lo, hi);
}

static adcgs_status share_networks(adcgs_model *m, const adcgs_model *from, uint64_t *state, adcgs_error *error)
{
    for (int role = 0; role < ADCGS_ROLES; role++) {
        adcgs_net_release(&m->net[role], NULL);
        if (from->net[role].present)
            ADCGS_TRY(adcgs_net_copy(&m->net[role], &from->net[role], NULL, error));
    }
    return adcgs_random_values(m, state, error);
}

static adcgs_status random_cameras(adcgs_stream *stream, uint64_t *state, adcgs_error *error)
{
    static const double pose[12] = {1, 0, 0, 0.25, 0, 1, 0, -0.5, 0, 0, 1, -4};
    stream->n_cameras = (uint32_t)draw(state, 0, 3);
    stream->cameras = adcgs_alloc(NULL, stream->n_cameras, sizeof *stream->cameras, error);
    if (!stream->cameras)
        return ADCGS_ERR_MEMORY;
    for (uint32_t i = 0; i < stream->n_cameras; i++) {
        adcgs_camera *c = &stream->cameras[i].camera;
        stream->cameras[i].time = i ? i * 0.5 : (double)NAN;
        stream->cameras[i].path = i && stream->n_cameras == 3 ? 0 : -1;
        *c = (adcgs_camera){.width = 64, .height = 48, .fx = 50 + (i > 1), .fy = 50, .cx = 32, .cy = 24, .near_plane = 0.01};
        memcpy(c->cam_to_world, pose, sizeof pose);
        c->cam_to_world[7] = i == 1 ? 0.1 : -0.5; /* 0.1 is no binary32 */
        snprintf(c->name, sizeof c->name, "camera %u", i);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_random_front(adcgs_stream *stream, adcgs_error *error)
{
    static const adcgs_camera front = {.width = 8,
                                       .height = 8,
                                       .fx = 8,
                                       .fy = 8,
                                       .cx = 4,
                                       .cy = 4,
                                       .near_plane = 0.1,
                                       .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3}};
    stream->cameras = adcgs_alloc(NULL, 1, sizeof *stream->cameras, error);
    if (!stream->cameras)
        return ADCGS_ERR_MEMORY;
    stream->cameras[stream->n_cameras++] = (adcgs_stored_camera){.camera = front, .time = (double)NAN, .path = -1};
    return ADCGS_OK;
}

static adcgs_status random_text(char **out, const char *format, int number, adcgs_error *error)
{
    *out = adcgs_alloc(NULL, 64, 1, error);
    if (!*out)
        return ADCGS_ERR_MEMORY;
    snprintf(*out, 64, format, number);
    return ADCGS_OK;
}

adcgs_status adcgs_random_stream(adcgs_stream *stream, const adcgs_params *params, uint32_t segments, uint32_t n, int depth,
                                 uint64_t *state, adcgs_error *error)
{
    adcgs_stream_init(stream);
    stream->params = *params;
    stream->slice_log2 = (uint8_t)draw(state, ADCGS_SLICE_LOG2_MIN, ADCGS_SLICE_LOG2_MIN + 2);
    ADCGS_TRY(random_cameras(stream, state, error));
    stream->segments = adcgs_alloc(NULL, segments, sizeof *stream->segments, error);
    stream->meta = stream->segments ? adcgs_alloc(NULL, 2, sizeof *stream->meta, error) : NULL;
    if (!stream->meta)
        return ADCGS_ERR_MEMORY;
    for (stream->n_meta = 0; stream->n_meta < 2; stream->n_meta++) {
        ADCGS_TRY(random_text(&stream->meta[stream->n_meta].key, "key%d", (int)stream->n_meta, error));
        ADCGS_TRY(random_text(&stream->meta[stream->n_meta].value, "value %d", draw(state, 0, 999), error));
    }
    for (uint32_t i = 0; i < segments; i++) {
        adcgs_model *m = &stream->segments[i];
        const int kind = i ? draw(state, 0, 3) : 0;
        stream->n_segments = i + 1;
        if (kind >= 2)
            ADCGS_TRY(adcgs_random_follower(m, m - 1, n, state, error));
        else
            ADCGS_TRY(adcgs_random_model(m, params, n, depth, state, error));
        if (kind == 1)
            ADCGS_TRY(share_networks(m, m - 1, state, error));
        m->time_start = adcgs_ticks_to_seconds(stream, 40 * (int64_t)i);
        m->time_end = adcgs_ticks_to_seconds(stream, 40 * (int64_t)i + draw(state, 1, 40));
        m->reach = adcgs_ticks_to_seconds(stream, i % 2 ? 0 : 30);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_random_turns(adcgs_stream *stream, uint32_t segments, uint32_t n, int depth, uint32_t added, uint64_t *state,
                                adcgs_error *error)
{
    stream->segments = adcgs_alloc(NULL, segments, sizeof *stream->segments, error);
    if (!stream->segments)
        return ADCGS_ERR_MEMORY;
    for (uint32_t i = 0; i < segments; i++) {
        adcgs_model *m = &stream->segments[stream->n_segments++];
        if (i % 3)
            ADCGS_TRY(adcgs_random_follower(m, m - 1, added, state, error));
        else
            ADCGS_TRY(adcgs_random_model(m, &stream->params, n, depth, state, error));
        m->time_start = adcgs_ticks_to_seconds(stream, 40 * (int64_t)i);
        m->time_end = adcgs_ticks_to_seconds(stream, 40 * (int64_t)i + 40);
        m->reach = adcgs_ticks_to_seconds(stream, i % 3 ? 7 * (i % 3) : 0);
    }
    return ADCGS_OK;
}
