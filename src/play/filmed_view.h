/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The view and the cameras that filmed: it follows a filmed path, is moved next to it by the user, and resists where nothing was
 * filmed.
 */
#ifndef ADCGS_PLAY_FILMED_VIEW_H
#define ADCGS_PLAY_FILMED_VIEW_H

#include "camera/follow.h"
#include "camera/orbit_control.h"
#include "camera/view_limit.h"
#include "play/play_clock.h"

typedef struct adcgs_filmed_view {
    adcgs_follow follow; /**< the first path of the stream */
    adcgs_view_limit limit;
    int following;     /**< nonzero: the view moves with the path's camera */
    int beside;        /**< nonzero: the user moved the view away from that camera */
    int unlimited;     /**< nonzero: the user may leave the filmed region */
    double base[12];   /**< pose of the path's camera */
    double offset[12]; /**< pose of the view in the axes of that camera, as the user placed it */
    double part;       /**< of that offset which is in use, 0 to 1: less while the whole would lead outside */
    double target[3];  /**< centre of the orbit in these axes */
    int turns;         /**< of the clock, at the last tick */
    int returning;     /**< nonzero: in a loop, the view is on its way from the path's end to its start */
    double end[12];    /**< where it began that way */
} adcgs_filmed_view;

/** cameras: [info->cameras]. home: the first view. ADCGS_ERR_MEMORY is the only failure. */
adcgs_status adcgs_filmed_view_init(adcgs_filmed_view *view, const adcgs_info *info, const adcgs_filmed_camera *cameras,
                                    const adcgs_camera *home, adcgs_error *error);
void adcgs_filmed_view_clear(adcgs_filmed_view *view);

/** True if the stream has a path to follow. */
int adcgs_filmed_view_has_path(const adcgs_filmed_view *view);
/** Looks through the path's camera, and follows it from now on. Requires a path. */
void adcgs_filmed_view_start(adcgs_filmed_view *view, adcgs_orbit_control *control, double time);
/**
 * Moves the view with the path's camera. Call it when the time has changed. seconds: since the last call, if the user lets the
 * scene play, else 0. Then a view next to the path returns to the filmed region, and to its place when that is inside again.
 * After a turn of the clock's loop the view moves from the path's end to its start within a second, while the scene plays.
 */
void adcgs_filmed_view_tick(adcgs_filmed_view *view, adcgs_orbit_control *control, const adcgs_play_clock *clock, double seconds);
/** The user moved the view, or set another centre: it keeps its place relative to the path's camera from now on. */
void adcgs_filmed_view_moved(adcgs_filmed_view *view, const adcgs_orbit_control *control);
/** How far the view is outside of the filmed region: 0 inside, 1 where it may go no further. */
double adcgs_filmed_view_outside(const adcgs_filmed_view *view, const adcgs_orbit_control *control);
/**
 * The share of a movement from `before` to `after` that the user may make: 1, or less if it leads outside. The caller repeats the
 * movement with this share.
 */
double adcgs_filmed_view_share(const adcgs_filmed_view *view, const adcgs_orbit_control *before,
                               const adcgs_orbit_control *after);

#endif
