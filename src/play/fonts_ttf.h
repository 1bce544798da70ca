/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Text in the desktop's fonts. Part of the module with SDL. */
#ifndef ADCGS_PLAY_FONTS_TTF_H
#define ADCGS_PLAY_FONTS_TTF_H

#include <SDL.h>

typedef struct adcgs_fonts adcgs_fonts;

/** Finds a font. \return NULL if there is none; *reason is why then */
adcgs_fonts *adcgs_fonts_open(const char **reason);
void adcgs_fonts_close(adcgs_fonts **fonts);

/** Width of a line of UTF-8, pixels; size is the height of the em. */
int adcgs_fonts_width(adcgs_fonts *fonts, int size, const char *text);
/** A line of UTF-8 in white, with its coverage as opacity; NULL on failure. Free it with SDL_FreeSurface(). */
SDL_Surface *adcgs_fonts_draw(adcgs_fonts *fonts, int size, const char *text);

#endif
