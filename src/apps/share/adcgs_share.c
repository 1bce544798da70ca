/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-share: makes a page for browsers of a stream, in one file. */
#include "config.h"

#include "apps/share/share_poster.h"
#include "apps/share/share_sound.h"
#include "camera/path.h"
#include "cli/cli.h"
#include "media/operand.h"
#include "system/atomic.h"
#include "system/file.h"

#include <adcgs/adcgs.h>

#include <stdlib.h>

#define PAGE_BYTES_MAX ((uint64_t)64 << 20) /* bytes of the page without a scene; chosen by hand, not measured */
/* Bytes: more than browsers open as one page; chosen by hand, not measured. */
#define STREAM_BYTES_MAX ((uint64_t)1 << 30)

typedef struct settings {
    const adcgs_cli *cli;
    const char *output, *title, *credit, *camera, *poster, *background, *image, *sound, *page;
    double time, sound_offset;
    int has_time, has_sound_offset, loop, quiet;
} settings;

/** The contents of a page. */
typedef struct parts {
    uint8_t *page, *stream;
    char *name; /**< of the stream, if it comes from a page; else NULL */
    size_t page_bytes, stream_bytes;
    adcgs_share_scene scene;
} parts;

static const char *const on_off[] = {"on", "off", NULL};

/** Checks the texts that have a form of their own. */
static adcgs_status check_settings(const settings *s, const char *path, adcgs_error *error)
{
    const char *needs = s->camera                                ? "--camera"
                        : s->has_time                            ? "--time"
                        : s->poster && strcmp(s->poster, "none") ? "--poster"
                        : s->sound                               ? "--sound"
                                                                 : NULL;
    if (!path && needs)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: needs a scene: name its FILE", needs);
    const char *colour = s->background;
    if (colour && (*colour != '#' || strlen(colour) != 7 || strspn(colour + 1, "0123456789abcdefABCDEF") != 6))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--background %.40s: expected a colour as #rrggbb", colour);
    if (s->image && strncmp(s->image, "https://", 8) && strncmp(s->image, "http://", 7))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--image %.100s: expected an address that begins with https://", s->image);
    return ADCGS_OK;
}

/** Finds the first view, and renders or loads the poster. */
static adcgs_status prepare_view(const settings *s, adcgs_share_scene *scene, const adcgs_info *info, adcgs_decoder *decoder,
                                 adcgs_error *error)
{
    if (s->camera)
        ADCGS_TRY(adcgs_camera_find_stored(&scene->camera, decoder, info, s->camera, "", error));
    const adcgs_camera_path_request request = {.has_times = s->has_time, .begin = s->time, .end = s->time};
    ADCGS_TRY(adcgs_camera_path_check_times(info, &request, error));
    if (s->poster)
        return strcmp(s->poster, "none") ? adcgs_share_load_poster(scene, s->poster, error) : ADCGS_OK;
    const adcgs_status status = adcgs_share_render_poster(scene, decoder, error);
    if (status != ADCGS_OK && status != ADCGS_ERR_MEMORY) /* the page may still show other views and times */
        adcgs_cli_note(s->cli, "no poster: %s", error->text);
    return status == ADCGS_ERR_MEMORY ? status : ADCGS_OK;
}

/** Refuses a damaged stream, since viewers of the page cannot fix it. */
static adcgs_status prepare_scene(const settings *s, const char *path, parts *p, adcgs_error *error)
{
    adcgs_decoder *decoder;
    adcgs_info info;
    adcgs_status status = adcgs_open_memory(&decoder, p->stream, p->stream_bytes, NULL, error);
    if (status != ADCGS_OK) {
        adcgs_error_locate(error, path);
        return status;
    }
    status = adcgs_get_info(decoder, &info, sizeof info, error);
    if (status == ADCGS_OK && info.truncated)
        adcgs_cli_note(s->cli, "%s: the stream ends early; the page will show its complete part", path);
    if (status == ADCGS_OK)
        status = prepare_view(s, &p->scene, &info, decoder, error);
    adcgs_close(&decoder);
    return status;
}

