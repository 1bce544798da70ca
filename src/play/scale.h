/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The resolution of moving images, 1/1, 1/2, ... of the window's, and, below 1/4, the number of the stream's tiers. They are
 * chosen so that rendering fits into a frame's time. The resolution falls after two images that took too long. It rises only
 * after many images that were so fast that finer ones will fit, too, so that it does not flicker between the two.
 */
#ifndef ADCGS_PLAY_SCALE_H
#define ADCGS_PLAY_SCALE_H

#define ADCGS_PLAY_DIVIDER_MAX 8 /**< of the resolution; chosen by hand, not measured */

typedef struct adcgs_play_scale {
    int divider;    /**< 1..ADCGS_PLAY_DIVIDER_MAX */
    int tiers, all; /**< tiers of the stream: rendered, and present */
    int slow, fast; /**< consecutive images that took too long, or would fit at the finer resolution */
} adcgs_play_scale;

/** tiers: of the stream. */
void adcgs_play_scale_init(adcgs_play_scale *scale, int tiers);
/** Notes that an image with the present divider and tiers took `seconds`, of at most `budget` seconds. */
void adcgs_play_scale_took(adcgs_play_scale *scale, double seconds, double budget);
/** Reduces the size, since images of the present one cannot be rendered at all. \return nonzero if there is a smaller size */
int adcgs_play_scale_coarser(adcgs_play_scale *scale);

#endif
