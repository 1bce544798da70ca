/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What the player is doing, and how events change it. No window, no thread,
 * no file: events and the time go in, and what should be seen can be read off.
 */
#ifndef ADCGS_PLAY_STATE_H
#define ADCGS_PLAY_STATE_H

#include "base/base.h"
#include "camera/orbit_control.h"
#include "play/clock.h"
#include "play/event.h"

/* The time bar, in pixels of letters and in letters: how high it is, and the room for the time on its right. */
#define ADCGS_PLAY_BAR_HEIGHT 14
#define ADCGS_PLAY_BAR_COLUMNS 13

typedef enum adcgs_play_drag {
    ADCGS_DRAG_NONE,
    ADCGS_DRAG_ORBIT,
    ADCGS_DRAG_PAN,
    ADCGS_DRAG_BAR
} adcgs_play_drag;

typedef enum adcgs_play_shot {
    ADCGS_SHOT_NONE,
    ADCGS_SHOT_PNG,
    ADCGS_SHOT_EXR
} adcgs_play_shot;

typedef struct adcgs_rect {
    int x, y, width, height;
} adcgs_rect;

typedef struct adcgs_play_state {
    adcgs_orbit_control control;
    adcgs_play_clock clock;
    adcgs_camera home;            /**< what reset goes back to */
    const adcgs_camera *stored;   /**< the stream's cameras, [cameras] */
    int cameras;
    int jumped;                   /**< the stored camera that it jumped to last; -1: none, or moved since */
    int layers, layers_max;       /**< of the stream: used, and there; 1..5 */
    int width, height;            /**< of the window, pixels */
    double density;               /**< pixels in the unit that desktops measure in */

    int flying;                   /**< keys and mouse move the camera freely */
    double speed;                 /**< of flying: scene units in a second */
    unsigned held;                /**< keys held that fly, a bit for each */
    int shift;
    adcgs_play_drag drag;
    double moved;                 /**< when the camera or the time was last moved by hand */

    int bar, statistics, help;    /**< what is laid over the picture */
    char message[200];
    double message_end;           /**< when it goes away */

    adcgs_play_shot shot;         /**< asked for; who takes it sets it back */
    int key_frame;                /**< asked for: 1 one more, -1 the last one back; who does it sets it back */
    int record;                   /**< a video is to be written of what is shown */
    long recorded;                /**< frames that it has by now */
    int full;                     /**< the window is to have the whole screen */
    int quit;
    double now;                   /**< the clock on the wall at the last tick */
} adcgs_play_state;

/** Begins at the home camera, paused at the first frame. stored must live as long as the state. */
void adcgs_play_init(adcgs_play_state *state, const adcgs_info *info, const adcgs_camera *home, const adcgs_camera *stored);
void adcgs_play_resize(adcgs_play_state *state, int width, int height, double density);
/** What an event does. */
void adcgs_play_event(adcgs_play_state *state, const adcgs_event *event);
/** What passing time does: now is in seconds. */
void adcgs_play_tick(adcgs_play_state *state, double now);

/** Whether the picture moves: playing, flying, or moved by hand just now. */
int adcgs_play_moving(const adcgs_play_state *state);
/** Where the time bar is in the window, without the time on its right; of width 0 when there is none. */
adcgs_rect adcgs_play_bar(const adcgs_play_state *state);
/** Pixels of the window in a pixel of a letter. */
int adcgs_play_text_size(const adcgs_play_state *state);

#endif
