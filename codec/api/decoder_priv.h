/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The public decoder, and the declarations that the files of this folder share. */
#ifndef ADCGS_API_DECODER_PRIV_H
#define ADCGS_API_DECODER_PRIV_H

#include "base/log.h"
#include "base/thread_pool.h"
#include "render/render.h"
#include "splat/splat.h"
#include "stream/push.h"
#include "stream/salvage.h"
#include "stream/seek.h"

#include <adcgs/decoder.h>

#include <stdio.h>

/** A segment's model prepared for rendering. */
typedef struct adcgs_drawn {
    adcgs_splat *splat; /**< NULL: nothing is prepared */
    uint32_t segment;
    adcgs_model coarser; /**< the model of splat, if the segment has more tiers; n 0: splat uses the segment's own model */
} adcgs_drawn;

struct adcgs_decoder {
    adcgs_memory memory;
    adcgs_pool *pool;     /**< the caller's or own_pool */
    adcgs_pool *own_pool; /**< NULL: the caller gave a pool */
    adcgs_cpu_level cpu;
    adcgs_log log;
    adcgs_stream stream;
    adcgs_seek *seek;        /**< reads segments on demand; NULL: all segments are in memory */
    adcgs_push_reader *push; /**< reads segments from pushed bytes; NULL: all segments are in memory */
    adcgs_model unfinished;  /**< the segment that push is receiving, as far as it has come; n 0: none */
    int is_behind;           /**< more of that segment has come since */
    uint32_t faults;         /**< number of concealed faults */
    FILE *file;              /**< file being read, if the decoder opened one */
    int tiers;               /**< maximum number of tiers to render; 0: all */
    adcgs_drawn drawn[2];    /**< for even and odd segments: the current one, and during a crossfade the previous one */
    adcgs_raster *raster;    /**< NULL until the first frame */
    float *planar;           /**< planes of [height][width], grows */
    size_t planar_size;      /**< floats in it */
};

/**
 * Put at the start of every public function. The caller's error may be NULL, but the implementation must know why an allocation
 * failed (adcgs_alloc_status()).
 */
#define ADCGS_OWN_ERROR(error)                     \
    adcgs_error own_error_ = {.status = ADCGS_OK}; \
    if (!(error))                                  \
    (error) = &own_error_

/** Fail if a pointer that must not be NULL is NULL. */
#define ADCGS_REQUIRE(pointer, error)                                                          \
    do {                                                                                       \
        if (!(pointer))                                                                        \
            return adcgs_fail((error), ADCGS_ERR_USAGE, "%s: %s is NULL", __func__, #pointer); \
    } while (0)

/** Set up own from a caller's struct of any version; NULL: all defaults. */
adcgs_status adcgs_config_read(adcgs_config *own, const adcgs_config *theirs, adcgs_error *error);

/** Splats to render at a time: those of a segment, and during a crossfade those of the segment before it. */
typedef struct adcgs_render_state {
    adcgs_primitives now, before;
    int fades;    /**< 0: no crossfade, `before` is unset */
    float weight; /**< of `now`, 0..1 */
} adcgs_render_state;

/** Fill out for a time. Also checks the floating-point modes. */
adcgs_status adcgs_decoder_state_at(adcgs_decoder *d, double time, adcgs_render_state *out, adcgs_error *error);
/** Must be called before models are freed or moved. */
void adcgs_decoder_forget_drawn(adcgs_decoder *d);

#endif
