/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A window, keys and a mouse, seen from C without SDL. SDL brings some forty
 * shared libraries along, so it is in a module of its own, opened when the
 * player starts. Nothing here decides anything: events go out, pictures come
 * in. All places and sizes are in pixels, however dense they are.
 */
#ifndef ADCGS_PLAY_WINDOW_H
#define ADCGS_PLAY_WINDOW_H

#include "io/module.h"
#include "play/event.h"

/** A rectangle of straight RGBA, [height][width][4], laid over the picture. Of width 0: none. */
typedef struct adcgs_panel {
    int x, y, width, height;
    uint8_t *rgba;
    size_t room; /**< bytes that rgba has */
} adcgs_panel;

#define ADCGS_PANELS 4

typedef struct adcgs_window adcgs_window;

/** What the module offers. Only wake() may be called from another thread than the one that opened the window. */
typedef struct adcgs_sdl {
    const char *version; /**< of the programs that the module belongs to */
    /** A window as large as wanted, or as the screen has room for. ADCGS_ERR_IO where there is no display. */
    adcgs_status (*open)(adcgs_window **out, const char *title, int width, int height, adcgs_error *error);
    void (*close)(adcgs_window **window);
    /** Size, and how many pixels make the unit that desktops measure in. */
    void (*size)(const adcgs_window *window, int *width, int *height, double *density);
    void (*resize)(adcgs_window *window, int width, int height);
    /** The next event, waiting for it at most so long. \return whether one came. */
    int (*event)(adcgs_window *window, int milliseconds, adcgs_event *out);
    /** Make an event as if the user had; event() gives it back in its turn. */
    void (*push)(adcgs_window *window, const adcgs_event *event);
    /** End the waiting in event(). */
    void (*wake)(adcgs_window *window);
    /** Take the whole screen, or give it back. */
    void (*fullscreen)(adcgs_window *window, int on);
    /** Hide the pointer and report all its ways, for looking round. */
    void (*capture)(adcgs_window *window, int on);
    /** Take an RGB picture, [height][width][3], which show() scales to the window. */
    adcgs_status (*picture)(adcgs_window *window, const uint8_t *rgb, int width, int height, adcgs_error *error);
    /** The picture, if one was given, and the panels; to rgb as well, [height][width][3] of the window, if not NULL. */
    adcgs_status (*show)(adcgs_window *window, const adcgs_panel panels[ADCGS_PANELS], uint8_t *rgb, adcgs_error *error);
} adcgs_sdl;

/** The one thing that the module exports. */
ADCGS_MODULE_EXPORT extern const adcgs_sdl adcgs_play_table;

/** The module's table; `path` is what messages name. ADCGS_ERR_UNSUPPORTED when it is not there, or built without SDL. */
adcgs_status adcgs_sdl_get(const adcgs_sdl **sdl, const char *path, adcgs_error *error);

#endif
