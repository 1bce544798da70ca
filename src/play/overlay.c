/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Arranges the overlay on the image. */
#include "config.h"

#include "play/overlay.h"

#include "play/by_hand.h"
#include "play/control_bar.h"
#include "play/controls.h"
#include "play/help_page.h"
#include "play/overlay_colours.h"
#include "system/text.h"

#include <stdio.h>

/* Origin: chosen by hand, not measured. */
#define MESSAGE_LINES 6 /* lines of a text, at most */
#define HINT "h for help"
#define OUTSIDE_ALPHA 128.0 /* of black at the limit of the filmed region, of 255 */

/** The longest beginning of a text that fits, cut after a space if there is one. \return its bytes */
static size_t fitting_bytes(const adcgs_type *type, const char *text, int size, int width)
{
    char line[ADCGS_TEXT_BYTES];
    size_t fits = 0, words = 0;
    for (size_t at = 0; text[at] && at + 5 < sizeof line;) {
        uint32_t code;
        const int length = adcgs_utf8_next(text + at, &code);
        at += (size_t)ADCGS_MAX(1, length);
        memcpy(line, text, at);
        line[at] = 0;
        if (adcgs_text_width(type, size, line) > width)
            return words ? words : ADCGS_MAX(fits, (size_t)1);
        fits = at;
        if (text[at] == ' ' || !text[at])
            words = at;
    }
    return ADCGS_MAX(fits, (size_t)1);
}

/** Splits a text into lines that fit. The last line has the rest. \return the number of lines */
static int wrap(const adcgs_type *type, const char *text, int size, int width, char lines[MESSAGE_LINES][ADCGS_TEXT_BYTES])
{
    int n = 0;
    while (*text && n < MESSAGE_LINES) {
        const size_t bytes = n + 1 < MESSAGE_LINES ? fitting_bytes(type, text, size, width) : strlen(text);
        snprintf(lines[n++], ADCGS_TEXT_BYTES, "%.*s", (int)ADCGS_MIN(bytes, (size_t)ADCGS_TEXT_BYTES - 1), text);
        text += bytes;
        text += *text == ' ';
    }
    return n;
}

/** Writes lines on a background. x and y are the parts of the free space to the left and above; bottom is left free. */
static void draw_lines(adcgs_drawing *d, const adcgs_play_state *state, char lines[][ADCGS_TEXT_BYTES], int n, double x, double y,
                       int bottom)
{
    const int pad = adcgs_text_size(state) / 2, room = state->width - 2 * pad;
    int size = adcgs_text_size(state), width;
    for (;; size--) { /* smaller, until the lines fit */
        width = 0;
        for (int i = 0; i < n; i++)
            width = ADCGS_MAX(width, adcgs_text_width(d->type, size, lines[i]));
        if (size <= ADCGS_LETTERS_MIN || (width <= room && n * adcgs_line_height(size) + 2 * pad <= state->height - bottom))
            break;
    }
    width = ADCGS_MIN(width, room);
    const int line = adcgs_line_height(size), fit = (state->height - bottom - 2 * pad) / line;
    n = ADCGS_MIN(n, fit);
    if (n < 1)
        return;
    const adcgs_rect place = {(int)(x * (state->width - width - 2 * pad)),
                              (int)(y * (state->height - bottom - n * line - 2 * pad)), width + 2 * pad, n * line + 2 * pad};
    adcgs_drawing_rect(d, place, ADCGS_COLOUR_BACK);
    for (int i = 0; i < n; i++)
        adcgs_drawing_text(d, place.x + pad, place.y + pad + i * line, size, width, lines[i], ADCGS_COLOUR_TEXT);
}

static void draw_text(adcgs_drawing *d, const adcgs_play_state *state, const char *text, double x, double y, int bottom)
{
    char lines[MESSAGE_LINES][ADCGS_TEXT_BYTES];
    const int size = adcgs_text_size(state), n = wrap(d->type, text, size, state->width - 2 * (size / 2), lines);
    draw_lines(d, state, lines, n, x, y, bottom);
}

