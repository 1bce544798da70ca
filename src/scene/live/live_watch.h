/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A thread that looks for footage and records when a stretch of time is complete, and the cuts between stretches. */
#ifndef ADCGS_SCENE_LIVE_LIVE_WATCH_H
#define ADCGS_SCENE_LIVE_LIVE_WATCH_H

#include "scene/live/live_camera.h"

#include <poll.h>
#include <pthread.h>
#include <stdatomic.h>

typedef struct adcgs_live_watch {
    /* Set before the thread starts; see live_scene.h. */
    double seconds;
    int unbounded;
    int (*interrupted)(void);
    int goes_on; /**< continues a stream whose last segment has this span */
    double span[2];
    char *end_path; /**< path of the file that ends the footage */
    char *folder;   /**< for footage from pipes; "" without pipes */
    uint32_t n;
    adcgs_source_camera *sources; /**< [n] */
    adcgs_live_camera *cameras;   /**< [n], their frames are protected by the lock */

    atomic_int wanted; /**< number of threads that wait for the lock */
    pthread_t thread;
    int has_thread;
    struct pollfd *pipes; /**< [n], used by the thread only */
    pthread_mutex_t lock; /**< protects the members below */
    pthread_cond_t changed;
    uint32_t taken;      /**< stretches that were given or skipped */
    uint32_t n_complete; /**< complete stretches */
    uint32_t n_passed;   /**< complete stretches that the stream to continue already has */
    double *came;        /**< [n_complete - n_passed] when the others were completed, by adcgs_seconds() */
    double last;         /**< time in seconds of the last available frame; -INFINITY: none */
    int is_placed;       /**< the position for continuing is known */
    int is_over, stop;   /**< no more footage will arrive; the thread is to end */
    adcgs_error error;   /**< the thread's error */
} adcgs_live_watch;

/** Starts the thread. ADCGS_ERR_MEMORY. Call adcgs_live_watch_stop() afterwards in any case; the caller owns the cameras. */
adcgs_status adcgs_live_watch_start(adcgs_live_watch *watch, adcgs_error *error);
void adcgs_live_watch_stop(adcgs_live_watch *watch);
/** Takes the lock with priority over the thread; pthread_mutex_unlock() releases it as usual. */
void adcgs_live_lock(adcgs_live_watch *watch);
/** Waits, with the lock held, for the stretch after those taken, or for the end of footage. Returns the thread's error. */
adcgs_status adcgs_live_await(adcgs_live_watch *watch, adcgs_error *error);

/* Times. Rates must be known, as they are once a stretch is complete. */

/** Tolerance in seconds within which times are equal. */
double adcgs_live_within(const adcgs_live_watch *watch);
/** Start of a stretch in seconds: the time of the frame of any camera nearest to the stretch's multiple. */
double adcgs_live_cut(const adcgs_live_watch *watch, uint32_t stretch);
/** The stretch that contains a time: after its start, or at its end. user is the watch. */
uint32_t adcgs_live_stretch(void *user, double time);
/** The frames of a camera in a stretch: the first one, and the first one after it. */
void adcgs_live_frames(const adcgs_live_watch *watch, const adcgs_live_camera *camera, uint32_t stretch, int64_t span[2]);
/** The first frame in the Y4M file of a stretch. */
int64_t adcgs_live_first_of_file(const adcgs_live_watch *watch, const adcgs_live_camera *camera, uint32_t stretch);
/** Limits with the members that name a camera's files. */
adcgs_live_limits adcgs_live_limits_of(adcgs_live_watch *watch, uint32_t camera);

#endif
