/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Puts a scene into the page for browsers, at the page's marks, as base64. */
#include "config.h"

#include "tools/share_page.h"

static const char title_mark[] = "<title>adcgs</title>", scene_mark[] = "<!-- scene -->\n";

adcgs_status adcgs_share_check_page(const uint8_t *page, size_t bytes, const char *path, adcgs_error *error)
{
    const char *text = (const char *)page;
    const char *title = strstr(text, title_mark), *scene = title ? strstr(title, scene_mark) : NULL;
    if (strlen(text) != bytes || !scene || strstr(scene + 1, scene_mark))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%.160s: not an adcgs page: expected one place for a title and one for a scene",
                          path);
    return ADCGS_OK;
}

/** Writes text between tags or within quotes, with ? for control characters. */
static void write_text(FILE *file, const char *text)
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
            fputc((unsigned char)*text < 0x20 || *text == 0x7f ? '?' : *text, file);
            break;
        }
}

/** Writes lines of 76 letters (RFC 2045). */
static void write_base64(FILE *file, const uint8_t *data, size_t bytes)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < bytes; i += 3) {
        const size_t n = ADCGS_MIN(bytes - i, 3);
        const uint32_t three = (uint32_t)data[i] << 16 | (uint32_t)(n > 1 ? data[i + 1] : 0) << 8 | (n > 2 ? data[i + 2] : 0);
        const char four[4] = {letters[three >> 18], letters[three >> 12 & 63], n > 1 ? letters[three >> 6 & 63] : '=',
                              n > 2 ? letters[three & 63] : '='};
        fwrite(four, 1, sizeof four, file);
        if (i % 57 == 54 || i + 3 >= bytes)
            fputc('\n', file);
    }
}

void adcgs_share_write(FILE *file, const char *page, size_t bytes, const adcgs_share_scene *scene)
{
    const char *title = strstr(page, title_mark), *place = strstr(title, scene_mark), *end = page + bytes;
    const char *slash = scene->name ? strrchr(scene->name, '/') : NULL, *name = slash ? slash + 1 : scene->name;
    fwrite(page, 1, (size_t)(title - page), file);
    fputs("<title>", file);
    write_text(file, scene->title ? scene->title : name ? name : "adcgs");
    fputs("</title>", file);
    title += sizeof title_mark - 1;
    fwrite(title, 1, (size_t)(place - title), file);
    if (name) {
        fputs("<script type=\"text/plain\" id=\"scene\" data-name=\"", file);
        write_text(file, name);
        fputs("\">\n", file);
        write_base64(file, scene->data, scene->bytes);
        fputs("</script>\n", file);
    } else
        fputs(scene_mark, file);
    place += sizeof scene_mark - 1;
    fwrite(place, 1, (size_t)(end - place), file);
}
