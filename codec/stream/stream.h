/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A whole stream in memory: header, cameras, metadata and one model per time
 * segment; written to bytes and read from bytes (spec clause "Stream").
 */
#ifndef ADCGS_STREAM_STREAM_H
#define ADCGS_STREAM_STREAM_H

#include "base/log.h"
#include "model/latents.h"
#include "model/model.h"

#include <adcgs/types.h>

typedef struct adcgs_meta {
    char *key, *value; /**< UTF-8, owned */
} adcgs_meta;

/** A camera stored with the scene. */
typedef struct adcgs_stored_camera {
    adcgs_camera camera;
    double time; /**< seconds at which it filmed; NaN: none */
    int path;    /**< number of the filmed path that it is a key of; -1: none. Keys of a path follow each other in time */
} adcgs_stored_camera;

typedef struct adcgs_stream {
    uint8_t profile, level, arith; /**< level 0, for writing: the lowest that fits */
    uint8_t slice_log2;            /**< anchors per slice = 2^slice_log2 */
    adcgs_params params;
    uint32_t timebase_num, timebase_den; /**< seconds per tick = num/den */
    uint32_t rate_num, rate_den;         /**< suggested frames per second for playing */
    int64_t start_ticks, duration_ticks;
    double scene_origin[3], scene_scale; /**< world = origin + scale * scene units */
    float background[3];
    float screen_filter;  /**< variance in pixels^2 added to every projected splat, 0..16 */
    uint8_t colour_space; /**< 0 unknown, 1 sRGB, 2 linear BT.709 */
    uint8_t axes;         /**< 0 unknown, 1 right-handed y up, 2 right-handed z up, 3 right-handed y down */
    uint8_t units;        /**< 0 unknown, 1 metre */
    uint32_t n_cameras;
    adcgs_stored_camera *cameras; /**< [n_cameras] */
    uint32_t n_meta;
    adcgs_meta *meta;
    uint32_t n_segments;
    uint32_t first_segment; /**< number of segments[0]: above 0 if earlier ones were freed or missed */
    adcgs_model *segments;  /**< [n_segments], in time order; time_start/end in seconds are derived from ticks */
    int truncated;
    uint32_t weights;  /**< of distinct networks; filled by reading and by writing */
    adcgs_bytes bytes; /**< filled by reading and by writing */
} adcgs_stream;

/** Zero, with defaults: timebase 1/1000, rate 30, slices of 1024, scale 1, filter 0.3. */
void adcgs_stream_init(adcgs_stream *stream);
void adcgs_stream_clear(adcgs_stream *stream, adcgs_memory *memory);
/** Free the first n models, n at most n_segments; the others move to the front. */
void adcgs_stream_forget(adcgs_stream *stream, uint32_t n, adcgs_memory *memory);

/** The summary that decoders and reports give, of a stream that was read or written. */
void adcgs_stream_info(const adcgs_stream *stream, adcgs_info *info);

/** Seconds of a tick; the tick of a time, exactly (ADCGS_ERR_USAGE if there is none). */
double adcgs_ticks_to_seconds(const adcgs_stream *stream, int64_t ticks);
adcgs_status adcgs_seconds_to_ticks(const adcgs_stream *stream, double seconds, int64_t *ticks, adcgs_error *error);
/** The ticks of a segment's reach; ADCGS_ERR_USAGE as above. */
adcgs_status adcgs_reach_ticks(const adcgs_stream *stream, const adcgs_model *model, uint32_t *ticks, adcgs_error *error);

/**
 * Append the stream to out, without absent tiers. Validates first; segment times must be whole ticks. Derives start_ticks and
 * duration_ticks from the segments; level 0 becomes the lowest level that the stream fits; fills bytes.
 */
adcgs_status adcgs_stream_write(adcgs_stream *stream, adcgs_buffer *out, adcgs_error *error);

typedef struct adcgs_read_options {
    adcgs_cpu_level cpu;  /**< resolved */
    adcgs_pool *pool;     /**< may be NULL */
    adcgs_memory *memory; /**< may be NULL */
    adcgs_log log;
    int layers; /**< 1..5, 0: all */
    int strict_end;
    int conceal; /**< slices after a damaged one are treated as missing */
    int tune_in; /**< if the beginning is missing, start at the next HEAD (push.h) */
} adcgs_read_options;

/** Called for each line of the trace (spec "Trace"), in the caller's thread: absolute bit position, name, value as text. */
typedef void (*adcgs_trace_fn)(void *user, uint64_t bit, const char *element, const char *value);

/** Parse and decode from a sequential source. trace may be NULL. */
adcgs_status adcgs_stream_read(adcgs_stream *stream, adcgs_read_fn read, void *user, const adcgs_read_options *options,
                               adcgs_trace_fn trace, void *trace_user, adcgs_error *error);

#endif
