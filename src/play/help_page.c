/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The help page. */
#include "config.h"

#include "play/help_page.h"

#include "play/actions.h"
#include "play/controls.h"
#include "play/overlay_colours.h"

#define COLUMNS_MAX 3 /* columns of the page; chosen by hand, not measured */
#define TITLE "h, escape or a click closes this page"

/** The arrangement of the page; all lengths are pixels. */
typedef struct page {
    int size, columns, rows; /* rows of a column */
    int keys, text, gap;     /* widths of the two parts of a column, and the room after each */
    int width, height;
} page;

/** Arranges the lines in columns at a size of text. */
static page arrange(const adcgs_type *type, const adcgs_play_help *lines, int n, int size, int columns)
{
    page p = {.size = size, .columns = columns, .rows = (n + columns - 1) / columns, .gap = size};
    for (int i = 0; i < n; i++) {
        p.keys = ADCGS_MAX(p.keys, adcgs_text_width(type, size, lines[i].keys));
        p.text = ADCGS_MAX(p.text, adcgs_text_width(type, size, lines[i].text));
    }
    p.width = columns * (p.keys + p.text + 2 * p.gap);
    p.width = ADCGS_MAX(p.width, adcgs_text_width(type, size, TITLE) + p.gap);
    p.height = (p.rows + 1) * adcgs_line_height(size);
    return p;
}

/** The largest size up to that of other text that fits; for each size, the fewest columns. */
static page choose(const adcgs_type *type, const adcgs_play_help *lines, int n, const adcgs_play_state *state)
{
    page p = {0};
    for (int size = adcgs_text_size(state); size >= ADCGS_LETTERS_MIN; size--)
        for (int columns = 1; columns <= COLUMNS_MAX; columns++) {
            p = arrange(type, lines, n, size, columns);
            if (p.width <= state->width && p.height <= state->height)
                return p;
        }
    return arrange(type, lines, n, ADCGS_LETTERS_MIN, 1);
}

void adcgs_help_page_draw(adcgs_drawing *d, const adcgs_play_state *state)
{
    int n;
    const adcgs_play_help *const lines = adcgs_play_help_lines(&n);
    const page p = choose(d->type, lines, n, state);
    const int line = adcgs_line_height(p.size), width = ADCGS_MIN(p.width, state->width);
    const int rows = ADCGS_MIN(p.rows, state->height / line - 1), height = ADCGS_MIN((rows + 1) * line, state->height);
    const int left = (state->width - width) / 2, top = (state->height - height) / 2, edge = p.gap / 2,
              right = left + width - edge;
    const int fringe = ADCGS_MAX(0, ADCGS_MIN(ADCGS_MIN(left, top), p.size / 2));
    adcgs_drawing_rect(d, (adcgs_rect){0, 0, state->width, state->height}, ADCGS_COLOUR_SHADE);
    adcgs_drawing_rect(d, (adcgs_rect){left - fringe, top - fringe, width + 2 * fringe, height + 2 * fringe}, ADCGS_COLOUR_PAGE);
    for (int i = 0; i < n && rows > 0; i++) {
        const int row = i % p.rows, x = left + edge + i / p.rows * (p.keys + p.text + 2 * p.gap), y = top + row * line;
        if (row >= rows)
            continue;
        adcgs_drawing_text(d, x, y, p.size, ADCGS_MIN(p.keys, right - x), lines[i].keys, ADCGS_COLOUR_KEY);
        adcgs_drawing_text(d, x + p.keys + p.gap, y, p.size, ADCGS_MIN(p.text, right - x - p.keys - p.gap), lines[i].text,
                           ADCGS_COLOUR_TEXT);
    }
    adcgs_drawing_text(d, left + edge, top + height - line, p.size, width - p.gap, TITLE, ADCGS_COLOUR_FAINT);
}
