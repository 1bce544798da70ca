/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Renders shapes with SDL. */
#include "config.h"

#include "play/canvas_sdl.h"

#include "base/base.h"
#include "play/font.h"

static int width_of(void *arg, int size, const char *text)
{
    const adcgs_sdl_canvas *const c = arg;
    return c->fonts ? adcgs_fonts_width(c->fonts, size, text) : adcgs_glyph_width(size, text);
}

void adcgs_sdl_canvas_init(adcgs_sdl_canvas *c, SDL_Renderer *renderer)
{
    c->renderer = renderer;
    c->fonts = adcgs_fonts_open(&c->plain);
    if (c->fonts)
        c->plain = "";
    c->type = (adcgs_type){.width = width_of, .arg = c};
}

void adcgs_sdl_canvas_forget(adcgs_sdl_canvas *c)
{
    for (int i = 0; i < ADCGS_CANVAS_LINES; i++)
        if (c->line[i].texture) {
            SDL_DestroyTexture(c->line[i].texture);
            c->line[i].texture = NULL;
        }
}

void adcgs_sdl_canvas_clear(adcgs_sdl_canvas *c)
{
    adcgs_sdl_canvas_forget(c);
    adcgs_fonts_close(&c->fonts);
}

static SDL_Color colour_of(uint32_t colour)
{
    return (SDL_Color){(Uint8)(colour >> 24), (Uint8)(colour >> 16), (Uint8)(colour >> 8), (Uint8)colour};
}

static int draw_rect(adcgs_sdl_canvas *c, const adcgs_shape *shape)
{
    const SDL_Color colour = colour_of(shape->colour);
    const SDL_Rect to = {shape->place.x, shape->place.y, shape->place.width, shape->place.height};
    return !SDL_SetRenderDrawColor(c->renderer, colour.r, colour.g, colour.b, colour.a) && !SDL_RenderFillRect(c->renderer, &to);
}

/** A convex polygon is a fan of triangles. */
static int draw_polygon(adcgs_sdl_canvas *c, const adcgs_shape *shape)
{
    SDL_Vertex corners[ADCGS_SHAPE_POINTS];
    int indices[3 * ADCGS_SHAPE_POINTS], n = 0;
    for (int i = 0; i < shape->n; i++)
        corners[i] = (SDL_Vertex){.position = {shape->x[i], shape->y[i]}, .color = colour_of(shape->colour)};
    for (int i = 2; i < shape->n; i++) {
        indices[n++] = 0;
        indices[n++] = i - 1;
        indices[n++] = i;
    }
    return !SDL_RenderGeometry(c->renderer, NULL, corners, shape->n, indices, n);
}

/** Renders text in the letters of font.h. A character outside ASCII is one question mark. */
static int draw_letters(adcgs_sdl_canvas *c, const adcgs_shape *shape, const char *text)
{
    const SDL_Color colour = colour_of(shape->colour);
    const int scale = adcgs_glyph_scale(shape->size), high = scale * ADCGS_GLYPH_HEIGHT;
    int x = shape->place.x, y = shape->place.y + ADCGS_MAX(0, (shape->place.height - high) / 2);
    int good = !SDL_SetRenderDrawColor(c->renderer, colour.r, colour.g, colour.b, colour.a);
    for (; *text && good; text++) {
        SDL_Rect dots[ADCGS_GLYPH_HEIGHT * ADCGS_GLYPH_WIDTH];
        int n = 0;
        if (((unsigned char)*text & 0xc0) == 0x80)
            continue;
        const uint8_t *const rows = adcgs_glyph(*text);
        for (int row = 0; row < ADCGS_GLYPH_HEIGHT; row++)
            for (int column = 0; column < ADCGS_GLYPH_WIDTH; column++)
                if (rows[row] >> (ADCGS_GLYPH_WIDTH - 1 - column) & 1)
                    dots[n++] = (SDL_Rect){x + column * scale, y + row * scale, scale, scale};
        good = !n || !SDL_RenderFillRects(c->renderer, dots, n);
        x += scale * ADCGS_CELL_WIDTH;
    }
    return good;
}

/** Provides the texture of a line of text, in place of the one that was not used for the longest time. */
static adcgs_sdl_canvas_line *need_line(adcgs_sdl_canvas *c, int size, const char *text)
{
    adcgs_sdl_canvas_line *oldest = &c->line[0];
    for (int i = 0; i < ADCGS_CANVAS_LINES; i++) {
        adcgs_sdl_canvas_line *const line = &c->line[i];
        if (line->texture && line->size == size && !strcmp(line->text, text))
            return line;
        if (!line->texture || (oldest->texture && line->used < oldest->used))
            oldest = line;
    }
    SDL_Surface *const surface = adcgs_fonts_draw(c->fonts, size, text);
    if (!surface)
        return NULL;
    if (oldest->texture)
        SDL_DestroyTexture(oldest->texture);
    *oldest = (adcgs_sdl_canvas_line){.texture = SDL_CreateTextureFromSurface(c->renderer, surface),
                                      .size = size,
                                      .width = surface->w,
                                      .height = surface->h};
    SDL_strlcpy(oldest->text, text, sizeof oldest->text);
    SDL_FreeSurface(surface);
    return oldest->texture ? oldest : NULL;
}

static int draw_text(adcgs_sdl_canvas *c, const adcgs_shape *shape, const char *text)
{
    if (!c->fonts)
        return draw_letters(c, shape, text);
    const SDL_Color colour = colour_of(shape->colour);
    adcgs_sdl_canvas_line *const line = need_line(c, shape->size, text);
    if (!line) /* for example, all characters have no width: no reason to end the player */
        return 1;
    line->used = c->turn;
    const SDL_Rect to = {shape->place.x, shape->place.y + (shape->place.height - line->height) / 2, line->width, line->height};
    return !SDL_SetTextureColorMod(line->texture, colour.r, colour.g, colour.b) &&
           !SDL_SetTextureAlphaMod(line->texture, colour.a) && !SDL_RenderCopy(c->renderer, line->texture, NULL, &to);
}

int adcgs_sdl_canvas_draw(adcgs_sdl_canvas *c, const adcgs_drawing *d)
{
    int good = !SDL_SetRenderDrawBlendMode(c->renderer, SDL_BLENDMODE_BLEND);
    c->turn++;
    for (int i = 0; i < d->n && good; i++) {
        const adcgs_shape *const shape = &d->shape[i];
        switch (shape->kind) {
        case ADCGS_SHAPE_RECT:
            good = draw_rect(c, shape);
            break;
        case ADCGS_SHAPE_POLYGON:
            good = draw_polygon(c, shape);
            break;
        case ADCGS_SHAPE_TEXT:
            good = draw_text(c, shape, d->text + shape->text);
            break;
        }
    }
    return good;
}
