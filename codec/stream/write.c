/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writing a stream that is complete in memory. */
#include "model/model_priv.h"
#include "stream/writer.h"

static uint32_t max_anchors(const adcgs_stream *stream)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < stream->n_segments; i++)
        most = ADCGS_MAX(most, stream->segments[i].n);
    return most;
}

static adcgs_status write_chunks(adcgs_writer *w)
{
    ADCGS_TRY(adcgs_writer_front(w));
    for (uint32_t i = 0; i < w->stream->n_segments; i++) {
        adcgs_model *model = &w->stream->segments[i];
        ADCGS_TRY(adcgs_writer_segment(w, model->predicted ? model - 1 : NULL, model));
    }
    return adcgs_writer_end(w);
}

static adcgs_status write_at_level(adcgs_stream *stream, adcgs_buffer *out, adcgs_error *error)
{
    adcgs_writer w;
    adcgs_writer_init(&w, stream, max_anchors(stream), out, error);
    const adcgs_status status = write_chunks(&w);
    adcgs_writer_clear(&w);
    if (status != ADCGS_OK)
        out->size = w.begin;
    return status;
}

/** Check each model by itself, then the consistency of the segments. Derives the stream's time range. */
static adcgs_status check_stream(adcgs_stream *stream, adcgs_error *error)
{
    int64_t span[2] = {0, 0};
    if (stream->n_segments < 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "stream: no segments, expected at least one");
    ADCGS_TRY(adcgs_writer_check_head(stream, error));
    for (uint32_t i = 0; i < stream->n_segments; i++) {
        const adcgs_model *model = &stream->segments[i];
        ADCGS_TRY(adcgs_writer_check(stream, i, i > 0 ? model - 1 : NULL, model, span, error));
        if (i == 0)
            stream->start_ticks = span[0];
    }
    stream->duration_ticks = span[1] - stream->start_ticks;
    return ADCGS_OK;
}

adcgs_status adcgs_stream_write(adcgs_stream *stream, adcgs_buffer *out, adcgs_error *error)
{
    ADCGS_TRY(check_stream(stream, error));
    if (stream->level > 0)
        return write_at_level(stream, out, error);
    adcgs_status status = ADCGS_ERR_LIMIT;
    for (int level = 1; level <= ADCGS_LEVELS && status == ADCGS_ERR_LIMIT; level++) {
        stream->level = (uint8_t)level;
        status = write_at_level(stream, out, error);
    }
    return status;
}
