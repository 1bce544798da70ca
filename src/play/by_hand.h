/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Movements of the view by hand, their limit, and the centre of an orbit. */
#ifndef ADCGS_PLAY_BY_HAND_H
#define ADCGS_PLAY_BY_HAND_H

#include "play/play_state.h"

/** A movement of the camera, by up to three numbers. */
typedef void (*adcgs_hand_move)(adcgs_orbit_control *control, const double by[3]);

void adcgs_hand_orbit(adcgs_orbit_control *control, const double by[3]); /**< yaw, pitch */
void adcgs_hand_look(adcgs_orbit_control *control, const double by[3]);  /**< yaw, pitch */
void adcgs_hand_pan(adcgs_orbit_control *control, const double by[3]);   /**< right, down */
void adcgs_hand_zoom(adcgs_orbit_control *control, const double by[3]);  /**< steps */
void adcgs_hand_fly(adcgs_orbit_control *control, const double by[3]);   /**< right, down, forward */

/** Moves the view, the less the further it would get outside of the filmed region. */
void adcgs_play_move(adcgs_play_state *state, adcgs_hand_move move, double x, double y, double z);
/** Moves the view as two fingers do: pans by pixels, and zooms by steps of the wheel. */
void adcgs_play_pinch(adcgs_play_state *state, double dx, double dy, double steps);
/** How far the view is outside of the filmed region: 0 inside, 1 at most. */
double adcgs_play_outside(const adcgs_play_state *state);

/** Asks for the point under a place of the image, 0 to 1 over width and height, as the centre of the orbit. */
void adcgs_play_request_pivot(adcgs_play_state *state, double x, double y);
/** Answers the last request, which has this number, with a point of the scene; others are ignored. */
void adcgs_play_pivot(adcgs_play_state *state, int number, const double point[3]);
/** The view was set to a camera: it gets a new pivot. */
void adcgs_play_placed(adcgs_play_state *state);

#endif
