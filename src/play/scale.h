/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * At what part of the window's resolution a moving picture is drawn: 1/1, 1/2,
 * ..., and behind 1/2 with how many of the stream's tiers, so that drawing fits
 * into a frame's time. It becomes coarser after two pictures that took too
 * long, and finer only after many that left so much time that the finer ones
 * will fit too: it does not flicker between the two.
 */
#ifndef ADCGS_PLAY_SCALE_H
#define ADCGS_PLAY_SCALE_H

#define ADCGS_PLAY_DIVIDER_MAX 8

typedef struct adcgs_play_scale {
    int divider;    /**< 1..ADCGS_PLAY_DIVIDER_MAX */
    int tiers, all; /**< of the stream: that are drawn; that there are */
    int slow, fast; /**< pictures in a row that took too long, or would fit at the finer resolution */
} adcgs_play_scale;

/** tiers: that the stream has. */
void adcgs_play_scale_init(adcgs_play_scale *scale, int tiers);
/** A picture drawn at the present divider, of the present tiers, took so many seconds, of so many that it should take at most. */
void adcgs_play_scale_took(adcgs_play_scale *scale, double seconds, double budget);
/** Pictures of the present size cannot be drawn at all. \return whether there is a smaller one. */
int adcgs_play_scale_coarser(adcgs_play_scale *scale);

#endif
