/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The player: a stream in a window, with a camera that the user moves. */
#ifndef ADCGS_PLAY_PLAY_H
#define ADCGS_PLAY_PLAY_H

#include "cli/cli.h"
#include "play/filmed_view.h"
#include "play/worker.h"

typedef struct adcgs_play_settings {
    const adcgs_cli *cli;               /**< for remarks */
    adcgs_play_source source;           /**< the stream; its path also serves messages, the title, and names of screenshots */
    adcgs_config config;                /**< layers: initial number, 0: all */
    adcgs_info info;                    /**< of the stream with all its layers; of an arriving stream, according to its header */
    const adcgs_filmed_camera *cameras; /**< stored in the stream, [info.cameras] */
    adcgs_filmed_view *filmed;          /**< the filmed path and region */
    adcgs_camera home;                  /**< first view */
    int is_span;                        /**< the time range was requested, and stays, even if more of the stream arrives */
    double begin, end;                  /**< time range, seconds */
    double start;                       /**< start in the time range, seconds */
    int paused;                         /**< starts without playing */
    int size[2];                        /**< of the window, pixels; 0, 0: by the camera */
    const char *script;                 /**< a file of commands (see script.h); NULL: none */
    int (*interrupted)(void);           /**< true if the player must leave at once */
} adcgs_play_settings;

/**
 * Plays until the user leaves. An arriving stream with a fault is played up to the fault. The window shows the fault, and the
 * player ends with it.
 *
 * Without a display ADCGS_ERR_IO, without SDL ADCGS_ERR_UNSUPPORTED. *failed is set if an expectation of the script did not hold;
 * error then names it in one line, though the status is ADCGS_OK.
 */
adcgs_status adcgs_play_run(const adcgs_play_settings *settings, int *failed, adcgs_error *error);

#endif
