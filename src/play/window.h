/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A window, keys and a mouse, accessible from C without SDL. SDL depends on some forty shared libraries, so it is in a module of
 * its own, opened when the player starts. The module decides nothing: it emits events and shows images. All positions and sizes
 * are in pixels, for any pixel density.
 */
#ifndef ADCGS_PLAY_WINDOW_H
#define ADCGS_PLAY_WINDOW_H

#include "play/drawing.h"
#include "play/event.h"
#include "system/module.h"

typedef struct adcgs_window adcgs_window;

/** The module's functions. Only wake() may be called from another thread than the one that opened the window. */
typedef struct adcgs_sdl {
    const char *version; /**< of the programs that the module belongs to */
    /** Opens a window of the requested size, or as large as the screen allows. ADCGS_ERR_IO without a display. */
    adcgs_status (*open)(adcgs_window **out, const char *title, int width, int height, adcgs_error *error);
    void (*close)(adcgs_window **window);
    /**
     * Returns the size, and the pixels per unit of the desktop: according to the desktop, or, if it scales no windows, to the
     * size of the screen's pixels.
     */
    void (*size)(const adcgs_window *window, int *width, int *height, double *density);
    void (*resize)(adcgs_window *window, int width, int height);
    /** Waits for the next event, at most `milliseconds`. \return nonzero if there was one */
    int (*event)(adcgs_window *window, int milliseconds, adcgs_event *out);
    /** Adds an event like one of the user's; event() returns it in its turn. */
    void (*push)(adcgs_window *window, const adcgs_event *event);
    /** Ends the waiting in event(). */
    void (*wake)(adcgs_window *window);
    /** Switches full screen on or off. */
    void (*fullscreen)(adcgs_window *window, int on);
    /** Hides the pointer and reports all its movements, for looking around. */
    void (*capture)(adcgs_window *window, int on);
    /** Takes an RGB image, [height][width][3], which show() scales to the window. */
    adcgs_status (*picture)(adcgs_window *window, const uint8_t *rgb, int width, int height, adcgs_error *error);
    /** Returns the widths of letters in this window. */
    const adcgs_type *(*type)(const adcgs_window *window);
    /** Why text is in plain built-in letters; "": it is in a font. */
    const char *(*plain)(const adcgs_window *window);
    /** Shows the image, if there is one, and the drawing. Also copies the window to rgb, [height][width][3], if not NULL. */
    adcgs_status (*show)(adcgs_window *window, const adcgs_drawing *drawing, uint8_t *rgb, adcgs_error *error);
} adcgs_sdl;

/** The module's only export. */
ADCGS_MODULE_EXPORT extern const adcgs_sdl adcgs_play_table;

/** Returns the module's table. `path` is for messages. ADCGS_ERR_UNSUPPORTED if the module is missing, or built without SDL. */
adcgs_status adcgs_sdl_get(const adcgs_sdl **sdl, const char *path, adcgs_error *error);

#endif
