/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The player: a stream in a window, with a camera in the user's hand. */
#ifndef ADCGS_PLAY_PLAY_H
#define ADCGS_PLAY_PLAY_H

#include "play/worker.h"

typedef struct adcgs_play_settings {
    adcgs_play_source source;    /**< the stream; its path is for messages, the title, and names of screenshots, too */
    adcgs_config config;         /**< layers: those to begin with, 0: all */
    adcgs_info info;             /**< of the stream with all its layers; of one that is coming, what its header says */
    const adcgs_camera *cameras; /**< stored in the stream, [info.cameras] */
    adcgs_camera home;           /**< where to begin */
    int is_span;                 /**< what to play was asked for, and stays as it is, whatever comes */
    double begin, end;           /**< what to play, seconds */
    double start;                /**< where to begin in it */
    int paused;                  /**< begin without playing */
    int size[2];                 /**< of the window, pixels; 0, 0: what suits the camera */
    const char *script;          /**< a file of commands (see script.h); NULL: none */
    int (*interrupted)(void);    /**< whether to leave at once */
} adcgs_play_settings;

/**
 * Play until the user leaves. A stream that is coming and has a fault is played as far as it came; the fault is said in the
 * window, and is what the player ends with.
 *
 * Without a display ADCGS_ERR_IO, without SDL ADCGS_ERR_UNSUPPORTED. *failed is set when an
 * expectation of the script did not hold; error then says in one line which, though the status is ADCGS_OK.
 */
adcgs_status adcgs_play_run(const adcgs_play_settings *settings, int *failed, adcgs_error *error);

#endif
