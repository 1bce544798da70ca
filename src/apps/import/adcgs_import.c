/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-import: makes a scene of images or videos with unknown cameras. */
#include "config.h"

#include "apps/import/scene_sound.h"
#include "scene/scene.h"
#include "system/interrupt.h"
#include "system/json.h"
#include "system/text.h"

#include <stdio.h>
#include <stdlib.h>

#define FRAMES 300   /* default number of frames of a moving camera; chosen by hand, not measured */
#define TEST_EVERY 8 /* one in so many images is held out; literature (LLFF, Mip-NeRF 360) */

/* Thresholds of the warnings about poses; chosen by hand, not measured. */
#define POSED_WELL 0.8   /* images with a pose, share */
#define ERROR_FINE 1.5   /* mean reprojection error, pixels */
#define TRACK_FINE 3.0   /* images per point */
#define SPREAD_FINE 0.02 /* poses of a static camera, share of the rig's size */

typedef struct arguments {
    adcgs_import_options import;
    const char *fps;
    int json, quiet;
} arguments;

/* ---- The result ---- */

static void print_text(const adcgs_import_report *r, const char *output)
{
    adcgs_text_show(stdout, output);
    if (r->cameras)
        printf(": %u of %u static cameras, %.2f s; %dx%d\n", r->found, r->cameras, r->seconds, r->width, r->height);
    else
        printf(": %u of %u images, %.2f s; %dx%d\n", r->posed, r->pictures, r->seconds, r->width, r->height);
    printf("poses: %u points, %.2f pixels off on average, each in %.1f images, %.2g degrees apart", r->points, r->error, r->track,
           r->angle);
    if (r->cameras)
        printf("; poses of a camera %.2g %% apart", 100.0 * r->spread);
    printf("\n");
    if (r->has_sound) {
        printf("sound: ");
        adcgs_text_show(stdout, output);
        printf("/%s, for adcgs-share --sound and adcgs-dec --sound\n", ADCGS_IMPORT_SOUND);
    }
    printf("next: adcgs-enc %s/scene.json -o FILE\n", output);
}

static adcgs_status print_json(const adcgs_import_report *r, const char *output, adcgs_error *error)
{
    adcgs_json j;
    adcgs_json_init(&j);
    adcgs_json_open(&j, NULL, '{');
    adcgs_json_string(&j, "scene", output);
    adcgs_json_string(&j, "kind", r->kind);
    adcgs_json_int(&j, "pictures", r->pictures);
    adcgs_json_int(&j, "posed", r->posed);
    if (r->cameras) {
        adcgs_json_int(&j, "cameras", r->cameras);
        adcgs_json_int(&j, "cameras_posed", r->found);
        adcgs_json_real(&j, "spread", r->spread);
    }
    adcgs_json_string(&j, "mapper", r->mapper);
    adcgs_json_int(&j, "models", r->models);
    adcgs_json_int(&j, "points", r->points);
    adcgs_json_real(&j, "reprojection_error", r->error);
    adcgs_json_real(&j, "track_length", r->track);
    adcgs_json_real(&j, "angle", r->angle);
    adcgs_json_real(&j, "seconds", r->seconds);
    adcgs_json_int(&j, "width", r->width);
    adcgs_json_int(&j, "height", r->height);
    if (r->has_sound)
        adcgs_json_string(&j, "sound", ADCGS_IMPORT_SOUND);
    adcgs_json_close(&j);
    return adcgs_json_write(&j, stdout, "standard output", error);
}

