/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Texts and bytes in a page. */
#include "config.h"

#include "tools/share_text.h"

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

void adcgs_share_base64(FILE *file, const uint8_t *data, size_t bytes, int lines)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < bytes; i += 3) {
        const size_t n = ADCGS_MIN(bytes - i, 3);
        const uint32_t three = (uint32_t)data[i] << 16 | (uint32_t)(n > 1 ? data[i + 1] : 0) << 8 | (n > 2 ? data[i + 2] : 0);
        const char four[4] = {letters[three >> 18], letters[three >> 12 & 63], n > 1 ? letters[three >> 6 & 63] : '=',
                              n > 2 ? letters[three & 63] : '='};
        fwrite(four, 1, sizeof four, file);
        if (lines && (i % 57 == 54 || i + 3 >= bytes))
            fputc('\n', file);
    }
}
