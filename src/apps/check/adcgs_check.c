/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-check: judges the footage of a scene without training it. */
#include "config.h"

#include "base/base.h"
#include "check/check_footage.h"
#include "cli/cli.h"
#include "scene/frames.h"
#include "scene/layouts/open.h"
#include "system/interrupt.h"
#include "system/json.h"
#include "system/text.h"
#include "train/scene_frame.h"

#include <adcgs/adcgs.h>

#include <stdlib.h>

/* Static points to match. Whole images are matched for any number of points, so more do not help the judgement; chosen by
 * hand, not measured. */
#define STATIC_POINTS 1000

typedef struct settings {
    const adcgs_cli *cli;
    const char *path, *frames, *fps;
    int dataset, threads, json, quiet, no_matching;
    uint64_t memory;
    adcgs_progress progress;
} settings;

/** A scene, and the findings on it. */
typedef struct judgement {
    adcgs_scene *scene;
    adcgs_camera_order order;
    adcgs_stereo matched;
    adcgs_thumbnail *thumbnails;
    adcgs_findings findings;
} judgement;

static int loading(void *user, uint32_t done, uint32_t n)
{
    adcgs_progress_show(user, "images    %6u/%u", done, n);
    return adcgs_interrupted();
}

static adcgs_status open_scene(judgement *j, const settings *s, adcgs_error *error)
{
    adcgs_scene_options options = {.dataset = s->dataset};
    if (s->frames)
        ADCGS_TRY(adcgs_frames_parse(&options.frames, s->frames, error));
    if (s->fps)
        ADCGS_TRY(adcgs_fps_read_option(&options.rate, s->fps, error));
    ADCGS_TRY(adcgs_scene_open(&j->scene, s->path, &options, error));
    return adcgs_camera_order_find(&j->order, j->scene->views[ADCGS_SPLIT_TRAIN], j->scene->n_views[ADCGS_SPLIT_TRAIN], error);
}

/** Matches the images, if that suits the scene, to judge the poses. */
static adcgs_status match(judgement *j, settings *s, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_stereo_options options = {.still = STATIC_POINTS, .judges = 1};
    int applies;
    ADCGS_TRY(adcgs_stereo_applies(j->scene, &applies, error));
    if (s->no_matching || !applies)
        return ADCGS_OK;
    adcgs_progress_show(&s->progress, "matching ...");
    ADCGS_TRY(adcgs_scene_frame(j->scene, options.origin, &options.scale, error));
    return adcgs_stereo_find(&j->matched, j->scene, &options, pool, error);
}

static adcgs_status judge(judgement *j, settings *s, adcgs_pool *pool, adcgs_error *error)
{
    const adcgs_image_store_config config = {.memory = s->memory, .progress = loading, .user = &s->progress};
    unsigned known = 0;
    ADCGS_TRY(open_scene(j, s, error));
    j->thumbnails = adcgs_alloc(NULL, j->scene->n_views[ADCGS_SPLIT_TRAIN], sizeof *j->thumbnails, error);
    if (!j->thumbnails)
        return adcgs_alloc_status(error);
    ADCGS_TRY(adcgs_thumbnails_load(j->thumbnails, j->scene, &config, pool, error));
    ADCGS_TRY(match(j, s, pool, error));
    const adcgs_footage_facts facts = {j->scene, 0, &j->matched, j->thumbnails};
    adcgs_check_footage(&j->findings, &facts, pool, &known);
    return adcgs_interrupted() ? adcgs_fail(error, ADCGS_ERR_IO, "interrupted") : ADCGS_OK;
}

/** "one moving camera", "4 static cameras", or "cameras that move or take one image each". */
static void name_cameras(const adcgs_camera_order *order, char text[64])
{
    if (order->moves)
        snprintf(text, 64, "one moving camera");
    else if (order->n)
        snprintf(text, 64, "%u static camera%s", order->n, adcgs_s(order->n));
    else
        snprintf(text, 64, "cameras that move or take one image each");
}

static void print_text(const judgement *j)
{
    const adcgs_scene *const scene = j->scene;
    const adcgs_camera *const c = &scene->views[ADCGS_SPLIT_TRAIN][0].camera;
    char cameras[64];
    name_cameras(&j->order, cameras);
    printf("views       %u training, %u validation, %u test\n", scene->n_views[ADCGS_SPLIT_TRAIN],
           scene->n_views[ADCGS_SPLIT_VAL], scene->n_views[ADCGS_SPLIT_TEST]);
    printf("cameras     %s, first image %dx%d\n", cameras, c->width, c->height);
    printf("time        %g s, %u timestamp%s\n", scene->duration, scene->n_times, adcgs_s(scene->n_times));
    printf("points      %u given, %u static points matched\n", scene->points.n, j->matched.n_still);
    for (int i = 0; i < scene->n_remarks; i++) {
        fputs("remark      ", stdout);
        adcgs_text_show(stdout, scene->remarks[i]);
        putchar('\n');
    }
    for (int i = 0; i < j->findings.n; i++) {
        printf("%-12s", adcgs_finding_names[j->findings.list[i].kind]);
        adcgs_text_show(stdout, j->findings.list[i].text);
        putchar('\n');
    }
    if (!j->findings.n)
        puts("findings    none");
}

