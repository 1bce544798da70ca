/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Panels. */
#include "config.h"

#include "play/panel.h"

#include <stdlib.h>

#define SIDE_MAX 16384

void adcgs_panel_init(adcgs_panel *panel, int width, int height, uint32_t colour)
{
    panel->width = panel->height = 0;
    if (width < 1 || height < 1 || width > SIDE_MAX || height > SIDE_MAX)
        return;
    const size_t bytes = 4 * (size_t)width * (size_t)height;
    if (bytes > panel->room) {
        uint8_t *const grown = realloc(panel->rgba, bytes);
        if (!grown)
            return;
        panel->rgba = grown;
        panel->room = bytes;
    }
    panel->width = width;
    panel->height = height;
    adcgs_panel_fill(panel, 0, 0, width, height, colour);
}

void adcgs_panel_free(adcgs_panel *panel)
{
    free(panel->rgba);
    *panel = (adcgs_panel){0};
}

void adcgs_panel_fill(adcgs_panel *panel, int x, int y, int width, int height, uint32_t colour)
{
    const int right = ADCGS_MIN(x + width, panel->width), bottom = ADCGS_MIN(y + height, panel->height);
    for (int row = ADCGS_MAX(y, 0); row < bottom; row++)
        for (int column = ADCGS_MAX(x, 0); column < right; column++) {
            uint8_t *const to = panel->rgba + 4 * ((size_t)row * (size_t)panel->width + (size_t)column);
            for (int i = 0; i < 4; i++)
                to[i] = (uint8_t)(colour >> (24 - 8 * i));
        }
}

static void draw_letter(adcgs_panel *panel, int x, int y, int size, char letter, uint32_t colour)
{
    const uint8_t *const rows = adcgs_glyph(letter);
    for (int row = 0; row < ADCGS_GLYPH_HEIGHT; row++)
        for (int column = 0; column < ADCGS_GLYPH_WIDTH; column++)
            if (rows[row] >> (ADCGS_GLYPH_WIDTH - 1 - column) & 1)
                adcgs_panel_fill(panel, x + column * size, y + row * size, size, size, colour);
}

void adcgs_panel_text(adcgs_panel *panel, int x, int y, int size, const char *text, uint32_t colour)
{
    int column = 0, line = 0;
    for (; *text && line < SIDE_MAX && column < SIDE_MAX; text++) {
        if (*text == '\n') {
            column = 0;
            line++;
            continue;
        }
        draw_letter(panel, x + size * ADCGS_CELL_WIDTH * column, y + size * ADCGS_CELL_HEIGHT * line, size, *text, colour);
        column++;
    }
}

void adcgs_text_size(const char *text, int *columns, int *lines)
{
    int column = 0;
    *columns = 0;
    *lines = 1;
    for (; *text; text++) {
        column = *text == '\n' ? 0 : column + 1;
        *lines += *text == '\n';
        *columns = ADCGS_MAX(*columns, column);
    }
}
