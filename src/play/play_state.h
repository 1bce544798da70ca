/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The player's state, and its changes by events. It uses no window, thread or file: events and the time are inputs, and the
 * desired view can be read from the state.
 */
#ifndef ADCGS_PLAY_PLAY_STATE_H
#define ADCGS_PLAY_PLAY_STATE_H

#include "base/base.h"
#include "camera/orbit_control.h"
#include "play/event.h"
#include "play/filmed_view.h"
#include "play/play_clock.h"

typedef enum adcgs_play_drag { ADCGS_DRAG_NONE, ADCGS_DRAG_ORBIT, ADCGS_DRAG_PAN, ADCGS_DRAG_BAR } adcgs_play_drag;

typedef enum adcgs_play_shot { ADCGS_SOURCE_IMAGE_NONE, ADCGS_SOURCE_IMAGE_PNG, ADCGS_SOURCE_IMAGE_EXR } adcgs_play_shot;

/** Parts of the window that a mouse can press; scripts name them by number. */
typedef enum adcgs_play_control {
    ADCGS_CONTROL_NONE,
    ADCGS_CONTROL_SLIDER, /**< of time */
    ADCGS_CONTROL_PLAY,
    ADCGS_CONTROL_PREVIOUS, /**< stored camera */
    ADCGS_CONTROL_NEXT,
    ADCGS_CONTROL_HELP,
    ADCGS_CONTROL_FULL,
    ADCGS_CONTROL_TIME, /**< a text; a press has no effect */
    ADCGS_CONTROL_NAME, /**< of the camera; a text */
    ADCGS_CONTROL_BACK, /**< between the controls */
    ADCGS_CONTROL_COUNT
} adcgs_play_control;

typedef struct adcgs_play_state {
    adcgs_orbit_control control;
    adcgs_play_clock clock;
    adcgs_camera home;                 /**< the view of reset */
    int follows_home;                  /**< nonzero: reset follows the filmed path instead */
    const adcgs_filmed_camera *stored; /**< the stream's cameras, [cameras] */
    adcgs_filmed_view *filmed;         /**< the filmed path and region; NULL: unknown */
    int cameras;
    int jumped;             /**< the last selected stored camera; -1: none, or moved since */
    int layers, layers_max; /**< of the stream: used, and present; 1..5 */
    int width, height;      /**< of the window, pixels */
    double density;         /**< pixels per unit of the desktop */

    int flying;    /**< keys and mouse move the camera freely */
    double speed;  /**< of flying: scene units per second */
    unsigned held; /**< flight keys that are held, a bit for each */
    int shift;
    adcgs_play_drag drag;
    int pivots;         /**< number of requests for a pivot so far: for each, adcgs_play_pivot() may be called (by_hand.h) */
    int pivot_answered; /**< number of the last one that has its answer */
    int pivot_chosen;   /**< nonzero: the user chose the pivot by a double click */
    double pivot_at[2]; /**< requested place: 0 to 1 over width and height of the window */
    double moved;       /**< when the user last moved the camera or the time */
    struct {
        double time, x, y;
    } click; /**< the last click of the first button on the image */

    double pointer[2]; /**< position of the pointer; negative: it is outside the window */
    double pointed;    /**< when it last moved or pressed */
    adcgs_play_control pressed;

    int bar, statistics, help; /**< visible overlays; bar: the controls, which rest while it plays */
    double hint_end;           /**< when the hint of the help disappears */
    char message[200];
    double message_end; /**< when the message disappears */

    adcgs_play_shot shot; /**< requested screenshot; reset when it is taken */
    int key_frame;        /**< request: 1 to add a key frame, -1 to remove the last; reset when it is done */
    int record;           /**< a video is recorded */
    long recorded;        /**< its frames so far */
    int full;             /**< full screen is requested */
    int quit;
    int ticks;  /**< the wall clock is known */
    double now; /**< wall clock at the last tick */
} adcgs_play_state;

/**
 * Starts at the home camera, or following the filmed path if it is the view of its first time; paused at the first frame. stored
 * and filmed must live as long as the state.
 */
void adcgs_play_init(adcgs_play_state *state, const adcgs_info *info, const adcgs_camera *home, const adcgs_filmed_camera *stored,
                     adcgs_filmed_view *filmed);
void adcgs_play_resize(adcgs_play_state *state, int width, int height, double density);
/** Applies an event. */
void adcgs_play_event(adcgs_play_state *state, const adcgs_event *event);
/** Applies the passing of time; now is in seconds. */
void adcgs_play_tick(adcgs_play_state *state, double now);

/** True if the image moves: playing, flying, or moved by the user just now. */
int adcgs_play_moving(const adcgs_play_state *state);
/** The control under the pointer. */
adcgs_play_control adcgs_play_pointed(const adcgs_play_state *state);

#endif