static adcgs_status print_json(const judgement *j, adcgs_error *error)
{
    const adcgs_scene *const scene = j->scene;
    adcgs_json out;
    adcgs_json_init(&out);
    adcgs_json_open(&out, NULL, '{');
    adcgs_json_string(&out, "scene", scene->directory);
    adcgs_json_int(&out, "training_views", scene->n_views[ADCGS_SPLIT_TRAIN]);
    adcgs_json_int(&out, "validation_views", scene->n_views[ADCGS_SPLIT_VAL]);
    adcgs_json_int(&out, "test_views", scene->n_views[ADCGS_SPLIT_TEST]);
    adcgs_json_int(&out, "static_cameras", j->order.moves ? 0 : j->order.n);
    adcgs_json_bool(&out, "moving_camera", j->order.moves);
    adcgs_json_real(&out, "seconds", scene->duration);
    adcgs_json_int(&out, "timestamps", scene->n_times);
    adcgs_json_int(&out, "points", scene->points.n);
    adcgs_json_int(&out, "matched_points", j->matched.n_still);
    adcgs_json_open(&out, "remarks", '[');
    for (int i = 0; i < scene->n_remarks; i++)
        adcgs_json_string(&out, NULL, scene->remarks[i]);
    adcgs_json_close(&out);
    adcgs_json_open(&out, "findings", '[');
    for (int i = 0; i < j->findings.n; i++) {
        adcgs_json_open(&out, NULL, '{');
        adcgs_json_string(&out, "kind", adcgs_finding_names[j->findings.list[i].kind]);
        adcgs_json_string(&out, "text", j->findings.list[i].text);
        adcgs_json_close(&out);
    }
    adcgs_json_close(&out);
    adcgs_json_close(&out);
    return adcgs_json_write(&out, stdout, "standard output", error);
}

/** *found: whether there are findings. */
static adcgs_status run(settings *s, int *found, adcgs_error *error)
{
    judgement j = {.scene = NULL};
    adcgs_pool *pool = NULL;
    ADCGS_TRY(adcgs_cli_pool(s->cli, &pool, s->threads, error));
    adcgs_progress_init(&s->progress, s->cli);
    adcgs_status status = judge(&j, s, pool, error);
    adcgs_progress_end(&s->progress);
    if (status == ADCGS_OK && s->json)
        status = print_json(&j, error);
    else if (status == ADCGS_OK)
        print_text(&j);
    *found = j.findings.n > 0;
    adcgs_findings_clear(&j.findings);
    adcgs_free(NULL, j.thumbnails);
    adcgs_stereo_clear(&j.matched);
    adcgs_camera_order_clear(&j.order);
    adcgs_scene_free(&j.scene);
    adcgs_pool_free(&pool);
    return status;
}

static void list_options(adcgs_option_table *out, settings *s)
{
    const adcgs_option table[] = {
        {.name = "json", .letter = 'J', .kind = ADCGS_OPTION_FLAG, .target = &s->json, .help = "print one JSON object"},
        {.name = "no-matching",
         .kind = ADCGS_OPTION_FLAG,
         .target = &s->no_matching,
         .help = "do not match images: poses and axes are judged\nby points and places alone"},
        {.name = "dataset",
         .kind = ADCGS_OPTION_CHOICE,
         .target = &s->dataset,
         .value = "KIND",
         .help = "kind of the scene, instead of detecting it by its files:\n"
                 "auto, transforms, hypernerf, llff, colmap, adcgs, splats\n"
                 "or panoptic",
         .choices = adcgs_dataset_names},
        {.name = "frames",
         .kind = ADCGS_OPTION_STRING,
         .target = &s->frames,
         .value = "A:B:STEP",
         .help =
             "frames A, A + STEP, ... below B of videos, or timestamps of\nimages, counted so; A, B or :STEP may be left out"},
        {.name = "fps",
         .kind = ADCGS_OPTION_STRING,
         .target = &s->fps,
         .value = "N[/D]",
         .help = "rate of the selected frames, per second (default: the\nscene's, else 30)"},
        {.name = "memory",
         .kind = ADCGS_OPTION_SIZE,
         .target = &s->memory,
         .min = 1,
         .max = 1e15,
         .value = "BYTES",
         .help = "maximum memory of images, bytes (2G; default: half of the\nmachine's)"},
        {.name = "threads",
         .letter = 'T',
         .kind = ADCGS_OPTION_INT,
         .target = &s->threads,
         .max = 256,
         .value = "N",
         .help = "threads (default: one per CPU)"},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

int main(int argc, char **argv)
{
    settings s = {.path = NULL};
    adcgs_option_table options = {.n = 0};
    list_options(&options, &s);
    const adcgs_cli cli = {.program = "adcgs-check",
                           .operands = "SCENE",
                           .summary = "Judge the footage of a scene before training: images, light, clocks, poses, axes.",
                           .details = "Exit status: 0 nothing found, 1 findings, 2 usage, 3 input or output, 4 invalid data,\n"
                                      "5 unsupported.",
                           .options = options.rows,
                           .n_options = options.n,
                           .min_operands = 1,
                           .max_operands = 1,
                           .quiet = &s.quiet};
    int first, found = 0;
    const int code = adcgs_cli_parse(&cli, argc, argv, &first);
    if (code >= 0)
        return code;
    adcgs_error error = {ADCGS_OK, ""};
    s.cli = &cli;
    s.path = argv[first];
    adcgs_interrupt_catch(1);
    error.status = run(&s, &found, &error);
    return adcgs_cli_leave(&cli, error.status != ADCGS_OK ? adcgs_cli_fail(&cli, &error) : found);
}
