/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The stream's storage. */
#include "model/stream.h"

void adcgs_stream_init(adcgs_stream *stream)
{
    *stream = (adcgs_stream){
        .slice_log2 = ADCGS_SLICE_LOG2_DEFAULT,
        .timebase_num = 1,
        .timebase_den = 1000,
        .rate_num = 30,
        .rate_den = 1,
        .scene_scale = 1,
        .screen_filter = 0.3f,
    };
}

void adcgs_stream_clear(adcgs_stream *stream, adcgs_memory *memory)
{
    for (uint32_t i = 0; i < stream->n_meta; i++) {
        adcgs_free(memory, stream->meta[i].key);
        adcgs_free(memory, stream->meta[i].value);
    }
    for (uint32_t i = 0; i < stream->n_segments; i++)
        adcgs_model_clear(&stream->segments[i], memory);
    adcgs_free(memory, stream->meta);
    adcgs_free(memory, stream->cameras);
    adcgs_free(memory, stream->segments);
    memset(stream, 0, sizeof *stream);
}
