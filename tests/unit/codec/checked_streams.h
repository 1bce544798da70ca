/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A stream in memory, read back and compared with the one written; the check of a status. */
#ifndef ADCGS_TESTS_CHECKED_STREAMS_H
#define ADCGS_TESTS_CHECKED_STREAMS_H

#include "model/model_priv.h"
#include "stream/input.h"
#include "stream/stream.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static const adcgs_read_options plain = {.cpu = ADCGS_CPU_SCALAR};

static inline void check(adcgs_status status, const adcgs_error *error)
{
    if (status != ADCGS_OK)
        fail_msg("%s: %s", adcgs_status_name(status), error->text);
}

static inline adcgs_status read_stream(adcgs_stream *stream, const uint8_t *data, size_t bytes, const adcgs_read_options *options,
                                       adcgs_error *error)
{
    adcgs_span s = {.next = data, .left = bytes};
    return adcgs_stream_read(stream, adcgs_span_read, &s, options, NULL, NULL, error);
}

static inline void check_equal(const adcgs_stream *a, const adcgs_stream *b)
{
    adcgs_error error = {ADCGS_OK, ""};
    assert_int_equal(a->n_segments, b->n_segments);
    for (uint32_t i = 0; i < a->n_segments; i++)
        if (!adcgs_model_equal(&a->segments[i], &b->segments[i], &error))
            fail_msg("segment %u: %s", i, error.text);
    assert_int_equal(a->n_cameras, b->n_cameras);
    for (uint32_t i = 0; i < a->n_cameras; i++) {
        const adcgs_camera *const c = &a->cameras[i].camera, *const d = &b->cameras[i].camera;
        assert_string_equal(c->name, d->name);
        assert_int_equal(c->width, d->width);
        assert_true(c->fx == d->fx && c->near_plane == d->near_plane);
        assert_memory_equal(c->cam_to_world, d->cam_to_world, sizeof c->cam_to_world);
        assert_int_equal(a->cameras[i].path, b->cameras[i].path);
        assert_true(a->cameras[i].path < 0 || a->cameras[i].time == b->cameras[i].time);
    }
    assert_int_equal(a->n_meta, b->n_meta);
    for (uint32_t i = 0; i < a->n_meta; i++) {
        assert_string_equal(a->meta[i].key, b->meta[i].key);
        assert_string_equal(a->meta[i].value, b->meta[i].value);
    }
    assert_memory_equal(&a->bytes, &b->bytes, sizeof a->bytes);
    assert_true(a->start_ticks == b->start_ticks && a->duration_ticks == b->duration_ticks && a->level == b->level);
}

#endif
