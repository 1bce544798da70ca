/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The running player, for the files of this folder. */
#ifndef ADCGS_PLAY_PLAYER_H
#define ADCGS_PLAY_PLAYER_H

#include "play/key_frames.h"
#include "play/overlay.h"
#include "play/play.h"
#include "play/recording.h"
#include "play/scale.h"
#include "play/script.h"
#include "play/window.h"
#include "play/worker.h"

/** The position in a script. */
typedef struct adcgs_script_run {
    adcgs_script script;
    int at;        /**< the next or current line */
    int begun;     /**< the current line has begun */
    double since;  /**< when it began */
    long pictures; /**< images shown at that time */
    int failed;    /**< an expectation did not hold */
} adcgs_script_run;

typedef struct adcgs_player {
    const adcgs_play_settings *settings;
    const adcgs_sdl *sdl;
    adcgs_window *window;
    adcgs_worker *worker;
    adcgs_play_state state;
    adcgs_play_figures figures;
    adcgs_play_scale scale;
    adcgs_drawing overlay;
    adcgs_script_run run;
    adcgs_play_job job;    /**< the last one for the window; camera width 0 before the first */
    int least_divider;     /**< larger images cannot be rendered */
    int drawing;           /**< the worker has a job */
    int captured;          /**< the window holds the mouse */
    int full;              /**< the window is full screen */
    adcgs_key_frames keys; /**< set by the user */
    adcgs_recording recording;
    int last_frame;        /**< the last frame shown while playing; -1: none */
    int pivots;            /**< number of the last request for a pivot that the worker got */
    int seeks, last_seeks; /**< number of events that changed the frame: now, and when that frame was posted */
    int stale;             /**< the window's contents are not up to date */
    double shown;          /**< when the window was last rendered */
    double arrived;        /**< when the last image arrived */
    double period;         /**< mean seconds between the last images; 0: unknown */
    long pictures;         /**< shown so far */
    adcgs_come come;       /**< decoded part of the stream */
    adcgs_status failure;  /**< of the last image for the window, if no resolution can be rendered */
    adcgs_error failure_error;
    char shot[PATH_MAX];      /**< file of the requested or current screenshot; "": none */
    adcgs_status shot_status; /**< of the last screenshot */
    adcgs_error shot_error;
} adcgs_player;

/** True if the window shows exactly the image of the state, at full resolution, and nothing will change it. */
int adcgs_player_settled(const adcgs_player *player);
/** Notes that the whole stream is present. */
void adcgs_player_has_all(adcgs_player *player);
/** Gives the worker a job, if it is idle and there is one. */
void adcgs_player_post(adcgs_player *player);
/** Takes a result of the worker, if there is one: an image for the window, a screenshot, or a failure. */
adcgs_status adcgs_player_collect(adcgs_player *player, adcgs_error *error);
/** Renders the window; to rgb as well, if not NULL. */
adcgs_status adcgs_player_show(adcgs_player *player, uint8_t *rgb, adcgs_error *error);

#endif
