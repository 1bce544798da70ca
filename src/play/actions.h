/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What keys do to the player's state, and what is said of it. */
#ifndef ADCGS_PLAY_ACTIONS_H
#define ADCGS_PLAY_ACTIONS_H

#include "play/state.h"

/** A line of the help page. */
typedef struct adcgs_play_help {
    const char *keys, *text;
    int window; /**< of windows alone: in a page of a browser there is nothing that these keys do */
} adcgs_play_help;

/** What a key does that is pressed; again: that is being held. */
void adcgs_play_act(adcgs_play_state *state, int key, int again);
/** Show a message for a few seconds. */
void adcgs_play_say(adcgs_play_state *state, const char *format, ...) ADCGS_PRINTF(2, 3);
/** The help page: n lines. */
const adcgs_play_help *adcgs_play_help_lines(int *n);

#endif
