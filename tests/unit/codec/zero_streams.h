/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Streams whose contents cost no bytes: every weight and value is 0. */
#ifndef ADCGS_TESTS_ZERO_STREAMS_H
#define ADCGS_TESTS_ZERO_STREAMS_H

#include "stream_edit.h"

#include "model/model_priv.h"

#include <adcgs/adcgs.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/** The parameters of a zero stream: every weight and value is 0, and anchors fill a cube. */
typedef struct nothing {
    adcgs_params params;
    uint32_t segments, anchors;
    int depth;
    int role, layers, width; /**< hidden layers of one network, of this width; the others have none */
    uint32_t cameras;
    int predicted; /**< segments after the first predict all anchors from the one before */
} nothing;

static const nothing least = {.params = {.k = 1, .n_fv = 1, .chunks = 1}, .segments = 1, .anchors = 1};

static inline void zero_net(adcgs_net *net, const adcgs_params *params, int role, int layers, uint32_t width)
{
    uint32_t n_in, n_out;
    adcgs_role_shape(params, role, &n_in, &n_out);
    *net = (adcgs_net){.present = 1, .role = (uint8_t)role, .n_layers = (uint8_t)(n_in == 0 ? 1 : layers)};
    for (int i = 0; i < net->n_layers; i++) {
        adcgs_layer *l = &net->layer[i];
        const uint32_t rows = i == net->n_layers - 1 ? n_out : width;
        l->w = (adcgs_tensor){.rows = rows, .cols = n_in, .m = adcgs_alloc(NULL, (size_t)rows * n_in, 4, NULL)};
        l->b = (adcgs_tensor){.rows = rows, .cols = 1, .m = adcgs_alloc(NULL, rows, 4, NULL)};
        assert_true(l->w.m && l->b.m);
        n_in = rows;
    }
}

/** Puts anchor i into the voxel with Morton code i. */
static inline void fill_cube(adcgs_model *m)
{
    for (uint32_t i = 0; i < m->n; i++)
        for (int bit = 0; bit < 10; bit++)
            for (int axis = 0; axis < 3; axis++)
                m->pos[3 * i + (uint32_t)axis] |= (i >> (3 * bit + 2 - axis) & 1) << bit;
}

static inline void make_model(adcgs_model *m, const nothing *what)
{
    m->params = what->params;
    m->n = what->anchors;
    m->depth = (uint8_t)what->depth;
    m->voxel = 1;
    m->layers = (uint8_t)adcgs_params_layers(&m->params);
    assert_int_equal(adcgs_model_alloc(m, NULL, NULL), ADCGS_OK);
    fill_cube(m);
    for (uint32_t i = 0; i < m->n; i++)
        m->mask[i] = (uint16_t)((1U << m->params.k) - 1);
    for (int i = 0; i < ADCGS_NV_MAX; i++)
        m->d_fv[i] = 1;
    for (int i = 0; i < ADCGS_NG_MAX; i++)
        m->d_fg[i] = 1;
    for (int i = 0; i < ADCGS_SIGMA_MAX; i++)
        m->d_sigma[i] = 1;
    for (int i = 0; i < ADCGS_COLOUR_N; i++)
        m->d_colour[i] = 1;
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (adcgs_role_required(&m->params, role))
            zero_net(&m->net[role], &m->params, role, role == what->role ? 1 + what->layers : 1, (uint32_t)what->width);
}

static inline void make_stream(adcgs_stream *stream, const nothing *what)
{
    adcgs_stream_init(stream);
    stream->params = what->params;
    stream->slice_log2 = ADCGS_SLICE_LOG2_MAX;
    stream->segments = adcgs_alloc(NULL, what->segments, sizeof *stream->segments, NULL);
    stream->cameras = adcgs_alloc(NULL, what->cameras, sizeof *stream->cameras, NULL);
    assert_true(stream->segments && stream->cameras);
    for (; stream->n_segments < what->segments; stream->n_segments++) {
        adcgs_model *m = &stream->segments[stream->n_segments];
        make_model(m, what);
        m->predicted = (uint8_t)(what->predicted && stream->n_segments > 0);
        m->time_start = m->time_end = adcgs_ticks_to_seconds(stream, stream->n_segments);
    }
    for (; stream->n_cameras < what->cameras; stream->n_cameras++)
        stream->cameras[stream->n_cameras] =
            (adcgs_stored_camera){.camera = {.width = 1, .height = 1, .fx = 1, .fy = 1, .near_plane = 1, .cam_to_world = {1}},
                                  .time = (double)NAN,
                                  .path = -1};
}

static inline void set_level(uint8_t *stream, size_t size, int level)
{
    stream[ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_HEADER_BYTES + 5] = (uint8_t)level;
    adcgs_repair_stream(stream, size, 0);
}

/** Writes the zero stream for the level that it needs, then changes its level to 1. */
static inline void make_bytes(adcgs_buffer *bytes, const nothing *what)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    adcgs_buffer_init(bytes);
    make_stream(&stream, what);
    if (adcgs_stream_write(&stream, bytes, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    set_level(bytes->data, bytes->size, 1);
    adcgs_stream_clear(&stream, NULL);
}

#endif