static void draw_statistics(adcgs_drawing *d, const adcgs_play_state *state, const adcgs_play_figures *f)
{
    const adcgs_play_clock *const clock = &state->clock;
    char lines[8][ADCGS_TEXT_BYTES], rate[40] = "";
    if (f->rate > 0.0)
        snprintf(rate, sizeof rate, ", %.1f fps", f->rate);
    snprintf(lines[0], sizeof lines[0], "image: %.1f ms%s", 1e3 * f->seconds, rate);
    snprintf(lines[1], sizeof lines[1], "size: %dx%d of %dx%d", f->width, f->height, state->width, state->height);
    snprintf(lines[2], sizeof lines[2], "splats: %u", (unsigned)f->splats);
    snprintf(lines[3], sizeof lines[3], "layers: %d of %d", state->layers, state->layers_max);
    snprintf(lines[4], sizeof lines[4], "tiers: %d", f->tiers);
    snprintf(lines[5], sizeof lines[5], "time: %.3f s, frame %d of %d", adcgs_play_clock_time(clock),
             adcgs_play_clock_frame(clock), clock->frames);
    snprintf(lines[6], sizeof lines[6], "speed: %gx%s%s", adcgs_play_clock_factor(clock), clock->loop ? ", loop" : "",
             state->flying ? ", flying" : "");
    snprintf(lines[7], sizeof lines[7], "dropped: %ld", f->dropped);
    draw_lines(d, state, lines, 8, 0.0, 0.0, 0);
}

static void draw_message(adcgs_drawing *d, const adcgs_play_state *state, const adcgs_play_figures *figures, int bottom)
{
    const int has_message = *state->message && state->now < state->message_end;
    char recording[40];
    snprintf(recording, sizeof recording, "recording, %ld frame%s", state->recorded, adcgs_s((uint64_t)state->recorded));
    const char *const text = has_message ? state->message : state->record ? recording : state->bar ? figures->coming : "";
    if (*text)
        draw_text(d, state, text, 0.0, 1.0, bottom);
}

/** The image is darker outside of the filmed region, and black next to the filmed view. */
static void draw_limits(adcgs_drawing *d, const adcgs_play_state *state)
{
    const int w = state->width, h = state->height;
    const uint32_t dark = (uint32_t)(OUTSIDE_ALPHA * adcgs_play_outside(state));
    const int x = (int)(w * adcgs_orbit_control_inset(&state->control, w, h, 0));
    const int y = (int)(h * adcgs_orbit_control_inset(&state->control, w, h, 1));
    if (dark)
        adcgs_drawing_rect(d, (adcgs_rect){0, 0, w, h}, dark);
    if (x) {
        adcgs_drawing_rect(d, (adcgs_rect){0, 0, x, h}, ADCGS_COLOUR_BESIDE);
        adcgs_drawing_rect(d, (adcgs_rect){w - x, 0, x, h}, ADCGS_COLOUR_BESIDE);
    }
    if (y) {
        adcgs_drawing_rect(d, (adcgs_rect){0, 0, w, y}, ADCGS_COLOUR_BESIDE);
        adcgs_drawing_rect(d, (adcgs_rect){0, h - y, w, y}, ADCGS_COLOUR_BESIDE);
    }
}

int adcgs_overlay_hints(const adcgs_play_state *state)
{
    return state->now < state->hint_end && !state->help;
}

void adcgs_overlay_draw(adcgs_drawing *d, const adcgs_type *type, const adcgs_play_state *state,
                        const adcgs_play_figures *figures)
{
    adcgs_controls controls;
    adcgs_controls_place(&controls, state);
    adcgs_drawing_init(d, type);
    draw_limits(d, state);
    if (state->help) { /* alone: in a small window it covers the rest */
        adcgs_help_page_draw(d, state);
        return;
    }
    if (state->statistics)
        draw_statistics(d, state, figures);
    draw_message(d, state, figures, controls.back.height);
    adcgs_control_bar_draw(d, &controls, state);
    if (adcgs_overlay_hints(state))
        draw_text(d, state, HINT, 1.0, 0.0, controls.back.height);
}
