/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A camera whose footage arrives while it is recorded: numbered images that appear in a folder, or Y4M from a growing file, a
 * pipe or standard input. Frames are decided in order: each is available, or it is missing and no longer waited for.
 *
 * Images stay where they are. Footage from a pipe is kept in Y4M files, one for each stretch of time, until training is done
 * with it.
 */
#ifndef ADCGS_SCENE_LIVE_LIVE_CAMERA_H
#define ADCGS_SCENE_LIVE_LIVE_CAMERA_H

#include "media/video/y4m_shape.h"
#include "scene/layouts/scene_file.h"

#include <stdio.h>
#include <sys/types.h>

typedef struct adcgs_live_camera {
    const adcgs_source_camera *source;
    adcgs_fps rate;    /**< unknown before a video's first line has arrived, unless the scene file gives it */
    double offset;     /**< time of frame 0 in seconds, from the beginning of the scene */
    int width, height; /**< of its images; 0: none has arrived yet */
    int64_t next;      /**< the first undecided frame */
    int64_t first;     /**< earlier frames are skipped */
    uint8_t *there;    /**< [next - base] availability of frames; frames before base are forgotten */
    int64_t base, capacity;
    int64_t n_missing, first_missing; /**< number so far, and the first of them */
    int is_over;                      /**< no more footage will arrive */

    /* Images. */
    int64_t refused; /**< a frame whose file could not be read in its state at the time; -1: none */
    off_t refused_bytes;
    struct timespec refused_time;

    /* Y4M. */
    int fd;        /**< -1: not open */
    int is_pipe;   /**< nonzero for standard input of any kind */
    int has_begun; /**< bytes have arrived */
    int waits;     /**< it waits for bytes */
    adcgs_y4m_shape shape;
    char line[ADCGS_Y4M_LINE_MAX + 1]; /**< the first line */
    char text[ADCGS_Y4M_LINE_MAX + 1]; /**< the current line */
    size_t text_bytes;
    size_t left;   /**< bytes of the current frame that have not arrived yet */
    uint8_t *held; /**< bytes read but not yet used */
    size_t held_begin, held_end;
    FILE *spool; /**< for the current stretch */
    uint32_t stretch;
} adcgs_live_camera;

/** Limits for a camera that looks for footage. */
typedef struct adcgs_live_limits {
    double until;                                 /**< in seconds; frames taken later are not read yet */
    double given_up;                              /**< images taken earlier are not waited for */
    int is_end;                                   /**< no more footage will arrive */
    const char *folder;                           /**< for footage from pipes */
    uint32_t index;                               /**< of the camera, for names of files */
    uint32_t (*stretch)(void *user, double time); /**< the stretch of a frame; called once rates are known */
    void *user;
} adcgs_live_limits;

/** Initialises a camera without footage. begin: time of the scene's beginning in seconds of the source's time. */
void adcgs_live_camera_init(adcgs_live_camera *camera, const adcgs_source_camera *source, double begin);
void adcgs_live_camera_clear(adcgs_live_camera *camera);

/** Time of a frame in seconds from the beginning of the scene; the rate must be known. */
double adcgs_live_camera_time(const adcgs_live_camera *camera, int64_t frame);
/** The first frame at or after a time, with tolerance `within`. */
int64_t adcgs_live_camera_from(const adcgs_live_camera *camera, double time, double within);
/** True if a decided frame is available. */
int adcgs_live_camera_has(const adcgs_live_camera *camera, int64_t frame);
/** Skips all frames before this one. Call it before any frame is decided. */
void adcgs_live_camera_pass_over(adcgs_live_camera *camera, int64_t frame);
/** Forgets frames before this one. */
void adcgs_live_camera_forget(adcgs_live_camera *camera, int64_t frame);
/** The file of a frame: an image, or the Y4M file of a stretch; from malloc(), NULL on allocation failure. */
char *adcgs_live_camera_path(const adcgs_live_camera *camera, int64_t frame, const adcgs_live_limits *limits, uint32_t stretch);

/** Reads the first line of a video, as far as it has arrived. */
adcgs_status adcgs_live_camera_begin(adcgs_live_camera *camera, adcgs_error *error);
/** Decides the next frame, if possible now; the rate must be known. *progress becomes 1 if something arrived. */
adcgs_status adcgs_live_camera_look(adcgs_live_camera *camera, const adcgs_live_limits *limits, int *progress,
                                    adcgs_error *error);

#endif
