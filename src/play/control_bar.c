/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Renders the controls. */
#include "config.h"

#include "play/control_bar.h"

#include "play/overlay_colours.h"

#include <stdio.h>

#define ICON 0.42 /* height of an icon, in heights of its button; chosen by hand, not measured */

/** A polygon in a square about the middle of a button: from -1 to 1 in the icon's half height. */
static void draw_icon_part(adcgs_drawing *d, const adcgs_rect *r, const float *points, int n)
{
    const float half = (float)(0.5 * ICON * r->height);
    float to[2 * ADCGS_SHAPE_POINTS];
    for (int i = 0; i < n; i++) {
        to[2 * i] = (float)r->x + 0.5f * (float)r->width + half * points[2 * i];
        to[2 * i + 1] = (float)r->y + 0.5f * (float)r->height + half * points[2 * i + 1];
    }
    adcgs_drawing_polygon(d, to, n, ADCGS_COLOUR_TEXT);
}

static void draw_play(adcgs_drawing *d, const adcgs_rect *r, int playing)
{
    static const float triangle[] = {-0.8f, -1.0f, 1.0f, 0.0f, -0.8f, 1.0f};
    static const float bars[2][8] = {{-0.85f, -1.0f, -0.25f, -1.0f, -0.25f, 1.0f, -0.85f, 1.0f},
                                     {0.25f, -1.0f, 0.85f, -1.0f, 0.85f, 1.0f, 0.25f, 1.0f}};
    if (!playing)
        draw_icon_part(d, r, triangle, 3);
    for (int i = 0; i < 2 && playing; i++)
        draw_icon_part(d, r, bars[i], 4);
}

/** An angle that points to the left or right. */
static void draw_arrow(adcgs_drawing *d, const adcgs_rect *r, float side)
{
    for (int i = 0; i < 2; i++) {
        const float y = i ? 1.0f : -1.0f, half = 0.5f * side;
        const float points[] = {-half, 0.9f * y, half, 0.0f, half - 0.45f * side, 0.0f, -half - 0.45f * side, 0.9f * y};
        const float moved[] = {points[0] + 0.2f * side, points[1], points[2] + 0.2f * side, points[3],
                               points[4] + 0.2f * side, points[5], points[6] + 0.2f * side, points[7]};
        draw_icon_part(d, r, moved, 4);
    }
}

/** Four corners: outside for a window, inside on the full screen. */
static void draw_corners(adcgs_drawing *d, const adcgs_rect *r, int full)
{
    const float out = full ? 0.25f : 1.0f, in = full ? 1.0f : 0.35f, thick = full ? -0.28f : 0.28f;
    for (int i = 0; i < 4; i++) {
        const float x = i & 1 ? 1.0f : -1.0f, y = i & 2 ? 1.0f : -1.0f, edge = out - thick;
        const float across[] = {x * out, y * out, x * in, y * out, x * in, y * edge, x * out, y * edge};
        const float down[] = {x * out, y * out, x * edge, y * out, x * edge, y * in, x * out, y * in};
        draw_icon_part(d, r, across, 4);
        draw_icon_part(d, r, down, 4);
    }
}

/** Writes a line in the middle of a place. */
static void draw_label(adcgs_drawing *d, const adcgs_rect *r, int size, const char *text)
{
    const int wide = ADCGS_MIN(adcgs_text_width(d->type, size, text), r->width);
    adcgs_drawing_text(d, r->x + (r->width - wide) / 2, r->y + (r->height - adcgs_line_height(size)) / 2, size, r->width, text,
                       ADCGS_COLOUR_TEXT);
}

static void draw_slider(adcgs_drawing *d, const adcgs_controls *c, const adcgs_play_state *state, int pointed)
{
    const adcgs_rect *const r = &c->place[ADCGS_CONTROL_SLIDER];
    const adcgs_play_clock *const clock = &state->clock;
    if (!r->width)
        return;
    const int thick = ADCGS_MAX(2, c->size / (pointed ? 3 : 4)), top = r->y + (r->height - thick) / 2,
              knob = ADCGS_MAX(4, c->size / 3);
    const double total = clock->frames / clock->rate, there = ADCGS_MAX(0.0, ADCGS_MIN(clock->available / total, 1.0));
    const int passed = (int)((double)adcgs_play_clock_frame(clock) / (clock->frames - 1) * (r->width - 1));
    const int x = ADCGS_MAX(r->x, ADCGS_MIN(r->x + passed - knob / 2, r->x + r->width - knob));
    adcgs_drawing_rect(d, (adcgs_rect){r->x, top, r->width, thick}, ADCGS_COLOUR_GROOVE);
    if (there < 1.0) /* the received part */
        adcgs_drawing_rect(d, (adcgs_rect){r->x, top, (int)(there * r->width), thick}, ADCGS_COLOUR_GROOVE);
    adcgs_drawing_rect(d, (adcgs_rect){r->x, top, passed, thick}, ADCGS_COLOUR_DONE);
    adcgs_drawing_rect(d, (adcgs_rect){x, r->y + r->height / 6, knob, r->height - 2 * (r->height / 6)}, ADCGS_COLOUR_TEXT);
}

