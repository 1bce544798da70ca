/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The effects of keys on the player's state, and the help page. */
#ifndef ADCGS_PLAY_ACTIONS_H
#define ADCGS_PLAY_ACTIONS_H

#include "play/play_state.h"

/** A line of the help page. */
typedef struct adcgs_play_help {
    const char *keys, *text;
    int window; /**< only for windows: these keys have no effect in a browser's page */
} adcgs_play_help;

/** Performs the action of a pressed key; again: the key is held. */
void adcgs_play_act(adcgs_play_state *state, int key, int again);
/** Shows a message for a few seconds. */
void adcgs_play_say(adcgs_play_state *state, const char *format, ...) ADCGS_PRINTF(2, 3);
/** The help page: n lines. */
const adcgs_play_help *adcgs_play_help_lines(int *n);

#endif
