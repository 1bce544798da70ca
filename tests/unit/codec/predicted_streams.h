/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Streams of predicted segments: made, written and compared with the streams read back. */
#ifndef ADCGS_TESTS_PREDICTED_STREAMS_H
#define ADCGS_TESTS_PREDICTED_STREAMS_H

#include "checked_streams.h"
#include "random_model.h"
#include "stream_edit.h"

#include "model/inter_priv.h"
#include "model/model_priv.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

static inline void write_stream(adcgs_stream *stream, adcgs_buffer *bytes)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_buffer_init(bytes);
    check(adcgs_stream_write(stream, bytes, &error), &error);
}

static inline adcgs_params some_params(uint64_t *seed)
{
    adcgs_params params;
    adcgs_random_small_params(&params, 4, seed);
    return params;
}

/** A stream of one random model, with room for more segments, which the functions below append. */
static inline void make_stream(adcgs_stream *stream, const adcgs_params *params, uint32_t room, uint32_t n, uint64_t *seed)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream_init(stream);
    stream->params = *params;
    stream->slice_log2 = ADCGS_SLICE_LOG2_MIN;
    stream->segments = adcgs_alloc(NULL, room, sizeof *stream->segments, &error);
    assert_non_null(stream->segments);
    stream->n_segments = 1;
    check(adcgs_random_model(&stream->segments[0], params, n, 4, seed, &error), &error);
    stream->segments[0].time_end = adcgs_ticks_to_seconds(stream, 40);
}

static inline adcgs_model *next_segment(adcgs_stream *stream)
{
    adcgs_model *m = &stream->segments[stream->n_segments];
    m->time_start = adcgs_ticks_to_seconds(stream, 40 * (int64_t)stream->n_segments);
    m->time_end = adcgs_ticks_to_seconds(stream, 40 * ((int64_t)stream->n_segments + 1));
    stream->n_segments++;
    return m;
}

static inline void append_follower(adcgs_stream *stream, uint32_t n, uint64_t *seed)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_model *m = &stream->segments[stream->n_segments];
    check(adcgs_random_follower(m, m - 1, n, seed, &error), &error);
    next_segment(stream);
}

/** Appends a segment with the anchors of the one before, without every nth one; 0: with all. */
static inline adcgs_model *append_same(adcgs_stream *stream, uint32_t nth)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_model *m = &stream->segments[stream->n_segments], *before = m - 1;
    adcgs_inter kept = {.n = 0};
    *m = adcgs_random_frame(before);
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (before->net[role].present)
            check(adcgs_net_copy(&m->net[role], &before->net[role], NULL, &error), &error);
    check(adcgs_model_alloc(m, NULL, &error), &error);
    check(adcgs_inter_alloc(&kept, before, NULL, &error), &error);
    for (uint32_t i = 0; i < before->n; i++) {
        kept.mode[i] = nth && i % nth == 0 ? ADCGS_INTER_DROPPED : ADCGS_INTER_SAME;
        kept.n += kept.mode[i] == ADCGS_INTER_SAME;
    }
    check(adcgs_random_join(&kept, before, m, &error), &error);
    adcgs_inter_clear(&kept, NULL);
    return next_segment(stream);
}

static inline void check_models(const adcgs_stream *a, const adcgs_stream *b)
{
    adcgs_error error = {ADCGS_OK, ""};
    assert_int_equal(a->n_segments, b->n_segments);
    for (uint32_t i = 0; i < a->n_segments; i++) {
        if (!adcgs_model_equal(&a->segments[i], &b->segments[i], &error))
            fail_msg("segment %u: %s", i, error.text);
        assert_int_equal(a->segments[i].predicted, b->segments[i].predicted);
    }
}

/** Reads the stream back and writes it again as the same bytes. \return payload bytes of its last KEEP; anchors: its GEOM's. */
static inline size_t check_round_trip(adcgs_stream *stream, uint32_t *anchors)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream back;
    adcgs_buffer bytes, again;
    adcgs_found_chunk c;
    size_t keep = 0;
    write_stream(stream, &bytes);
    check(read_stream(&back, bytes.data, bytes.size, &plain, &error), &error);
    check_models(stream, &back);
    write_stream(&back, &again);
    assert_int_equal(bytes.size, again.size);
    assert_memory_equal(bytes.data, again.data, bytes.size);
    for (size_t pos = ADCGS_SIGNATURE_BYTES; adcgs_next_chunk(bytes.data, bytes.size, &pos, &c);) {
        keep = c.type == ADCGS_TYPE_KEEP ? c.length : keep;
        if (c.type == ADCGS_TYPE_GEOM && anchors)
            *anchors = adcgs_load_le32(bytes.data + c.payload);
    }
    adcgs_buffer_clear(&bytes);
    adcgs_buffer_clear(&again);
    adcgs_stream_clear(&back, NULL);
    return keep;
}

#endif
