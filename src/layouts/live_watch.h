/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A thread that looks for footage, notes when a stretch of time is complete, and where time is cut into stretches. */
#ifndef ADCGS_LAYOUTS_LIVE_WATCH_H
#define ADCGS_LAYOUTS_LIVE_WATCH_H

#include "layouts/live_camera.h"

#include <poll.h>
#include <pthread.h>
#include <stdatomic.h>

typedef struct adcgs_live_watch {
    /* Set before it starts; see live.h. */
    double seconds;
    int unbounded;
    int (*interrupted)(void);
    int goes_on;           /**< from a stream whose last segment has this span */
    double span[2];
    char *end_path;        /**< of the file that says that footage ends */
    char *folder;          /**< for what pipes bring; "" where there is none */
    uint32_t n;
    adcgs_source_camera *sources; /**< [n] */
    adcgs_live_camera *cameras;   /**< [n], whose frames are under the lock */

    atomic_int wanted;     /**< somebody waits for the lock */
    pthread_t thread;
    int has_thread;
    struct pollfd *pipes;  /**< [n], the thread's alone */
    pthread_mutex_t lock;  /**< for what follows */
    pthread_cond_t changed;
    uint32_t taken;        /**< stretches that were given, or passed over */
    uint32_t n_complete;   /**< stretches that are */
    uint32_t n_passed;     /**< of them, those that a stream has which goes on */
    double *came;          /**< [n_complete - n_passed] when the others were, by adcgs_seconds() */
    double last;           /**< seconds of the last frame that is there; -INFINITY: none */
    int is_placed;         /**< where it goes on is known */
    int is_over, stop;     /**< nothing more will come; the thread is to leave */
    adcgs_error error;     /**< of the thread */
} adcgs_live_watch;

/** ADCGS_ERR_MEMORY. adcgs_live_watch_stop() afterwards in any case; cameras are the caller's. */
adcgs_status adcgs_live_watch_start(adcgs_live_watch *watch, adcgs_error *error);
void adcgs_live_watch_stop(adcgs_live_watch *watch);
/** Take the lock, ahead of the thread, for which it is unlocked as any other. */
void adcgs_live_lock(adcgs_live_watch *watch);
/** With the lock: until the stretch behind those that were taken is complete, or nothing more will come. What the thread met. */
adcgs_status adcgs_live_await(adcgs_live_watch *watch, adcgs_error *error);

/* Time: rates are known, as they are once a stretch is complete. */

/** How near times are that are one. */
double adcgs_live_within(const adcgs_live_watch *watch);
/** Seconds at which a stretch begins: those of the frame of any camera that is nearest to its multiple. */
double adcgs_live_cut(const adcgs_live_watch *watch, uint32_t stretch);
/** The stretch at whose end or before it a time is, and behind the one in front; user is the watch. */
uint32_t adcgs_live_stretch(void *user, double time);
/** The frames of a camera in a stretch: the first, and the first behind it. */
void adcgs_live_frames(const adcgs_live_watch *watch, const adcgs_live_camera *camera, uint32_t stretch, int64_t span[2]);
/** The first frame in the file that a video's footage of a stretch goes to. */
int64_t adcgs_live_first_of_file(const adcgs_live_watch *watch, const adcgs_live_camera *camera, uint32_t stretch);
/** What names a camera's files. */
adcgs_live_limits adcgs_live_limits_of(adcgs_live_watch *watch, uint32_t camera);

#endif