/** Prints warnings that better footage or other options can fix. */
static void warn(const adcgs_cli *cli, const adcgs_import_report *r)
{
    if (r->found < r->cameras)
        adcgs_cli_note(cli, "no pose found for %u of %u cameras, which are left out", r->cameras - r->found, r->cameras);
    else if (!r->cameras && r->posed < POSED_WELL * r->pictures)
        adcgs_cli_note(cli,
                       "no pose found for %u of %u images, which are left out: take sharper images with more overlap, or "
                       "more --frames of a video",
                       r->pictures - r->posed, r->pictures);
    if (r->models > 1)
        adcgs_cli_note(cli, "the images form %u scenes that share no points: the largest was taken", r->models);
    if (r->error > ERROR_FINE)
        adcgs_cli_note(cli,
                       "points are %.1f pixels off on average, expected less than %g: poses or lens are inexact; try "
                       "another --lens, or mask moving regions",
                       r->error, ERROR_FINE);
    if (r->points && r->angle < ADCGS_IMPORT_ANGLE_LEAST)
        adcgs_cli_note(cli,
                       "the camera hardly moves sideways: directions to a point are %.2g degrees apart, expected %g or more; "
                       "depth will be wrong",
                       r->angle, ADCGS_IMPORT_ANGLE_LEAST);
    if (r->track < TRACK_FINE)
        adcgs_cli_note(cli, "a point is in %.1f images on average, expected %g or more: take images with more overlap", r->track,
                       TRACK_FINE);
    if (r->spread > SPREAD_FINE)
        adcgs_cli_note(cli,
                       "a camera's poses at different times are %.1f %% of the rig's size apart: check that the cameras "
                       "stand still",
                       100.0 * r->spread);
    if (r->hdr)
        adcgs_cli_note(cli, "the video is of high dynamic range (%s): its frames are converted to the range of plain screens",
                       r->hdr);
    if (*r->sound_fault)
        adcgs_cli_note(cli, "the video's sound was left out: %s", r->sound_fault);
    if (r->is_numbered)
        adcgs_cli_note(cli, "the images' names are plain numbers: if they are frames of a video, --fps N keeps their times; "
                            "without it this scene is static");
}

/* ---- Command line ---- */

static const adcgs_cli program = {
    .program = "adcgs-import",
    .operands = "PHOTOS|VIDEO|VIDEOS...",
    .summary = "Make a scene for adcgs-enc of images or videos with unknown cameras.",
    .details = "Operands are images or folders of images; or the video of one moving camera; or videos of\n"
               "static, synchronised cameras. COLMAP finds the cameras.",
    .min_operands = 1,
    .max_operands = 100000,
};

