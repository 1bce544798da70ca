/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A stream written segment by segment. */
#include "stream/grow.h"

#include "stream/writer.h"

#define UNKNOWN (-1) /* duration_ticks */

struct adcgs_grow {
    adcgs_writer writer;
    int64_t span[2];      /**< ticks of the last segment written */
    uint32_t max_anchors; /**< maximum over the segments so far */
    uint32_t depth;       /**< likewise */
    uint64_t chunk_bytes; /**< longest payload so far */
};

adcgs_status adcgs_grow_create(adcgs_grow **out, adcgs_stream *stream, uint32_t max_anchors, adcgs_error *error)
{
    *out = NULL;
    if (stream->level < 1 || stream->n_segments > 0)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: level %u and %u segments, expected a level and no segment",
                          stream->level, stream->n_segments);
    ADCGS_TRY(adcgs_writer_check_head(stream, error));
    adcgs_grow *g = adcgs_alloc(NULL, 1, sizeof *g, error);
    *out = g;
    if (!g)
        return adcgs_alloc_status(error);
    const int64_t duration = stream->duration_ticks;
    stream->duration_ticks = UNKNOWN;
    adcgs_buffer none;
    adcgs_buffer_init(&none);
    adcgs_writer_init(&g->writer, stream, max_anchors, &none, error);
    const adcgs_status status = adcgs_head_write(&none, stream, max_anchors, error); /* detects now whether HEAD can be written */
    adcgs_buffer_clear(&none);
    if (status != ADCGS_OK) {
        stream->duration_ticks = duration;
        adcgs_grow_free(out);
    }
    return status;
}

void adcgs_grow_free(adcgs_grow **grow)
{
    if (!*grow)
        return;
    adcgs_writer_clear(&(*grow)->writer);
    adcgs_free(NULL, *grow);
    *grow = NULL;
}

/** Let the writer continue in this buffer. */
static void go_on(adcgs_grow *g, adcgs_buffer *out, adcgs_error *error)
{
    g->writer.out = out;
    g->writer.begin = out->size;
    g->writer.error = error;
}

/** State that a call may have changed before it fails. */
typedef struct state {
    adcgs_writer writer;
    adcgs_bytes bytes;
    uint32_t weights;
} state;

static state note_state(const adcgs_grow *g)
{
    return (state){g->writer, g->writer.stream->bytes, g->writer.stream->weights};
}

/** Restore the state after a failed call, as if the call had not been made. */
static void restore(adcgs_grow *g, const state *was)
{
    adcgs_writer *w = &g->writer;
    const adcgs_buffer grown = w->index; /* its memory may have been reallocated */
    w->out->size = w->begin;
    *w = was->writer;
    w->index = grown;
    w->index.size = was->writer.index.size;
    w->index.failed = 0;
    w->stream->bytes = was->bytes;
    w->stream->weights = was->weights;
}

/** Release the appended bytes to the caller. Payload lengths come from the chunk headers. */
static void hand_over(adcgs_grow *g, int has_signature)
{
    adcgs_writer *w = &g->writer;
    for (size_t at = w->begin + (has_signature ? ADCGS_SIGNATURE_BYTES : 0); at < w->out->size;) {
        const uint32_t length = adcgs_load_le32(w->out->data + at + 4);
        g->chunk_bytes = ADCGS_MAX(g->chunk_bytes, length);
        at += ADCGS_CHUNK_BYTES + length;
    }
    w->gone += w->out->size - w->begin;
    w->begin = w->out->size;
}

static adcgs_status write_segment(adcgs_grow *g, const adcgs_model *before, adcgs_model *model)
{
    adcgs_writer *w = &g->writer;
    if (w->n_segments >= w->limits->segments)
        return adcgs_fail(w->error, ADCGS_ERR_LIMIT, "stream: more than %u segments, the level's limit", w->limits->segments);
    if (model->n > w->max_anchors)
        return adcgs_fail(w->error, ADCGS_ERR_LIMIT, "stream: segment %u has %u anchors, HEAD promises at most %u", w->n_segments,
                          model->n, w->max_anchors);
    if (w->n_segments == 0)
        ADCGS_TRY(adcgs_writer_front(w));
    else if (!model->predicted)
        ADCGS_TRY(adcgs_writer_head(w));
    ADCGS_TRY(adcgs_writer_segment(w, model->predicted ? before : NULL, model));
    /* Reserve bytes for the end of the stream. */
    const uint64_t end = w->index.size + 3 * ADCGS_CHUNK_BYTES + ADCGS_HEAD_BYTES_MAX;
    if (w->gone + (w->out->size - w->begin) + end > w->limits->file_bytes)
        return adcgs_fail(w->error, ADCGS_ERR_LIMIT, "stream: the level allows no more bytes");
    return ADCGS_OK;
}

adcgs_status adcgs_grow_segment(adcgs_grow *g, const adcgs_model *before, adcgs_model *model, adcgs_buffer *out,
                                adcgs_error *error)
{
    adcgs_writer *w = &g->writer;
    int64_t span[2] = {g->span[0], g->span[1]};
    ADCGS_TRY(adcgs_writer_check(w->stream, w->n_segments, before, model, span, error));
    if (w->n_segments == 0 && span[0] != w->stream->start_ticks)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: the first segment does not begin at the stream's start");
    go_on(g, out, error);
    const state was = note_state(g);
    const adcgs_status status = write_segment(g, before, model);
    if (status != ADCGS_OK) {
        restore(g, &was);
        return status;
    }
    hand_over(g, was.writer.n_segments == 0);
    g->span[0] = span[0];
    g->span[1] = span[1];
    g->max_anchors = ADCGS_MAX(g->max_anchors, model->n);
    g->depth = ADCGS_MAX(g->depth, model->depth);
    return ADCGS_OK;
}

adcgs_status adcgs_grow_end(adcgs_grow *g, adcgs_buffer *out, adcgs_error *error)
{
    if (g->writer.n_segments == 0)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: no segments, expected at least one");
    go_on(g, out, error);
    const state was = note_state(g);
    const adcgs_status status = adcgs_writer_end(&g->writer);
    if (status == ADCGS_OK)
        hand_over(g, 0);
    else
        restore(g, &was);
    return status;
}

/** Whether the stream so far fits a level. */
static int fits(const adcgs_grow *g, const adcgs_level *l)
{
    const adcgs_writer *w = &g->writer;
    return g->max_anchors <= l->anchors && w->n_segments <= l->segments && g->depth <= l->depth && w->weights <= l->weights &&
           w->n_nets <= l->networks && w->gone <= l->file_bytes && g->chunk_bytes <= l->chunk_bytes &&
           w->spent.bytes <= l->model_bytes && w->spent.work <= l->work;
}

adcgs_status adcgs_grow_settle(const adcgs_grow *g, adcgs_buffer *out, adcgs_error *error)
{
    adcgs_stream stream = *g->writer.stream;
    stream.n_segments = g->writer.n_segments;
    stream.duration_ticks = g->span[1] - stream.start_ticks;
    for (stream.level = 1; stream.level < g->writer.stream->level && !fits(g, adcgs_level_get(stream.level)); stream.level++)
        continue;
    return adcgs_head_write(out, &stream, g->max_anchors, error);
}
