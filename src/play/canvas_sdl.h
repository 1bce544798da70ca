/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Renders the shapes of the overlay with SDL. Part of the module with SDL. */
#ifndef ADCGS_PLAY_CANVAS_SDL_H
#define ADCGS_PLAY_CANVAS_SDL_H

#include "play/drawing.h"
#include "play/fonts_ttf.h"

#define ADCGS_CANVAS_LINES 128 /**< lines of text whose textures are kept; chosen by hand, not measured */

/** A line of text that was rendered before. */
typedef struct adcgs_sdl_canvas_line {
    SDL_Texture *texture; /**< NULL: unused */
    char text[ADCGS_TEXT_BYTES];
    int size, width, height;
    unsigned used; /**< the drawing of its last use */
} adcgs_sdl_canvas_line;

typedef struct adcgs_sdl_canvas {
    SDL_Renderer *renderer;
    adcgs_fonts *fonts; /**< NULL: letters are those of font.h */
    const char *plain;  /**< the reason for that; "": none */
    adcgs_type type;
    unsigned turn; /**< number of the drawing */
    adcgs_sdl_canvas_line line[ADCGS_CANVAS_LINES];
} adcgs_sdl_canvas;

/** The canvas must not move while it is in use. */
void adcgs_sdl_canvas_init(adcgs_sdl_canvas *canvas, SDL_Renderer *renderer);
/** Frees everything, before the renderer. */
void adcgs_sdl_canvas_clear(adcgs_sdl_canvas *canvas);
/** Forgets all textures, since the renderer has lost them. */
void adcgs_sdl_canvas_forget(adcgs_sdl_canvas *canvas);
/** Renders all shapes. \return 0 after a failure */
int adcgs_sdl_canvas_draw(adcgs_sdl_canvas *canvas, const adcgs_drawing *drawing);

#endif