/** Options for the scene and its footage. */
static void add_footage_options(adcgs_option_table *out, arguments *a)
{
    adcgs_import_options *const o = &a->import;
    const adcgs_option table[] = {
        {.name = "output",
         .letter = 'o',
         .kind = ADCGS_OPTION_STRING,
         .target = &o->output,
         .value = "FOLDER",
         .help = "folder of the scene, which is created (required)"},
        {.name = "fps",
         .kind = ADCGS_OPTION_STRING,
         .target = &a->fps,
         .value = "N[/D]",
         .help = "frames per second, if images are frames of a film, in the\norder of their names (default: all of one time)"},
        {.name = "frames",
         .kind = ADCGS_OPTION_INT,
         .target = &o->frames,
         .min = 3,
         .max = 10000,
         .value = "N",
         .help = "number of frames of a moving camera, at most, taken evenly\n(default 300)"},
        {.name = "side",
         .kind = ADCGS_OPTION_INT,
         .target = &o->side,
         .min = 64,
         .max = 16384,
         .value = "PIXELS",
         .help = "maximum width and height of images, pixels; larger images\nare reduced (default 1600)"},
        {.name = "masks",
         .kind = ADCGS_OPTION_STRING,
         .target = &o->masks,
         .value = "FOLDER",
         .help = "folder of masks with the images' or the cameras' names:\nblack regions are neither matched nor trained"},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the search of the cameras, and for the program. */
static void add_camera_options(adcgs_option_table *out, arguments *a)
{
    adcgs_import_options *const o = &a->import;
    static const char *const mappers[] = {"auto", "colmap", "glomap", NULL};
    static const char *const lenses[] = {"radial", "pinhole", "opencv", "fisheye", NULL};
    const adcgs_option table[] = {
        {.name = "lens",
         .kind = ADCGS_OPTION_CHOICE,
         .target = &o->lens,
         .choices = lenses,
         .value = "KIND",
         .help = "radial, pinhole, opencv or fisheye (default radial)"},
        {.name = "own-lens", .kind = ADCGS_OPTION_FLAG, .target = &o->own_lens, .help = "an own lens for each camera of a rig"},
        {.name = "anyway",
         .kind = ADCGS_OPTION_FLAG,
         .target = &o->anyway,
         .help = "accept poses of less than half of the images, and of a\ncamera that hardly moves sideways"},
        {.name = "test",
         .kind = ADCGS_OPTION_INT,
         .target = &o->test_every,
         .min = 0,
         .max = 10000,
         .value = "N",
         .help = "interval of the views, or static cameras, kept for testing\n(default 8; 0: none)"},
        {.name = "colmap",
         .kind = ADCGS_OPTION_STRING,
         .target = &o->colmap,
         .value = "PROGRAM",
         .help = "COLMAP's program (default: colmap on the path)"},
        {.name = "mapper",
         .kind = ADCGS_OPTION_CHOICE,
         .target = &o->mapper,
         .choices = mappers,
         .value = "NAME",
         .help = "program that places the cameras: auto, colmap or glomap\n(default auto: glomap if it is installed)"},
        {.name = "vocab-tree",
         .kind = ADCGS_OPTION_FILE,
         .target = &o->vocab_tree,
         .value = "FILE",
         .help = "vocabulary tree of COLMAP, which recognises places that a\nfilm shows again (default: an installed one)"},
        {.name = "threads",
         .letter = 'T',
         .kind = ADCGS_OPTION_INT,
         .target = &o->threads,
         .min = 0,
         .max = 256,
         .value = "N",
         .help = "threads of COLMAP (default: one per CPU)"},
        {.letter = 't', .kind = ADCGS_OPTION_FORMER, .value = "threads"},
        {.name = "json",
         .letter = 'J',
         .kind = ADCGS_OPTION_FLAG,
         .target = &a->json,
         .help = "print the result as one JSON object on stdout"},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Returns -1 to continue, else the exit code. */
static int parse(adcgs_cli *cli, arguments *a, int argc, char **argv)
{
    adcgs_import_options *const o = &a->import;
    adcgs_option_table options = {.n = 0};
    adcgs_error error;
    int first;
    add_footage_options(&options, a);
    add_camera_options(&options, a);
    cli->options = options.rows;
    cli->n_options = options.n;
    cli->quiet = &a->quiet;
    const int code = adcgs_cli_parse(cli, argc, argv, &first);
    cli->n_options = 0; /* options is local to this function */
    if (code >= 0)
        return code;
    o->inputs = argv + first;
    o->n_inputs = argc - first;
    if (!o->output || !*o->output)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "no output: give -o FOLDER");
    if (a->fps && adcgs_fps_read_option(&o->fps, a->fps, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    return -1;
}

static int import(const adcgs_cli *cli, const arguments *a)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_import_report report;
    adcgs_progress progress;
    adcgs_progress_init(&progress, cli);
    adcgs_progress_keep(&progress);
    adcgs_interrupt_catch(1);
    const adcgs_status status = adcgs_import(&a->import, &progress, &report, &error);
    adcgs_progress_clear(&progress);
    adcgs_progress_end(&progress);
    if (status != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    warn(cli, &report);
    if (!a->json)
        print_text(&report, a->import.output);
    else if (print_json(&report, a->import.output, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    return adcgs_cli_leave(cli, 0);
}

int main(int argc, char **argv)
{
    arguments a = {.import = {.colmap = "colmap", .side = ADCGS_SIDE_MOST, .frames = FRAMES, .test_every = TEST_EVERY}};
    adcgs_cli cli = program;
    const int code = parse(&cli, &a, argc, argv);
    if (code >= 0)
        return code;
    char *output = strdup(a.import.output);
    if (!output)
        return adcgs_cli_error(&cli, ADCGS_ERR_MEMORY, "out of memory");
    for (size_t n = strlen(output); n > 1 && output[n - 1] == '/'; n--) /* unfinished output goes next to it, not inside */
        output[n - 1] = 0;
    a.import.output = output;
    const int leave = import(&cli, &a);
    free(output);
    return leave;
}
