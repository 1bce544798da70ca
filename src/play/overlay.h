/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What is laid over the picture: time bar, statistics, help, message. */
#ifndef ADCGS_PLAY_OVERLAY_H
#define ADCGS_PLAY_OVERLAY_H

#include "play/state.h"
#include "play/window.h"

/** What the state does not know. */
typedef struct adcgs_play_figures {
    double seconds;     /**< that the last picture took to draw */
    double rate;        /**< pictures in a second; 0: none came lately */
    int width, height;  /**< of the last picture */
    uint32_t splats;    /**< that are drawn */
    int tiers;          /**< of the stream, that are */
    long dropped;       /**< frames left out while playing */
    char coming[160];   /**< how much of the stream has come; "": all of it */
} adcgs_play_figures;

/** Panels, from the lowest to the uppermost; those that are not shown have width 0. Free them with adcgs_panel_free(). */
void adcgs_overlay_draw(adcgs_panel panels[ADCGS_PANELS], const adcgs_play_state *state, const adcgs_play_figures *figures);

#endif
