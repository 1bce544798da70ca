/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-demo-scene: writes one of the built-in scenes, for a first try. */
#include "cli/cli.h"
#include "synthetic/scenes.h"

#include <stdio.h>

#define SCENES_MAX 128 /* scenes that completion offers; definition, above the scenes there are */

/** As on the command line. */
typedef struct arguments {
    const char *names[SCENES_MAX + 1]; /* of the scenes, for completion */
    const char *scene, *directory, *spoil;
    int size[2], frames, cameras, watch, format, threads, list, quiet;
    double motion, noise, aside;
} arguments;

static const char *const formats[] = {"png", "ppm", NULL};

static void show(void *user, int done, int total)
{
    adcgs_progress_show(user, "image %d of %d", done, total);
}

/** Options for the content: scene, sizes and motion. */
static void add_content_options(adcgs_option_table *out, arguments *a)
{
    const adcgs_option table[] = {
        {.name = "scene",
         .kind = ADCGS_OPTION_STRING,
         .target = &a->scene,
         .value = "NAME",
         .choices = a->names,
         .help = "name of the scene (default: demo)"},
        {.name = "size",
         .kind = ADCGS_OPTION_PAIR,
         .target = a->size,
         .min = 1,
         .max = 16384,
         .value = "WxH",
         .help = "size of the images, pixels (default: the scene's own)"},
        {.name = "motion",
         .kind = ADCGS_OPTION_REAL,
         .target = &a->motion,
         .min = 0.001,
         .max = 10.0,
         .value = "FACTOR",
         .help = "factor of all motion (default: 1)"},
        {.name = "frames",
         .kind = ADCGS_OPTION_INT,
         .target = &a->frames,
         .min = 1,
         .max = 100000,
         .value = "N",
         .help = "number of timestamps in the same duration (default:\nthe scene's own)"},
        {.name = "moments", .kind = ADCGS_OPTION_FORMER, .value = "frames"},
        {.name = "cameras",
         .kind = ADCGS_OPTION_INT,
         .target = &a->cameras,
         .min = 1,
         .max = 1000,
         .value = "N",
         .help = "number of training cameras (default: the scene's own)"},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the faults of the training views, and for the views that are not for training. */
static void add_fault_options(adcgs_option_table *out, arguments *a)
{
    const adcgs_option table[] = {
        {.name = "noise",
         .kind = ADCGS_OPTION_REAL,
         .target = &a->noise,
         .min = 0.0,
         .max = 64.0,
         .value = "LEVELS",
         .help = "standard deviation of noise in training images, of 255\nlevels (default: 0)"},
        {.name = "spoil",
         .kind = ADCGS_OPTION_STRING,
         .target = &a->spoil,
         .value = "NAME=X,...",
         .help = "faults of the training views with their sizes: exposure,\nwhite, step, pose, shake, wrongpose, axes, sync,\n"
                 "drop, twice, before, inside, after"},
        {.name = "watch",
         .kind = ADCGS_OPTION_INT,
         .target = &a->watch,
         .min = 2,
         .max = 1000,
         .value = "N",
         .help = "number of validation views, consecutive, of one static\ncamera"},
        {.name = "aside",
         .kind = ADCGS_OPTION_REAL,
         .target = &a->aside,
         .min = 0.0,
         .max = 0.5,
         .value = "TURNS",
         .help = "distance of the test camera from the last training\ncamera, turns (default 0: among the training cameras)"},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Options for the files and the program. */
static void add_output_options(adcgs_option_table *out, arguments *a)
{
    const adcgs_option table[] = {
        {.name = "output",
         .letter = 'o',
         .kind = ADCGS_OPTION_FILE,
         .target = &a->directory,
         .value = "DIR",
         .help = "folder to write (default: demo-scene)"},
        {.name = "format",
         .kind = ADCGS_OPTION_CHOICE,
         .target = &a->format,
         .value = "FORMAT",
         .choices = formats,
         .help = "format of the images: png or ppm (default: png)"},
        {.name = "threads",
         .letter = 'T',
         .kind = ADCGS_OPTION_INT,
         .target = &a->threads,
         .min = 0,
         .max = 256,
         .value = "N",
         .help = "threads (default: one per CPU)"},
        {.name = "list", .kind = ADCGS_OPTION_FLAG, .target = &a->list, .help = "list the scenes and exit"},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

/** Prints the names of all scenes, each with its description. */
static void list_scenes(void)
{
    for (int i = 0; adcgs_scenes_name(i); i++)
        printf("%-8s %s\n", adcgs_scenes_name(i), adcgs_scenes_about(i));
}

static int write_scene(const adcgs_cli *cli, const arguments *a)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_pool *pool = NULL;
    adcgs_progress progress;
    adcgs_scenes_options wanted = {.name = a->scene,
                                   .width = a->size[0],
                                   .height = a->size[1],
                                   .frames = a->frames,
                                   .cameras = a->cameras,
                                   .watch = a->watch,
                                   .aside = a->aside,
                                   .noise = a->noise,
                                   .format = formats[a->format],
                                   .motion = a->motion};
    if (adcgs_spoil_parse(&wanted.spoil, a->spoil, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    if (adcgs_cli_pool(cli, &pool, a->threads, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_progress_init(&progress, cli);
    const adcgs_status status = adcgs_scenes_write(a->directory, &wanted, pool, show, &progress, &error);
    adcgs_progress_clear(&progress);
    adcgs_pool_free(&pool);
    return status == ADCGS_OK ? 0 : adcgs_cli_fail(cli, &error);
}

int main(int argc, char **argv)
{
    arguments a = {.scene = "demo", .directory = "demo-scene", .motion = 1.0};
    adcgs_option_table options = {.n = 0};
    int first = 0;
    for (int i = 0; i < SCENES_MAX && adcgs_scenes_name(i); i++)
        a.names[i] = adcgs_scenes_name(i);
    add_content_options(&options, &a);
    add_fault_options(&options, &a);
    add_output_options(&options, &a);
    const adcgs_cli cli = {.program = "adcgs-demo-scene",
                           .operands = "",
                           .summary = "Render a built-in animated scene to a folder.",
                           .options = options.rows,
                           .n_options = options.n,
                           .quiet = &a.quiet};
    const int leave = adcgs_cli_parse(&cli, argc, argv, &first);
    if (leave >= 0)
        return leave;
    if (!a.list)
        return write_scene(&cli, &a);
    list_scenes();
    return adcgs_cli_leave(&cli, 0);
}
