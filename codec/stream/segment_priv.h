/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Numbers of the segment being read that several files of its reader need. */
#ifndef ADCGS_STREAM_SEGMENT_PRIV_H
#define ADCGS_STREAM_SEGMENT_PRIV_H

#include "stream/segment.h"

#include "model/model_priv.h"

/** Its number in the stream. */
static inline uint32_t adcgs_segment_number(const adcgs_segment *s)
{
    return s->stream->first_segment + s->stream->n_segments;
}

/** Number of layers to decode: all layers of the stream, or fewer if the caller wants fewer. */
static inline int adcgs_layers_wanted(const adcgs_segment *s)
{
    const int all = adcgs_params_layers(&s->stream->params);
    return s->options->layers > 0 ? ADCGS_MIN(s->options->layers, all) : all;
}

/** The anchors of a slice: from begin to end - 1. */
static inline void adcgs_slice_span(const adcgs_segment *s, uint32_t i, uint32_t *begin, uint32_t *end)
{
    const uint32_t size = 1U << s->stream->slice_log2;
    *begin = i * size;
    *end = *begin + ADCGS_MIN(s->model.n - *begin, size);
}

#endif
