/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A thread that renders images, one at a time, so that the window stays responsive. It owns the decoder, and opens the stream
 * again for another number of layers. It decodes a part of an arriving stream before each image. The result of a job has to be
 * taken before the next job can be posted. The memory of a result belongs to the worker.
 */
#ifndef ADCGS_PLAY_WORKER_H
#define ADCGS_PLAY_WORKER_H

#include "media/sink.h"
#include "play/intake.h"

#include <limits.h>

typedef struct adcgs_play_job {
    adcgs_camera camera;
    double time;         /**< seconds */
    int layers;          /**< 1..5 */
    int tiers;           /**< 1..8 */
    int divider;         /**< of the window's resolution; not used by the worker */
    int number;          /**< of the frame in the stream; not used by the worker */
    int seeks;           /**< number of the user's jumps to other frames; not used by the worker */
    int pivot;           /**< number of a request for a pivot (adcgs_play_pivot()); 0: none */
    double pivot_at[2];  /**< its place: 0 to 1 over width and height */
    int again;           /**< of an arriving stream: the same image as before, rendered only if it has changed */
    adcgs_sink *sink;    /**< video output of the image; NULL: none */
    char path[PATH_MAX]; /**< file output of the image; "": none */
} adcgs_play_job;

typedef struct adcgs_play_result {
    adcgs_play_job job;
    adcgs_status status;
    adcgs_error error;  /**< the reason why there is no image */
    double seconds;     /**< render time */
    uint32_t splats;    /**< rendered splats */
    int has_pivot;      /**< nonzero: pivot is the answer to the request */
    double pivot[3];    /**< world units */
    const uint8_t *rgb; /**< [height][width][3], of the camera's size; NULL without a failure: the image has not changed */
    adcgs_come come;    /**< decoded part of an arriving stream */
} adcgs_play_result;

typedef struct adcgs_worker adcgs_worker;

/** The stream: its bytes, or their source. */
typedef struct adcgs_play_source {
    const char *path; /**< its name for messages */
    const uint8_t *data;
    size_t bytes;
    adcgs_feed *feed; /**< NULL: data is the whole stream */
} adcgs_play_source;

/**
 * The members of source must live as long as the worker. config->layers is ignored. The worker's thread calls wake(arg) when a
 * result is ready.
 */
adcgs_status adcgs_worker_create(adcgs_worker **out, const adcgs_play_source *source, const adcgs_config *config,
                                 void (*wake)(void *arg), void *arg, adcgs_error *error);
/** Waits for the current image. */
void adcgs_worker_free(adcgs_worker **worker);

/** \return 0 if the worker is rendering, or its last result was not taken: the job is not accepted then */
int adcgs_worker_post(adcgs_worker *worker, const adcgs_play_job *job);
/** The result of the last job, NULL if there is none yet. It lives until adcgs_worker_release(). */
const adcgs_play_result *adcgs_worker_result(adcgs_worker *worker);
/** Releases the result after use. */
void adcgs_worker_release(adcgs_worker *worker);

#endif
