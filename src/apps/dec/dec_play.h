/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --play. */
#ifndef ADCGS_APPS_DEC_DEC_PLAY_H
#define ADCGS_APPS_DEC_DEC_PLAY_H

#include "camera/path.h"
#include "cli/cli.h"

/** Settings of the command line for playing. */
typedef struct adcgs_dec_play {
    const adcgs_cli *cli;              /**< for remarks */
    const char *input;                 /**< the stream's file */
    const char *script;                /**< NULL: the user plays */
    adcgs_camera_path_request request; /**< its camera is the first view; a single time starts paused; the window's size */
    adcgs_config config;
} adcgs_dec_play;

/**
 * Plays until the user leaves. *failed is set if an expectation of the script did not hold; error then names it, though the
 * status is ADCGS_OK.
 */
adcgs_status adcgs_dec_play_run(const adcgs_dec_play *how, int *failed, adcgs_error *error);

#endif
