/* SPDX-License-Identifier: BSD-2-Clause */
/** \file User input: keys and a mouse, independent of the platform. */
#ifndef ADCGS_PLAY_EVENT_H
#define ADCGS_PLAY_EVENT_H

/** Keys, by definition: the lower-case ASCII character for keys that have one, else one of these, above all bytes. */
enum {
    ADCGS_KEY_ESCAPE = 27, /**< ASCII's too */
    ADCGS_KEY_LEFT = 256,
    ADCGS_KEY_RIGHT,
    ADCGS_KEY_HOME,
    ADCGS_KEY_END,
    ADCGS_KEY_PAGE_UP,
    ADCGS_KEY_PAGE_DOWN,
    ADCGS_KEY_F1,
    ADCGS_KEY_SHIFT,
    ADCGS_KEY_F11
};

typedef enum adcgs_event_kind {
    ADCGS_EVENT_NONE, /**< an event without effect */
    ADCGS_EVENT_QUIT,
    ADCGS_EVENT_KEY,    /**< key, down, again */
    ADCGS_EVENT_BUTTON, /**< button, down, x, y */
    ADCGS_EVENT_MOTION, /**< x, y, and the movement dx, dy */
    ADCGS_EVENT_WHEEL,  /**< dy: steps away from the user */
    ADCGS_EVENT_SIZE,   /**< the window has another size, or must be rendered again */
    ADCGS_EVENT_LOST,   /**< keyboard input goes elsewhere from now on */
    ADCGS_EVENT_LEAVE   /**< the pointer has left the window */
} adcgs_event_kind;

typedef struct adcgs_event {
    adcgs_event_kind kind;
    int key;
    int down;   /**< pressed, not released */
    int again;  /**< repeated, since the key is held */
    int button; /**< 1 left, 2 middle, 3 right */
    int clicks; /**< 2: the second press of a double click */
    double x, y, dx, dy;
} adcgs_event;

#endif