static void draw_time(adcgs_drawing *d, const adcgs_controls *c, const adcgs_play_clock *clock)
{
    const adcgs_rect *const r = &c->place[ADCGS_CONTROL_TIME];
    char text[80];
    if (!r->width)
        return;
    snprintf(text, sizeof text, "%.2f / %.2f s", adcgs_play_clock_time(clock), clock->begin + (clock->frames - 1) / clock->rate);
    if (adcgs_text_width(d->type, c->size, text) > r->width - c->size / 2)
        snprintf(text, sizeof text, "%.2f s", adcgs_play_clock_time(clock));
    adcgs_drawing_text(d, r->x + c->size / 2, r->y + (r->height - adcgs_line_height(c->size)) / 2, c->size,
                       r->width - c->size / 2, text, ADCGS_COLOUR_TEXT);
}

static void draw_name(adcgs_drawing *d, const adcgs_controls *c, const adcgs_play_state *state)
{
    const adcgs_rect *const r = &c->place[ADCGS_CONTROL_NAME];
    const char *const name = state->control.camera.name;
    char number[40];
    if (!r->width)
        return;
    snprintf(number, sizeof number, "%d of %d", state->jumped + 1, state->cameras);
    draw_label(d, r, c->size, *name ? name : state->jumped >= 0 ? number : "free view");
}

/** The text of the control under the pointer. */
static void describe(const adcgs_controls *c, const adcgs_play_state *state, adcgs_play_control control, char *out, size_t room)
{
    const adcgs_play_clock *const clock = &state->clock;
    const char *text = "";
    *out = 0;
    if (control == ADCGS_CONTROL_SLIDER) {
        const double part = adcgs_controls_part(c, state->pointer[0]);
        snprintf(out, room, "%.2f s", clock->begin + (double)(int)(part * (clock->frames - 1) + 0.5) / clock->rate);
        return;
    }
    if (control == ADCGS_CONTROL_PLAY)
        text = clock->playing ? "pause: space" : "play: space";
    else if (control == ADCGS_CONTROL_PREVIOUS)
        text = "previous camera: [";
    else if (control == ADCGS_CONTROL_NEXT)
        text = "next camera: ]";
    else if (control == ADCGS_CONTROL_NAME)
        text = state->control.camera.name;
    else if (control == ADCGS_CONTROL_HELP)
        text = "help: h";
    else if (control == ADCGS_CONTROL_FULL)
        text = state->full ? "window: F11" : "full screen: F11";
    snprintf(out, room, "%s", text);
}

static void draw_tip(adcgs_drawing *d, const adcgs_controls *c, const adcgs_play_state *state, adcgs_play_control control)
{
    const adcgs_rect *const r = &c->place[control];
    char text[ADCGS_TEXT_BYTES];
    describe(c, state, control, text, sizeof text);
    const int pad = c->size / 3, line = adcgs_line_height(c->size), high = line + pad, y = c->back.y - high - pad;
    const int wide = ADCGS_MIN(adcgs_text_width(d->type, c->size, text), state->width - 2 * pad);
    const int middle = control == ADCGS_CONTROL_SLIDER ? (int)state->pointer[0] : r->x + r->width / 2;
    const int x = ADCGS_MAX(0, ADCGS_MIN(middle - wide / 2 - pad, state->width - wide - 2 * pad));
    if (!*text || y < 0)
        return;
    adcgs_drawing_rect(d, (adcgs_rect){x, y, wide + 2 * pad, high}, ADCGS_COLOUR_PAGE);
    adcgs_drawing_text(d, x + pad, y + pad / 2, c->size, wide, text, ADCGS_COLOUR_TEXT);
}

void adcgs_control_bar_draw(adcgs_drawing *d, const adcgs_controls *c, const adcgs_play_state *state)
{
    const adcgs_rect *const place = c->place;
    const adcgs_play_control pointed = adcgs_play_pointed(state);
    if (!c->back.width)
        return;
    adcgs_drawing_rect(d, c->back, ADCGS_COLOUR_BACK);
    if (adcgs_controls_key(pointed))
        adcgs_drawing_rect(d, place[pointed], state->pressed == pointed ? ADCGS_COLOUR_PRESSED : ADCGS_COLOUR_POINTED);
    draw_slider(d, c, state, pointed == ADCGS_CONTROL_SLIDER || state->drag == ADCGS_DRAG_BAR);
    if (place[ADCGS_CONTROL_PLAY].width)
        draw_play(d, &place[ADCGS_CONTROL_PLAY], state->clock.playing);
    if (place[ADCGS_CONTROL_PREVIOUS].width)
        draw_arrow(d, &place[ADCGS_CONTROL_PREVIOUS], -1.0f);
    if (place[ADCGS_CONTROL_NEXT].width)
        draw_arrow(d, &place[ADCGS_CONTROL_NEXT], 1.0f);
    if (place[ADCGS_CONTROL_FULL].width)
        draw_corners(d, &place[ADCGS_CONTROL_FULL], state->full);
    if (place[ADCGS_CONTROL_HELP].width)
        draw_label(d, &place[ADCGS_CONTROL_HELP], c->size + c->size / 4, "?");
    draw_time(d, c, &state->clock);
    draw_name(d, c, state);
    if (pointed != ADCGS_CONTROL_NONE && pointed != ADCGS_CONTROL_BACK && pointed != ADCGS_CONTROL_TIME)
        draw_tip(d, c, state, pointed);
}