static adcgs_status load_page(parts *p, const char *path, adcgs_error *error)
{
    const adcgs_status status = adcgs_file_load(&p->page, &p->page_bytes, path, PAGE_BYTES_MAX, error);
    if (status != ADCGS_ERR_IO)
        return status;
    const adcgs_error why = *error;
    return adcgs_fail(error, ADCGS_ERR_IO, "%.150s (the page for browsers: this build may lack it, or it is not installed)",
                      why.text);
}

static adcgs_status write_page(const settings *s, const char *path, const parts *p, adcgs_error *error)
{
    adcgs_atomic out;
    ADCGS_TRY(adcgs_share_check_page(p->page, p->page_bytes, s->page, error));
    ADCGS_TRY(adcgs_atomic_open(&out, s->output, error));
    adcgs_share_write(out.file, (const char *)p->page, p->page_bytes, &p->scene);
    const long bytes = ftell(out.file);
    ADCGS_TRY(adcgs_atomic_commit(&out, error));
    if (path && p->scene.sound.data)
        adcgs_cli_note(s->cli, "%s: %ld bytes, with a scene of %zu bytes, a poster of %zu and a sound of %zu", s->output, bytes,
                       p->stream_bytes, p->scene.poster.bytes, p->scene.sound.bytes);
    else if (path)
        adcgs_cli_note(s->cli, "%s: %ld bytes, with a scene of %zu bytes and a poster of %zu", s->output, bytes, p->stream_bytes,
                       p->scene.poster.bytes);
    else
        adcgs_cli_note(s->cli, "%s: %ld bytes, without a scene: it shows dropped files, and the stream of ?src=URL", s->output,
                       bytes);
    return ADCGS_OK;
}

static adcgs_status make_page(const settings *s, const char *path, parts *p, adcgs_error *error)
{
    if (path) {
        ADCGS_TRY(adcgs_operand_load(&p->stream, &p->stream_bytes, &p->name, path, STREAM_BYTES_MAX, error));
        if (p->name && *p->name)
            p->scene.name = p->name;
        p->scene.data = p->stream;
        p->scene.bytes = p->stream_bytes;
        ADCGS_TRY(prepare_scene(s, path, p, error));
    }
    if (s->sound) {
        ADCGS_TRY(adcgs_share_load_sound(&p->scene.sound, s->sound, error));
        if (!p->scene.sound.data)
            adcgs_cli_note(s->cli, "%s: this scene has no sound", s->sound);
    }
    if (s->has_sound_offset)
        p->scene.sound.offset = s->sound_offset;
    ADCGS_TRY(load_page(p, s->page, error));
    return write_page(s, path, p, error);
}

static adcgs_status share(const settings *s, const char *path, adcgs_error *error)
{
    parts p = {.scene = {.name = path,
                         .title = s->title,
                         .credit = s->credit,
                         .background = s->background,
                         .image = s->image,
                         .camera = -1,
                         .has_time = s->has_time,
                         .time = s->time,
                         .is_once = s->loop}};
    if (!s->output)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "no output: give -o PAGE.html");
    if (path && adcgs_atomic_same(path, s->output))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%.160s: the page would replace the stream: give another output", path);
    ADCGS_TRY(check_settings(s, path, error));
    const adcgs_status status = make_page(s, path, &p, error);
    free(p.page);
    free(p.stream);
    free(p.name);
    free(p.scene.poster.data);
    free(p.scene.sound.data);
    return status;
}

