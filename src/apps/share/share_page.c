/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Puts a scene with its texts and its poster into the page for browsers, at the page's marks. */
#include "config.h"

#include "apps/share/share_page.h"

#include "apps/share/share_text.h"
#include "system/base64.h"

/* The places of the page, in their order. */
enum { MARK_TITLE, MARK_CARD, MARK_POSTER, MARK_SCENE, MARKS };
static const char *const marks[MARKS] = {"<title>adcgs</title>\n", "<!-- card -->\n", "<!-- poster -->\n", "<!-- scene -->\n"};

adcgs_status adcgs_share_check_page(const uint8_t *page, size_t bytes, const char *path, adcgs_error *error)
{
    const char *at = (const char *)page;
    int found = strlen(at) == bytes;
    for (int i = 0; found && i < MARKS; i++) {
        at = strstr(at, marks[i]);
        found = at && !strstr(at + 1, marks[i]);
    }
    if (!found)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%.160s: not an adcgs page: expected places for a title, a card, a poster and a scene", path);
    return ADCGS_OK;
}

static const char *name_of(const adcgs_share_scene *scene)
{
    const char *slash = scene->name ? strrchr(scene->name, '/') : NULL;
    return slash ? slash + 1 : scene->name;
}

/** Writes the title with a writer of texts: by default the name without its ending. */
static void write_title(FILE *file, const adcgs_share_scene *scene, void (*write)(FILE *, const char *))
{
    static const char ending[] = ".adcgs";
    char text[256];
    const char *name = name_of(scene);
    snprintf(text, sizeof text, "%s", name ? name : "adcgs");
    const size_t length = strlen(text);
    if (length >= sizeof ending && !strcmp(text + length + 1 - sizeof ending, ending))
        text[length + 1 - sizeof ending] = 0;
    write(file, scene->title ? scene->title : text);
}

/** Writes the description, which stands below the title of a link to the page. */
static void write_description(FILE *file, const adcgs_share_scene *scene)
{
    fputs(scene->name ? "A scene in motion: play it, and look at it from any side." : "A player for scenes in motion.", file);
    if (scene->credit) {
        fputc(' ', file);
        adcgs_share_html(file, scene->credit);
    }
}

static void write_poster_address(FILE *file, const adcgs_share_poster *poster)
{
    fprintf(file, "data:%s;base64,", poster->type);
    adcgs_base64_write(file, poster->data, poster->bytes, 0);
}

/** Writes the settings that the page's script reads. */
static void write_settings(FILE *file, const adcgs_share_scene *scene)
{
    fputs("<script type=\"application/json\" id=\"settings\">{\"title\":", file);
    write_title(file, scene, adcgs_share_json);
    if (scene->credit) {
        fputs(",\"credit\":", file);
        adcgs_share_json(file, scene->credit);
    }
    if (scene->camera >= 0)
        fprintf(file, ",\"camera\":%d", scene->camera);
    if (scene->has_time)
        fprintf(file, ",\"time\":%.17g", scene->time);
    fprintf(file, ",\"loop\":%s}</script>\n", scene->is_once ? "false" : "true");
}

/** Writes the texts and the image for links to the page, and the page's colour. */
static void write_card(FILE *file, const adcgs_share_scene *scene)
{
    fputs("<meta name=\"description\" content=\"", file);
    write_description(file, scene);
    fputs("\">\n<meta property=\"og:type\" content=\"website\">\n<meta property=\"og:title\" content=\"", file);
    write_title(file, scene, adcgs_share_html);
    fputs("\">\n<meta property=\"og:description\" content=\"", file);
    write_description(file, scene);
    fputs("\">\n", file);
    if (scene->image) {
        fputs("<meta name=\"twitter:card\" content=\"summary_large_image\">\n<meta property=\"og:image\" content=\"", file);
        adcgs_share_html(file, scene->image);
        fputs("\">\n", file);
    }
    if (scene->background)
        fprintf(file, "<meta name=\"theme-color\" content=\"%s\">\n<style>:root { --background: %s; }</style>\n",
                scene->background, scene->background);
    write_settings(file, scene);
}

/** Writes the poster as the page's first image, without a script: once in full, and once blurred behind it. */
static void write_poster(FILE *file, const adcgs_share_scene *scene)
{
    const adcgs_share_poster *poster = &scene->poster;
    if (poster->data) {
        fprintf(file, "<svg id=\"backdrop\" viewBox=\"0 0 %d %d\" preserveAspectRatio=\"xMidYMid slice\" aria-hidden=\"true\">",
                poster->width, poster->height);
        fputs("<use href=\"#still\"/></svg>\n", file);
        fprintf(file, "<svg id=\"poster\" style=\"--shape:%.4f\" viewBox=\"0 0 %d %d\" preserveAspectRatio=\"xMidYMid slice\" ",
                (double)poster->width / poster->height, poster->width, poster->height);
        fputs("role=\"img\" aria-label=\"", file);
        write_title(file, scene, adcgs_share_html);
        fprintf(file, "\"><image id=\"still\" width=\"%d\" height=\"%d\" href=\"", poster->width, poster->height);
        write_poster_address(file, poster);
        fputs("\"/></svg>\n", file);
    }
    if (scene->name) {
        fputs("<header id=\"card\"><h1>", file);
        write_title(file, scene, adcgs_share_html);
        fputs("</h1>", file);
        if (scene->credit) {
            fputs("<p>", file);
            adcgs_share_html(file, scene->credit);
            fputs("</p>", file);
        }
        fputs("</header>\n", file);
    }
}

static void write_scene(FILE *file, const adcgs_share_scene *scene)
{
    if (!scene->name) {
        fputs(marks[MARK_SCENE], file);
        return;
    }
    fputs("<script type=\"text/plain\" id=\"scene\" data-name=\"", file);
    adcgs_share_html(file, name_of(scene));
    fputs("\">\n", file);
    adcgs_base64_write(file, scene->data, scene->bytes, 1);
    fputs("</script>\n", file);
    if (!scene->sound.data)
        return;
    fprintf(file, "<script type=\"text/plain\" id=\"sound\" data-type=\"%s\" data-offset=\"%.17g\">\n", scene->sound.type,
            scene->sound.offset);
    adcgs_base64_write(file, scene->sound.data, scene->sound.bytes, 1);
    fputs("</script>\n", file);
}

void adcgs_share_write(FILE *file, const char *page, size_t bytes, const adcgs_share_scene *scene)
{
    const char *at = page;
    for (int i = 0; i < MARKS; i++) {
        const char *place = strstr(at, marks[i]);
        fwrite(at, 1, (size_t)(place - at), file);
        at = place + strlen(marks[i]);
        switch (i) {
        case MARK_TITLE:
            fputs("<title>", file);
            write_title(file, scene, adcgs_share_html);
            fputs("</title>\n", file);
            break;
        case MARK_CARD:
            write_card(file, scene);
            break;
        case MARK_POSTER:
            write_poster(file, scene);
            break;
        default:
            write_scene(file, scene);
            break;
        }
    }
    fwrite(at, 1, (size_t)(page + bytes - at), file);
}
