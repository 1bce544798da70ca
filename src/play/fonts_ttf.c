/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Fonts: fontconfig finds the files, SDL_ttf renders. A line is in the desktop's sans-serif font, or, if that lacks one of its
 * characters, in the font that fontconfig prefers for them.
 */
#include "config.h"

#include "play/fonts_ttf.h"

#ifdef HAVE_TTF

#include "base/base.h"
#include "system/text.h"

#include <SDL_ttf.h>
#include <fontconfig/fontconfig.h>

#include <stdlib.h>

#define OPEN_MAX 8 /* fonts of one file and size, at most; chosen by hand, not measured */
#define FAMILY "sans-serif"

typedef struct font_file {
    char *path;
    int index; /* of the font in its file */
} font_file;

typedef struct open_font {
    TTF_Font *font;
    font_file from;
    int size;
    unsigned used; /* the turn of its last use */
} open_font;

struct adcgs_fonts {
    FcConfig *config;
    font_file usual;
    open_font open[OPEN_MAX];
    unsigned turn;
    char last[256]; /* the last line with characters that the usual font lacks, and the font for it */
    font_file other;
};

/** Finds a scalable font that has the characters of a text; NULL: any. \return nonzero if there is one */
static int find_file(FcConfig *config, const char *text, font_file *out)
{
    FcPattern *const wanted = FcPatternCreate();
    FcCharSet *const letters = FcCharSetCreate();
    FcResult result;
    FcChar8 *path = NULL;
    uint32_t code;
    *out = (font_file){0};
    for (int length; text && (length = adcgs_utf8_next(text, &code)) > 0; text += length)
        FcCharSetAddChar(letters, code);
    FcPatternAddString(wanted, FC_FAMILY, (const FcChar8 *)FAMILY);
    FcPatternAddBool(wanted, FC_SCALABLE, FcTrue);
    FcPatternAddBool(wanted, FC_COLOR, FcFalse);
    if (text)
        FcPatternAddCharSet(wanted, FC_CHARSET, letters);
    FcConfigSubstitute(config, wanted, FcMatchPattern);
    FcDefaultSubstitute(wanted);
    FcPattern *const found = FcFontMatch(config, wanted, &result);
    if (found && FcPatternGetString(found, FC_FILE, 0, &path) == FcResultMatch) {
        out->path = strdup((const char *)path);
        FcPatternGetInteger(found, FC_INDEX, 0, &out->index);
    }
    if (found)
        FcPatternDestroy(found);
    FcCharSetDestroy(letters);
    FcPatternDestroy(wanted);
    return out->path != NULL;
}

/** Opens a font at a size, in place of the one that was not used for the longest time. */
static TTF_Font *need_font(adcgs_fonts *f, const font_file *from, int size)
{
    open_font *oldest = &f->open[0];
    for (int i = 0; i < OPEN_MAX; i++) {
        open_font *const o = &f->open[i];
        if (o->font && o->size == size && o->from.index == from->index && !strcmp(o->from.path, from->path)) {
            o->used = ++f->turn;
            return o->font;
        }
        if (o->used < oldest->used)
            oldest = o;
    }
    if (oldest->font)
        TTF_CloseFont(oldest->font);
    free(oldest->from.path);
    *oldest = (open_font){.font = TTF_OpenFontIndex(from->path, size, from->index),
                          .from = {strdup(from->path), from->index},
                          .size = size,
                          .used = ++f->turn};
    if (oldest->font && !oldest->from.path) {
        TTF_CloseFont(oldest->font);
        oldest->font = NULL;
    }
    return oldest->font;
}

static int has_all(TTF_Font *font, const char *text)
{
    uint32_t code;
    for (int length; (length = adcgs_utf8_next(text, &code)) > 0; text += length)
        if (!TTF_GlyphIsProvided32(font, code))
            return 0;
    return 1;
}

/** The font for a line of text. A character that no font has is a box. */
static TTF_Font *choose_font(adcgs_fonts *f, int size, const char *text)
{
    TTF_Font *const usual = need_font(f, &f->usual, size);
    if (!usual || has_all(usual, text))
        return usual;
    if (strcmp(f->last, text)) {
        free(f->other.path);
        find_file(f->config, text, &f->other);
        SDL_strlcpy(f->last, text, sizeof f->last);
    }
    TTF_Font *const other = f->other.path ? need_font(f, &f->other, size) : NULL;
    return other ? other : need_font(f, &f->usual, size);
}

void adcgs_fonts_close(adcgs_fonts **fonts)
{
    adcgs_fonts *const f = *fonts;
    *fonts = NULL;
    if (!f)
        return;
    for (int i = 0; i < OPEN_MAX; i++) {
        if (f->open[i].font)
            TTF_CloseFont(f->open[i].font);
        free(f->open[i].from.path);
    }
    free(f->usual.path);
    free(f->other.path);
    if (f->config)
        FcConfigDestroy(f->config);
    TTF_Quit();
    free(f);
}

adcgs_fonts *adcgs_fonts_open(const char **reason)
{
    adcgs_fonts *f = TTF_Init() ? NULL : calloc(1, sizeof *f);
    *reason = "the font library does not start";
    if (!f)
        return NULL;
    f->config = FcInitLoadConfigAndFonts();
    if (f->config && find_file(f->config, NULL, &f->usual) && need_font(f, &f->usual, 16))
        return f;
    *reason = "no font is installed";
    adcgs_fonts_close(&f);
    return NULL;
}

int adcgs_fonts_width(adcgs_fonts *f, int size, const char *text)
{
    TTF_Font *const font = choose_font(f, size, text);
    int width = 0, height;
    return font && !TTF_SizeUTF8(font, text, &width, &height) ? width : 0;
}

SDL_Surface *adcgs_fonts_draw(adcgs_fonts *f, int size, const char *text)
{
    TTF_Font *const font = choose_font(f, size, text);
    return font ? TTF_RenderUTF8_Blended(font, text, (SDL_Color){255, 255, 255, 255}) : NULL;
}

#else

adcgs_fonts *adcgs_fonts_open(const char **reason)
{
    *reason = "this build has no font library";
    return NULL;
}

void adcgs_fonts_close(adcgs_fonts **fonts)
{
    *fonts = NULL;
}

int adcgs_fonts_width(adcgs_fonts *fonts, int size, const char *text)
{
    return 0;
}

SDL_Surface *adcgs_fonts_draw(adcgs_fonts *fonts, int size, const char *text)
{
    return NULL;
}

#endif
