/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Output of text from others: UTF-8, terminals, tables. */
#include "config.h"

#include "system/text.h"

#include <stdlib.h>

int adcgs_utf8_next(const char *text, uint32_t *code)
{
    static const uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000}; /* smallest code point of each length; smaller ones are
                                                                      overlong */
    const unsigned char *const c = (const unsigned char *)text;
    const int n = !*c ? 0 : *c < 0x80 ? 1 : *c >> 5 == 6 ? 2 : *c >> 4 == 14 ? 3 : *c >> 3 == 30 ? 4 : 0;
    uint32_t value = n > 1 ? *c & (0x7fu >> n) : *c;
    for (int i = 1; i < n; i++) {
        if (c[i] >> 6 != 2) /* the terminating zero fails this check, too */
            return 0;
        value = value << 6 | (c[i] & 0x3f);
    }
    if (!n || value < least[n] || value > 0x10ffff || (value >= 0xd800 && value <= 0xdfff))
        return 0;
    *code = value;
    return n;
}

char *adcgs_text_utf8(const char *text)
{
    static const char unknown[] = "\xef\xbf\xbd";
    uint32_t code;
    char *const whole = malloc((sizeof unknown - 1) * strlen(text) + 1), *to = whole;
    while (whole && *text) {
        const int n = adcgs_utf8_next(text, &code);
        const size_t out = n ? (size_t)n : sizeof unknown - 1;
        memcpy(to, n ? text : unknown, out);
        to += out;
        text += n ? n : 1;
    }
    if (whole)
        *to = 0;
    return whole;
}

int adcgs_text_is_shown(uint32_t code)
{
    static const uint32_t hidden[][2] = {
        {0, 0x1f},        {0x7f, 0x9f},                                           /* C0, DEL and C1 */
        {0x061c, 0x061c}, {0x200e, 0x200f},   {0x202a, 0x202e}, {0x2066, 0x2069}, /* direction of text */
        {0x2028, 0x2029},                                                         /* separators of lines and paragraphs */
        {0x206a, 0x206f}, {0xfeff, 0xfeff},                                       /* deprecated formatting, byte order mark */
        {0xfff9, 0xfffb}, {0xe0000, 0xe007f},                                     /* annotations, tags */
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(hidden); i++)
        if (code >= hidden[i][0] && code <= hidden[i][1])
            return 0;
    return 1;
}

/** quote: a character to double; 0: none. */
static int show(FILE *file, const char *text, char quote)
{
    int columns = 0;
    while (*text) {
        uint32_t code;
        const int n = adcgs_utf8_next(text, &code);
        if (n && adcgs_text_is_shown(code)) {
            columns += 1 + (quote && *text == quote);
            if (quote && *text == quote)
                fputc(quote, file);
            fwrite(text, 1, (size_t)n, file);
        } else if (n > 1)
            columns += fprintf(file, "\\u{%x}", (unsigned)code);
        else
            columns += fprintf(file, "\\x%02x", (unsigned char)*text);
        text += n ? n : 1;
    }
    return columns;
}

int adcgs_text_show(FILE *file, const char *text)
{
    return show(file, text, 0);
}

void adcgs_text_column(FILE *file, const char *text, int width)
{
    const int shown = show(file, text, 0);
    fprintf(file, "%*s", ADCGS_MAX(width - shown, 0), "");
}

void adcgs_text_cell(FILE *file, const char *text)
{
    const int is_formula = *text && strchr("=+-@", *text), is_plain = !text[strcspn(text, ",\";")];
    if (!is_plain)
        fputc('"', file);
    if (is_formula)
        fputc('\'', file);
    show(file, text, '"');
    if (!is_plain)
        fputc('"', file);
}
