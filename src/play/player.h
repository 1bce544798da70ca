/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The running player, for the files of this room. */
#ifndef ADCGS_PLAY_PLAYER_H
#define ADCGS_PLAY_PLAYER_H

#include "play/key_frames.h"
#include "play/overlay.h"
#include "play/play.h"
#include "play/recording.h"
#include "play/scale.h"
#include "play/script.h"
#include "play/worker.h"

/** Where a script is. */
typedef struct adcgs_script_run {
    adcgs_script script;
    int at;            /**< the line that is next, or being done */
    int begun;         /**< that line is being done */
    double since;      /**< when it was begun */
    long pictures;     /**< that had been shown then */
    int failed;        /**< an expectation did not hold */
} adcgs_script_run;

typedef struct adcgs_player {
    const adcgs_play_settings *settings;
    const adcgs_sdl *sdl;
    adcgs_window *window;
    adcgs_worker *worker;
    adcgs_play_state state;
    adcgs_play_figures figures;
    adcgs_play_scale scale;
    adcgs_panel panels[ADCGS_PANELS];
    adcgs_script_run run;
    adcgs_play_job job;      /**< the last one for the window; of camera width 0 before the first */
    int least_divider;       /**< pictures any larger cannot be drawn */
    int drawing;             /**< the worker has a job */
    int captured;            /**< the window holds the mouse */
    int full;                /**< the window has the whole screen */
    adcgs_key_frames keys;   /**< those that the user has set */
    adcgs_recording recording;
    int last_frame;          /**< the frame shown last while playing; -1: none */
    int seeks, last_seeks;   /**< times that an event changed the frame: by now, and when that one was posted */
    int stale;               /**< what the window shows is not the last word */
    double shown;            /**< when the window was drawn last */
    double arrived;          /**< when the last picture came */
    double period;           /**< seconds between pictures, on the mean of the last ones; 0: not known */
    long pictures;           /**< shown so far */
    adcgs_come come;         /**< how much of the stream has been decoded */
    adcgs_status failure;    /**< of the last picture for the window, if it cannot be drawn at any resolution */
    adcgs_error failure_error;
    char shot[PATH_MAX];     /**< file of the screenshot that is to be made or being made; "": none */
    adcgs_status shot_status; /**< of the last one */
    adcgs_error shot_error;
} adcgs_player;

/** Whether the window shows the very picture that the state stands for, at full resolution, and nothing will change it. */
int adcgs_player_settled(const adcgs_player *player);
/** Of a stream that is all there: so it is. */
void adcgs_player_has_all(adcgs_player *player);
/** Give the worker something to do, if it has nothing and there is something. */
void adcgs_player_post(adcgs_player *player);
/** Take what the worker has done, if anything: a picture into the window, a screenshot, or a failure. */
adcgs_status adcgs_player_collect(adcgs_player *player, adcgs_error *error);
/** Draw the window; to rgb as well, if not NULL. */
adcgs_status adcgs_player_show(adcgs_player *player, uint8_t *rgb, adcgs_error *error);

#endif
