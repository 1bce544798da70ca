/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Texts in a page. */
#include "config.h"

#include "apps/share/share_text.h"

static int is_control(char c)
{
    return (unsigned char)c < 0x20 || c == 0x7f;
}

void adcgs_share_html(FILE *file, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&':
            fputs("&amp;", file);
            break;
        case '<':
            fputs("&lt;", file);
            break;
        case '>':
            fputs("&gt;", file);
            break;
        case '"':
            fputs("&quot;", file);
            break;
        default:
            fputc(is_control(*text) ? '?' : *text, file);
            break;
        }
}

void adcgs_share_json(FILE *file, const char *text)
{
    fputc('"', file);
    for (; *text; text++)
        if (is_control(*text) || strchr("\"\\<>&", *text))
            fprintf(file, "\\u%04x", (unsigned)(unsigned char)*text);
        else
            fputc(*text, file);
    fputc('"', file);
}
