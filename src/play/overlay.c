/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Renders the overlay on the image. */
#include "config.h"

#include "play/overlay.h"

#include "cli/text.h"
#include "play/actions.h"
#include "play/panel.h"

#include <stdio.h>

#define BACKGROUND 0x000000a8u
#define PAGE 0x000000e0u /* behind the help, which covers other text */
#define TEXT 0xffffffffu
#define GROOVE 0xffffff50u
#define DONE 0x58b0ffffu
#define MARGIN 4 /* letters' pixels around text */

enum { BAR, STATISTICS, MESSAGE, HELP };

/** Makes a panel of the size of its text. x and y are the parts of the free space to its left and above it. */
static void text_panel(adcgs_panel *panel, const adcgs_play_state *state, const char *text, double x, double y,
                       uint32_t background)
{
    const int size = adcgs_play_text_size(state);
    int columns, lines;
    adcgs_text_size(text, &columns, &lines);
    const int width = size * (columns * ADCGS_CELL_WIDTH + 2 * MARGIN - 1);
    const int height = size * (lines * ADCGS_CELL_HEIGHT + 2 * MARGIN - (ADCGS_CELL_HEIGHT - ADCGS_GLYPH_HEIGHT + 2));
    adcgs_panel_init(panel, width, height, background);
    adcgs_panel_text(panel, size * MARGIN, size * MARGIN, size, text, TEXT);
    panel->x = ADCGS_MAX(0, (int)(x * (state->width - width)));
    panel->y = ADCGS_MAX(0, (int)(y * (state->height - height)));
}

/** Renders the groove with the elapsed part, and the time on its right if there is room. */
static void draw_bar(adcgs_panel *panel, const adcgs_play_state *state)
{
    const adcgs_rect place = adcgs_play_bar(state);
    const adcgs_play_clock *const clock = &state->clock;
    const int size = adcgs_play_text_size(state), third = place.height / 3;
    char text[64];
    adcgs_panel_init(panel, place.width ? state->width : 0, place.height, BACKGROUND);
    panel->x = place.x;
    panel->y = place.y;
    if (!panel->width)
        return;
    const double part = (double)adcgs_play_clock_frame(clock) / (clock->frames - 1);
    const int passed = (int)(part * (place.width - 1));
    adcgs_panel_fill(panel, 0, third, place.width, third, GROOVE);
    adcgs_panel_fill(panel, 0, third, passed, third, DONE);
    adcgs_panel_fill(panel, passed - size, 0, 2 * size, place.height, TEXT);
    snprintf(text, sizeof text, "%-2s %.2f s", clock->playing ? ">" : "||", adcgs_play_clock_time(clock));
    const int top = (place.height - (ADCGS_GLYPH_HEIGHT - 2) * size) / 2;
    if (place.width < state->width)
        adcgs_panel_text(panel, place.width + ADCGS_CELL_WIDTH * size, top, size, text, TEXT);
}

static void draw_statistics(adcgs_panel *panel, const adcgs_play_state *state, const adcgs_play_figures *figures)
{
    const adcgs_play_clock *const clock = &state->clock;
    char rate[40] = "", text[440];
    if (figures->rate > 0.0)
        snprintf(rate, sizeof rate, ", %.1f fps", figures->rate);
    snprintf(text, sizeof text,
             "image   %.1f ms%s\n"
             "size    %dx%d of %dx%d\n"
             "splats  %u\n"
             "layers  %d of %d\n"
             "tiers   %d\n"
             "time    %.3f s, frame %d of %d\n"
             "speed   %gx%s%s\n"
             "dropped %ld",
             1e3 * figures->seconds, rate, figures->width, figures->height, state->width, state->height,
             (unsigned)figures->splats, state->layers, state->layers_max, figures->tiers, adcgs_play_clock_time(clock),
             adcgs_play_clock_frame(clock), clock->frames, adcgs_play_clock_factor(clock), clock->loop ? ", loop" : "",
             state->flying ? ", flying" : "", figures->dropped);
    text_panel(panel, state, text, 0.0, 0.0, BACKGROUND);
}

static void draw_help(adcgs_panel *panel, const adcgs_play_state *state)
{
    char text[2000];
    size_t used = 0;
    int n;
    const adcgs_play_help *const lines = adcgs_play_help_lines(&n);
    for (int i = 0; i < n && used < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%-11s %s", i ? "\n" : "", lines[i].keys, lines[i].text);
    text_panel(panel, state, text, 0.5, 0.5, PAGE);
}

void adcgs_overlay_draw(adcgs_panel panels[ADCGS_PANELS], const adcgs_play_state *state, const adcgs_play_figures *figures)
{
    for (int i = 0; i < ADCGS_PANELS; i++)
        panels[i].width = panels[i].height = 0;
    draw_bar(&panels[BAR], state);
    if (state->statistics)
        draw_statistics(&panels[STATISTICS], state, figures);
    const int has_message = *state->message && state->now < state->message_end;
    char recording[40];
    snprintf(recording, sizeof recording, "recording, %ld frame%s", state->recorded, adcgs_s((uint64_t)state->recorded));
    if (has_message || state->record || (*figures->coming && state->bar)) {
        const char *const text = has_message ? state->message : state->record ? recording : figures->coming;
        text_panel(&panels[MESSAGE], state, text, 0.0, 1.0, BACKGROUND);
        panels[MESSAGE].y = ADCGS_MAX(0, panels[MESSAGE].y - adcgs_play_bar(state).height);
    }
    if (state->help)
        draw_help(&panels[HELP], state);
}
