/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A camera whose footage comes while it is taken: numbered pictures that appear in a folder, or a growing file, a pipe, or
 * standard input, of Y4M. Its frames are decided in order: each is there, or it is missing and nobody waits for it any more.
 *
 * Pictures stay where they are. What a pipe brings is kept in files of Y4M, one for each stretch of time, until it is learnt.
 */
#ifndef ADCGS_LAYOUTS_LIVE_CAMERA_H
#define ADCGS_LAYOUTS_LIVE_CAMERA_H

#include "io/y4m_shape.h"
#include "layouts/scene_file.h"

#include <stdio.h>
#include <sys/types.h>

typedef struct adcgs_live_camera {
    const adcgs_source_camera *source;
    adcgs_fps rate;       /**< not known before a video's first line has come, unless the scene file says it */
    double offset;        /**< seconds of frame 0 from the beginning of the scene */
    int width, height;    /**< of its pictures; 0: none has come yet */
    int64_t next;         /**< the first frame that is not decided */
    int64_t first;        /**< frames before this one are passed over */
    uint8_t *there;       /**< [next - base] whether frames are there; those before base are forgotten */
    int64_t base, capacity;
    int64_t n_missing, first_missing; /**< so far; the first of them */
    int is_over;          /**< no more will come */

    /* Pictures. */
    int64_t refused;      /**< a frame whose file, as it was, could not be read; -1: none */
    off_t refused_bytes;
    struct timespec refused_time;

    /* Y4M. */
    int fd;               /**< -1: not open */
    int is_pipe;          /**< likewise standard input, whatever that is */
    int has_begun;        /**< bytes have come */
    int waits;            /**< for bytes that have not */
    adcgs_y4m_shape shape;
    char line[ADCGS_Y4M_LINE_MAX + 1]; /**< the first one */
    char text[ADCGS_Y4M_LINE_MAX + 1]; /**< of the line at hand */
    size_t text_bytes;
    size_t left;          /**< bytes of the frame at hand that have yet to come */
    uint8_t *held;        /**< read, not yet used */
    size_t held_begin, held_end;
    FILE *spool;          /**< for the stretch at hand */
    uint32_t stretch;
} adcgs_live_camera;

/** What a camera is told when it looks for more. */
typedef struct adcgs_live_limits {
    double until;         /**< frames taken later are left where they are; seconds */
    double given_up;      /**< pictures taken earlier are not waited for */
    int is_end;           /**< nothing more will come */
    const char *folder;   /**< for what pipes bring */
    uint32_t index;       /**< of the camera, to name files */
    uint32_t (*stretch)(void *user, double time); /**< that a frame belongs to; only asked once rates are known */
    void *user;
} adcgs_live_limits;

/** Without footage so far. begin: seconds of the source's time at which the scene begins. */
void adcgs_live_camera_init(adcgs_live_camera *camera, const adcgs_source_camera *source, double begin);
void adcgs_live_camera_clear(adcgs_live_camera *camera);

/** Seconds of a frame from the beginning of the scene; the rate is known. */
double adcgs_live_camera_time(const adcgs_live_camera *camera, int64_t frame);
/** The first frame at or after a time, to within. */
int64_t adcgs_live_camera_from(const adcgs_live_camera *camera, double time, double within);
/** Whether a frame that is decided is there. */
int adcgs_live_camera_has(const adcgs_live_camera *camera, int64_t frame);
/** Before any is decided: frames before this one are of no interest. */
void adcgs_live_camera_pass_over(adcgs_live_camera *camera, int64_t frame);
/** Forget frames before this one. */
void adcgs_live_camera_forget(adcgs_live_camera *camera, int64_t frame);
/** The file of a frame: a picture, or of a stretch; from malloc(), NULL without memory. */
char *adcgs_live_camera_path(const adcgs_live_camera *camera, int64_t frame, const adcgs_live_limits *limits, uint32_t stretch);

/** Read the first line of a video, as far as it has come. */
adcgs_status adcgs_live_camera_begin(adcgs_live_camera *camera, adcgs_error *error);
/** Decide the next frame, if that can be done now; the rate is known. *progress: set to 1 if something came. */
adcgs_status adcgs_live_camera_look(adcgs_live_camera *camera, const adcgs_live_limits *limits, int *progress,
                                    adcgs_error *error);

#endif
