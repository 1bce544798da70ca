/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Colours of the overlay, 0xRRGGBBAA, and its smallest text. */
#ifndef ADCGS_PLAY_OVERLAY_COLOURS_H
#define ADCGS_PLAY_OVERLAY_COLOURS_H

/* Colours, 0xRRGGBBAA; chosen by hand, not measured. */
#define ADCGS_COLOUR_BACK 0x000000a8u
#define ADCGS_COLOUR_PAGE 0x000000e0u   /* behind the help, which covers other text */
#define ADCGS_COLOUR_SHADE 0x00000070u  /* on the image around the help */
#define ADCGS_COLOUR_BESIDE 0x000000ffu /* next to the filmed view */
#define ADCGS_COLOUR_TEXT 0xffffffffu
#define ADCGS_COLOUR_KEY 0x9fd2ffffu
#define ADCGS_COLOUR_FAINT 0xffffffa0u
#define ADCGS_COLOUR_GROOVE 0xffffff48u
#define ADCGS_COLOUR_DONE 0x58b0ffffu
#define ADCGS_COLOUR_POINTED 0xffffff38u /* behind the control under the pointer */
#define ADCGS_COLOUR_PRESSED 0xffffff70u

#define ADCGS_LETTERS_MIN 5 /* pixels; smaller text is no text; chosen by hand, not measured */

#endif
