/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-demo-scene: writes one of the built-in scenes, for a first try. */
#include "cli/cli.h"
#include "scenes/scenes.h"

#include <stdio.h>

#define SCENES_MAX 128 /* scenes that completion offers */

static void show(void *user, int done, int total)
{
    adcgs_progress_show(user, "image %d of %d", done, total);
}

int main(int argc, char **argv)
{
    static const char *const formats[] = {"png", "ppm", NULL};
    const char *scenes[SCENES_MAX + 1] = {0};
    for (int i = 0; i < SCENES_MAX && adcgs_scenes_name(i); i++)
        scenes[i] = adcgs_scenes_name(i);
    const char *scene = "demo", *directory = "demo-scene", *spoil = NULL;
    int size[2] = {0, 0}, frames = 0, cameras = 0, watch = 0, format = 0, threads = 0, list = 0, quiet = 0, first = 0;
    double motion = 1.0, noise = 0.0, aside = 0.0;
    const adcgs_option options[] = {
        {.name = "scene",
         .kind = ADCGS_OPTION_STRING,
         .target = &scene,
         .value = "NAME",
         .choices = scenes,
         .help = "name of the scene (default: demo)"},
        {.name = "size",
         .kind = ADCGS_OPTION_PAIR,
         .target = size,
         .min = 1,
         .max = 16384,
         .value = "WxH",
         .help = "size of the images, pixels (default: the scene's own)"},
        {.name = "motion",
         .kind = ADCGS_OPTION_REAL,
         .target = &motion,
         .min = 0.001,
         .max = 10.0,
         .value = "FACTOR",
         .help = "factor of all motion (default: 1)"},
        {.name = "frames",
         .kind = ADCGS_OPTION_INT,
         .target = &frames,
         .min = 1,
         .max = 100000,
         .value = "N",
         .help = "number of timestamps in the same duration (default:\nthe scene's own)"},
        {.name = "moments", .kind = ADCGS_OPTION_FORMER, .value = "frames"},
        {.name = "cameras",
         .kind = ADCGS_OPTION_INT,
         .target = &cameras,
         .min = 1,
         .max = 1000,
         .value = "N",
         .help = "number of training cameras (default: the scene's own)"},
        {.name = "noise",
         .kind = ADCGS_OPTION_REAL,
         .target = &noise,
         .min = 0.0,
         .max = 64.0,
         .value = "LEVELS",
         .help = "standard deviation of noise in training images, of 255\nlevels (default: 0)"},
        {.name = "spoil",
         .kind = ADCGS_OPTION_STRING,
         .target = &spoil,
         .value = "NAME=X,...",
         .help = "faults of the training views with their sizes: exposure,\nwhite, step, pose, shake, wrongpose, axes, sync,\n"
                 "drop, twice, before, inside, after"},
        {.name = "watch",
         .kind = ADCGS_OPTION_INT,
         .target = &watch,
         .min = 2,
         .max = 1000,
         .value = "N",
         .help = "number of validation views, consecutive, of one static\ncamera"},
        {.name = "aside",
         .kind = ADCGS_OPTION_REAL,
         .target = &aside,
         .min = 0.0,
         .max = 0.5,
         .value = "TURNS",
         .help = "distance of the test camera from the last training\ncamera, turns (default 0: among the training cameras)"},
        {.name = "output",
         .letter = 'o',
         .kind = ADCGS_OPTION_FILE,
         .target = &directory,
         .value = "DIR",
         .help = "folder to write (default: demo-scene)"},
        {.name = "format",
         .kind = ADCGS_OPTION_CHOICE,
         .target = &format,
         .value = "FORMAT",
         .choices = formats,
         .help = "format of the images: png or ppm (default: png)"},
        {.name = "threads",
         .kind = ADCGS_OPTION_INT,
         .target = &threads,
         .min = 0,
         .max = 256,
         .value = "N",
         .help = "threads (default: one per CPU)"},
        {.name = "list", .kind = ADCGS_OPTION_FLAG, .target = &list, .help = "list the scenes and exit"},
    };
    const adcgs_cli cli = {.program = "adcgs-demo-scene",
                           .operands = "",
                           .summary = "Render a built-in animated scene to a folder.",
                           .options = options,
                           .n_options = ADCGS_COUNTOF(options),
                           .quiet = &quiet};
    const int leave = adcgs_cli_parse(&cli, argc, argv, &first);
    if (leave >= 0)
        return leave;
    for (int i = 0; list && adcgs_scenes_name(i); i++)
        printf("%-8s %s\n", adcgs_scenes_name(i), adcgs_scenes_about(i));
    adcgs_error error = {ADCGS_OK, ""};
    if (list)
        return adcgs_cli_leave(&cli, 0);
    adcgs_pool *pool = NULL;
    adcgs_progress progress;
    adcgs_scenes_options wanted = {.name = scene,
                                   .width = size[0],
                                   .height = size[1],
                                   .frames = frames,
                                   .cameras = cameras,
                                   .watch = watch,
                                   .aside = aside,
                                   .noise = noise,
                                   .format = formats[format],
                                   .motion = motion};
    if (adcgs_spoil_parse(&wanted.spoil, spoil, &error) != ADCGS_OK)
        return adcgs_cli_fail(&cli, &error);
    if (adcgs_cli_pool(&cli, &pool, threads, &error) != ADCGS_OK)
        return adcgs_cli_fail(&cli, &error);
    adcgs_progress_init(&progress, &cli);
    const adcgs_status status = adcgs_scenes_write(directory, &wanted, pool, show, &progress, &error);
    adcgs_progress_clear(&progress);
    adcgs_pool_free(&pool);
    return status == ADCGS_OK ? 0 : adcgs_cli_fail(&cli, &error);
}
