/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The places of the controls. */
#include "config.h"

#include "play/controls.h"

#include <math.h>

/* Origin: chosen by hand, not measured. */
#define TEXT_MIN 11.0        /* desktop units; smaller text is hard to read */
#define TEXT_PER_HEIGHT 40.0 /* lines of text in the window's height, if they are larger than that */
#define TEXT_PER_WIDTH 60.0  /* the same for the width of narrow windows */
#define TEXT_PER_TINY 10.0   /* in windows smaller than any text */
#define SHOWN_SECONDS 3.0    /* while playing, in which the controls stay after the last movement of the pointer */

/* Sizes in sizes of text; chosen by hand, not measured. */
#define BUTTON 2.2
#define SLIDER 1.4
#define MARGIN 0.4
#define TIME_WIDTH 10.0
#define NAME_MIN 4.0
#define NAME_MAX 14.0

int adcgs_text_size(const adcgs_play_state *state)
{
    const double unit = ADCGS_MAX(1.0, state->density), height = state->height, width = state->width;
    const double suits = ADCGS_MIN(height / TEXT_PER_HEIGHT, width / TEXT_PER_WIDTH);
    const double tiny = ADCGS_MIN(height, width) / TEXT_PER_TINY;
    return (int)ADCGS_MAX(6.0, floor(ADCGS_MIN(tiny, ADCGS_MAX(TEXT_MIN * unit, suits)) + 0.5));
}

static int is_shown(const adcgs_play_state *state)
{
    const int rests = state->clock.playing && state->drag != ADCGS_DRAG_BAR && state->now - state->pointed > SHOWN_SECONDS;
    return state->bar && !rests;
}

/** Takes a place of this width from the left or right end of the row, if it is there. */
static void take(adcgs_controls *out, adcgs_rect *row, adcgs_play_control control, int width, int right)
{
    if (width > row->width)
        return;
    out->place[control] = (adcgs_rect){right ? row->x + row->width - width : row->x, row->y, width, row->height};
    row->x += right ? 0 : width;
    row->width -= width;
}

/** The more important controls come first. */
static void place_buttons(adcgs_controls *out, adcgs_rect row, int plays, int cameras)
{
    const int button = row.height;
    const double size = out->size;
    if (plays)
        take(out, &row, ADCGS_CONTROL_PLAY, button, 0);
    take(out, &row, ADCGS_CONTROL_HELP, button, 1);
    const adcgs_rect help = out->place[ADCGS_CONTROL_HELP];
    take(out, &row, ADCGS_CONTROL_FULL, button, 1);
    if (help.width && out->place[ADCGS_CONTROL_FULL].width) { /* the outermost is full screen */
        out->place[ADCGS_CONTROL_HELP] = out->place[ADCGS_CONTROL_FULL];
        out->place[ADCGS_CONTROL_FULL] = help;
    }
    const int time = (int)(TIME_WIDTH * size), pair = 2 * button, gap = (int)(MARGIN * size);
    const int has_time = plays && row.width >= time;
    const int room = row.width - (has_time ? time : 0) - pair - gap;
    if (cameras && room >= 0) {
        const int name = room >= (int)(NAME_MIN * size) ? ADCGS_MIN(room, (int)(NAME_MAX * size)) : 0;
        row.width -= gap;
        take(out, &row, ADCGS_CONTROL_NEXT, button, 1);
        if (name)
            take(out, &row, ADCGS_CONTROL_NAME, name, 1);
        take(out, &row, ADCGS_CONTROL_PREVIOUS, button, 1);
    }
    if (has_time)
        take(out, &row, ADCGS_CONTROL_TIME, time, 0);
}

void adcgs_controls_place(adcgs_controls *out, const adcgs_play_state *state)
{
    const int size = adcgs_text_size(state), plays = state->clock.frames > 1;
    const int margin = (int)ceil(MARGIN * size), button = (int)ceil(BUTTON * size);
    const int slider = plays ? (int)ceil(SLIDER * size) : margin;
    const int height = slider + button + margin, inner = state->width - 2 * margin;
    *out = (adcgs_controls){.size = size};
    if (!is_shown(state) || 2 * height > state->height || inner < 2 * button)
        return;
    out->back = (adcgs_rect){0, state->height - height, state->width, height};
    if (plays)
        out->place[ADCGS_CONTROL_SLIDER] = (adcgs_rect){margin, out->back.y, inner, slider};
    place_buttons(out, (adcgs_rect){margin, out->back.y + slider, inner, button}, plays, state->cameras > 0);
}

static int contains(const adcgs_rect *r, double x, double y)
{
    return x >= r->x && y >= r->y && x < r->x + r->width && y < r->y + r->height;
}

adcgs_play_control adcgs_controls_at(const adcgs_controls *controls, double x, double y)
{
    for (int i = ADCGS_CONTROL_NONE + 1; i < ADCGS_CONTROL_COUNT; i++)
        if (contains(&controls->place[i], x, y))
            return (adcgs_play_control)i;
    return contains(&controls->back, x, y) ? ADCGS_CONTROL_BACK : ADCGS_CONTROL_NONE;
}

double adcgs_controls_part(const adcgs_controls *controls, double x)
{
    const adcgs_rect *const slider = &controls->place[ADCGS_CONTROL_SLIDER];
    return ADCGS_MAX(0.0, ADCGS_MIN((x - slider->x) / ADCGS_MAX(1, slider->width - 1), 1.0));
}

int adcgs_controls_key(adcgs_play_control control)
{
    switch (control) {
    case ADCGS_CONTROL_PLAY:
        return ' ';
    case ADCGS_CONTROL_PREVIOUS:
        return '[';
    case ADCGS_CONTROL_NEXT:
        return ']';
    case ADCGS_CONTROL_HELP:
        return 'h';
    case ADCGS_CONTROL_FULL:
        return ADCGS_KEY_F11;
    default:
        return 0;
    }
}
