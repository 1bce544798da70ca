/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A thread that draws pictures, one at a time, so that the window answers
 * while it does. It owns the decoder, and opens the stream anew for another
 * number of layers. Of a stream that is still coming it decodes some before
 * each picture. Who posts a job gets its result before the next job can
 * be posted; what the result points to is the worker's.
 */
#ifndef ADCGS_PLAY_WORKER_H
#define ADCGS_PLAY_WORKER_H

#include "io/sink.h"
#include "play/intake.h"

#include <limits.h>

typedef struct adcgs_play_job {
    adcgs_camera camera;
    double time;         /**< seconds */
    int layers;          /**< 1..5 */
    int tiers;           /**< 1..8 */
    int divider;         /**< of the window's resolution; nothing to the worker */
    int number;          /**< of the frame in the stream; nothing to the worker */
    int seeks;           /**< times that the user had gone to another frame; nothing to the worker */
    int again;           /**< of a stream that is coming: the picture that was drawn last, to be drawn only if it has changed */
    adcgs_sink *sink;    /**< a video to write the picture to; NULL: none */
    char path[PATH_MAX]; /**< a file to write the picture to; "": none */
} adcgs_play_job;

typedef struct adcgs_play_result {
    adcgs_play_job job;
    adcgs_status status;
    adcgs_error error;    /**< why there is no picture */
    double seconds;       /**< that drawing took */
    uint32_t splats;      /**< that are drawn */
    const uint8_t *rgb;   /**< [height][width][3], of the camera's size; NULL without a failure: there is nothing else to see */
    adcgs_come come;      /**< how much of a stream that is coming has been decoded */
} adcgs_play_result;

typedef struct adcgs_worker adcgs_worker;

/** The stream: its bytes, or where they come from. */
typedef struct adcgs_play_source {
    const char *path;     /**< its name for messages */
    const uint8_t *data;
    size_t bytes;
    adcgs_feed *feed;     /**< NULL: data are all there is */
} adcgs_play_source;

/**
 * What source names must live as long as the worker. config->layers is not looked at. wake(arg) is called from the worker's
 * thread when a result is there.
 */
adcgs_status adcgs_worker_create(adcgs_worker **out, const adcgs_play_source *source, const adcgs_config *config,
                                 void (*wake)(void *arg), void *arg, adcgs_error *error);
/** Waits for the picture that is being drawn. */
void adcgs_worker_free(adcgs_worker **worker);

/** \return 0 when the worker is drawing, or its last result was not taken: then the job is not accepted. */
int adcgs_worker_post(adcgs_worker *worker, const adcgs_play_job *job);
/** The result of the last job, NULL while there is none. It lives until adcgs_worker_release(). */
const adcgs_play_result *adcgs_worker_result(adcgs_worker *worker);
/** The result was taken. */
void adcgs_worker_release(adcgs_worker *worker);

#endif