/** Lists the options for texts and the first view, with targets in s. */
static void add_view_options(adcgs_option_table *out, settings *s)
{
    const adcgs_option table[] = {
        {"output", 'o', ADCGS_OPTION_STRING, &s->output, 0, 0, "PAGE.html", "page to write", NULL, NULL},
        {.name = "title",
         .kind = ADCGS_OPTION_STRING,
         .target = &s->title,
         .value = "TEXT",
         .help = "title of the page (default: the file's name without its ending)"},
        {.name = "credit",
         .kind = ADCGS_OPTION_STRING,
         .target = &s->credit,
         .value = "TEXT",
         .help = "line below the title: who made it"},
        {.name = "camera",
         .letter = 'c',
         .kind = ADCGS_OPTION_STRING,
         .target = &s->camera,
         .value = "NAME|INDEX",
         .help = "stored camera of the first view"},
        {.name = "time",
         .letter = 't',
         .kind = ADCGS_OPTION_SECONDS,
         .target = &s->time,
         .min = -1e9,
         .max = 1e9,
         .given = &s->has_time,
         .value = "TIME",
         .help = "time of the first frame (default: the stream's first)"},
        {.name = "poster",
         .kind = ADCGS_OPTION_FILE,
         .target = &s->poster,
         .value = "FILE|none",
         .help = "JPEG or PNG image to show until the scene plays\n(default: the first frame, rendered)"},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Lists the options for sound, playback, links and the page itself. */
static void add_page_options(adcgs_option_table *out, settings *s)
{
    const adcgs_option table[] = {
        {.name = "sound",
         .kind = ADCGS_OPTION_FILE,
         .target = &s->sound,
         .value = "FILE|SCENE",
         .help = "sound that plays with the scene, as Opus, or the training\nscene that has it (default: none)"},
        {.name = "sound-offset",
         .kind = ADCGS_OPTION_SECONDS,
         .target = &s->sound_offset,
         .min = -1e6,
         .max = 1e6,
         .given = &s->has_sound_offset,
         .value = "TIME",
         .help = "time of the stream at which the sound begins (default: 0, or as\nthe scene says)"},
        {.name = "loop",
         .kind = ADCGS_OPTION_CHOICE,
         .target = &s->loop,
         .choices = on_off,
         .value = "on|off",
         .help = "whether the scene plays in a loop"},
        {.name = "background",
         .kind = ADCGS_OPTION_STRING,
         .target = &s->background,
         .value = "#rrggbb",
         .help = "colour of the page around the image"},
        {.name = "image",
         .kind = ADCGS_OPTION_STRING,
         .target = &s->image,
         .value = "URL",
         .help = "address of the image that a link to the page shows\n(default: none)"},
        {.name = "page",
         .kind = ADCGS_OPTION_STRING,
         .target = &s->page,
         .value = "FILE",
         .help = "page that receives the scene, by default the installed one:\n" PAGE_FILE},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

int main(int argc, char **argv)
{
    settings s = {.page = PAGE_FILE};
    adcgs_option_table options = {.n = 0};
    add_view_options(&options, &s);
    add_page_options(&options, &s);
    static const adcgs_option_rule rules[] = {{"sound-offset", ADCGS_OPTION_NEEDS, "sound"}};
    const adcgs_cli cli = {.program = "adcgs-share",
                           .operands = "[FILE]",
                           .summary = "Make a page for browsers of a stream: one file with the decoder and the scene.",
                           .details = "Without FILE the page has no scene: it shows files that are dropped on it,\n"
                                      "and, on a web server, the stream of ?src=URL.\n"
                                      "Exit status: 0 done, 2 usage, 3 input or output, 4 invalid stream or page, 5 unsupported.",
                           .options = options.rows,
                           .n_options = options.n,
                           .rules = rules,
                           .n_rules = ADCGS_COUNTOF(rules),
                           .min_operands = 0,
                           .max_operands = 1,
                           .quiet = &s.quiet};
    int first;
    s.cli = &cli;
    const int leave = adcgs_cli_parse(&cli, argc, argv, &first);
    if (leave >= 0)
        return leave;
    adcgs_error error = {ADCGS_OK, ""};
    error.status = share(&s, first < argc ? argv[first] : NULL, &error);
    return error.status == ADCGS_OK ? 0 : adcgs_cli_fail(&cli, &error);
}
