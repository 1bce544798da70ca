/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Movements of the view by hand. */
#include "config.h"

#include "play/by_hand.h"

void adcgs_play_request_pivot(adcgs_play_state *state, double x, double y)
{
    state->pivots++;
    state->pivot_at[0] = x;
    state->pivot_at[1] = y;
}

void adcgs_play_placed(adcgs_play_state *state)
{
    state->pivot_chosen = 0;
    adcgs_play_request_pivot(state, 0.5, 0.5);
}

void adcgs_play_pivot(adcgs_play_state *state, int number, const double point[3])
{
    if (number != state->pivots || number == state->pivot_answered)
        return;
    state->pivot_answered = number;
    adcgs_orbit_control_pivot(&state->control, point);
    if (!state->filmed)
        return;
    if (number == 1)
        adcgs_view_limit_scale(&state->filmed->limit, adcgs_orbit_control_distance(&state->control));
    if (state->filmed->following) {
        const int beside = state->filmed->beside;
        adcgs_filmed_view_moved(state->filmed, &state->control);
        state->filmed->beside = beside;
    }
}

double adcgs_play_outside(const adcgs_play_state *state)
{
    return state->filmed ? adcgs_filmed_view_outside(state->filmed, &state->control) : 0.0;
}

void adcgs_hand_orbit(adcgs_orbit_control *control, const double by[3])
{
    adcgs_orbit_control_orbit(control, by[0], by[1]);
}

void adcgs_hand_look(adcgs_orbit_control *control, const double by[3])
{
    adcgs_orbit_control_look(control, by[0], by[1]);
}

void adcgs_hand_pan(adcgs_orbit_control *control, const double by[3])
{
    adcgs_orbit_control_pan(control, by[0], by[1]);
}

void adcgs_hand_zoom(adcgs_orbit_control *control, const double by[3])
{
    adcgs_orbit_control_zoom(control, by[0]);
}

void adcgs_hand_fly(adcgs_orbit_control *control, const double by[3])
{
    adcgs_orbit_control_fly(control, by[0], by[1], by[2]);
}

void adcgs_play_move(adcgs_play_state *state, adcgs_hand_move move, double x, double y, double z)
{
    const adcgs_orbit_control before = state->control;
    const double by[3] = {x, y, z};
    state->moved = state->now;
    state->jumped = -1;
    *state->control.camera.name = 0; /* it is no longer the stored camera */
    move(&state->control, by);
    if (!state->filmed)
        return;
    const double share = adcgs_filmed_view_share(state->filmed, &before, &state->control);
    if (share < 1) {
        const double less[3] = {share * x, share * y, share * z};
        state->control = before;
        *state->control.camera.name = 0;
        move(&state->control, less);
    }
    if (state->filmed->following)
        adcgs_filmed_view_moved(state->filmed, &state->control);
}

void adcgs_play_pinch(adcgs_play_state *state, double dx, double dy, double steps)
{
    adcgs_camera view;
    adcgs_orbit_control_view(&state->control, state->width, state->height, &view);
    adcgs_play_move(state, adcgs_hand_pan, dx / view.fx, dy / view.fy, 0);
    adcgs_play_move(state, adcgs_hand_zoom, steps, 0, 0);
}
