/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The public decoder, and what the files of this room share about it. */
#ifndef ADCGS_API_DECODER_PRIV_H
#define ADCGS_API_DECODER_PRIV_H

#include "base/log.h"
#include "base/pool.h"
#include "render/render.h"
#include "splat/splat.h"
#include "stream/push.h"
#include "stream/salvage.h"
#include "stream/seek.h"

#include <adcgs/decoder.h>

#include <stdio.h>

/** A segment's model made ready to be drawn. */
typedef struct adcgs_drawn {
    adcgs_splat *splat;     /**< NULL: none is */
    uint32_t segment;
    adcgs_model coarser;    /**< what splat is of, if the segment has more tiers; n 0: it is of the segment */
} adcgs_drawn;

struct adcgs_decoder {
    adcgs_memory memory;
    adcgs_pool *pool;       /**< the caller's or own_pool */
    adcgs_pool *own_pool;   /**< NULL: the caller gave one */
    adcgs_cpu_level cpu;
    adcgs_log log;
    adcgs_stream stream;
    adcgs_seek *seek;       /**< reads its segments on demand; NULL: all are there */
    adcgs_push_reader *push; /**< gives it its segments as bytes come; NULL: all are there */
    adcgs_model unfinished; /**< the segment at hand of push, as far as it came; n 0: there is none */
    int is_behind;          /**< more of it has come since */
    uint32_t faults;        /**< that were concealed */
    FILE *file;             /**< that it reads from, if that is a file opened here */
    int tiers;              /**< that are drawn at most; 0: all */
    adcgs_drawn drawn[2];   /**< of even and odd segments: that at hand, and in a fade the one before */
    adcgs_raster *raster;   /**< NULL until the first frame */
    float *planar;          /**< planes of [height][width], grows */
    size_t planar_size;     /**< floats in it */
};

/**
 * In front of everything a public function does: its caller's error may be NULL, but inside the reason of a failed allocation
 * has to be known (adcgs_alloc_status()).
 */
#define ADCGS_OWN_ERROR(error)                        \
    adcgs_error own_error_ = { .status = ADCGS_OK };  \
    if (!(error))                                     \
    (error) = &own_error_

/** Refuse a pointer that must not be NULL. */
#define ADCGS_REQUIRE(pointer, error)                                                      \
    do {                                                                                   \
        if (!(pointer))                                                                    \
            return adcgs_fail((error), ADCGS_ERR_USAGE, "%s: %s is NULL", __func__, #pointer); \
    } while (0)

/** Set up own from a caller's struct of any version; NULL: all defaults. */
adcgs_status adcgs_config_read(adcgs_config *own, const adcgs_config *theirs, adcgs_error *error);

/** What is drawn at a time: the splats of a segment, and while it is faded into those of the segment before. */
typedef struct adcgs_moment {
    adcgs_primitives now, before;
    int fades;              /**< 0: there is no `before` */
    float weight;           /**< of what is now, 0..1 */
} adcgs_moment;

/** After a look at the modes of arithmetic. */
adcgs_status adcgs_decoder_moment(adcgs_decoder *d, double time, adcgs_moment *out, adcgs_error *error);
/** Before models are freed or moved. */
void adcgs_decoder_forget_drawn(adcgs_decoder *d);

#endif
