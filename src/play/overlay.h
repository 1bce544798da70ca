/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The overlay on the image: controls, statistics, help, hint, message. */
#ifndef ADCGS_PLAY_OVERLAY_H
#define ADCGS_PLAY_OVERLAY_H

#include "play/drawing.h"
#include "play/play_state.h"

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

/** True while the hint of the help is shown: from the start, until a key or some seconds later. */
int adcgs_overlay_hints(const adcgs_play_state *state);
/** Fills the drawing; everything is inside the window. */
void adcgs_overlay_draw(adcgs_drawing *drawing, const adcgs_type *type, const adcgs_play_state *state,
                        const adcgs_play_figures *figures);

#endif
