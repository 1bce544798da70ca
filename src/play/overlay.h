/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The overlay on the image: time bar, statistics, help, message. */
#ifndef ADCGS_PLAY_OVERLAY_H
#define ADCGS_PLAY_OVERLAY_H

#include "play/play_state.h"
#include "play/window.h"

/** Figures that are not in the state. */
typedef struct adcgs_play_figures {
    double seconds;    /**< render time of the last image */
    double rate;       /**< images per second; 0: none recently */
    int width, height; /**< of the last image */
    uint32_t splats;   /**< rendered splats */
    int tiers;         /**< rendered tiers of the stream */
    long dropped;      /**< frames skipped during playback */
    char coming[160];  /**< received part of the stream; "": all of it has arrived */
} adcgs_play_figures;

/** Renders the panels, from the lowest to the uppermost; hidden ones have width 0. Free them with adcgs_panel_free(). */
void adcgs_overlay_draw(adcgs_panel panels[ADCGS_PANELS], const adcgs_play_state *state, const adcgs_play_figures *figures);

#endif
