/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-eval: measures a stream against the images of a scene. */
#include "config.h"

#include "apps/eval/eval_match.h"
#include "apps/eval/eval_report.h"
#include "base/cpu_detect.h"
#include "cli/cli.h"
#include "media/dynamic/dynamic_splats.h"
#include "media/image/mosaic.h"
#include "media/kind.h"
#include "media/operand.h"
#include "metric/crop.h"
#include "scene/layouts/open.h"
#include "system/interrupt.h"
#include "train/settings.h"

#include <adcgs/adcgs.h>

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>

typedef struct settings {
    const adcgs_cli *cli;
    const char *file, *scene, *images, *crop, *frames, *csv, *metrics;
    adcgs_config config;
    adcgs_box box; /**< box of --crop, if given as numbers */
    int quiet, split, cpu, json, as_is, beside, dataset, tiers, scale;
    int measure; /**< of --metrics: flags of metric/evaluate.h */
} settings;

/** Passes the views' scores to the report. */
typedef struct report {
    const settings *set;
    adcgs_eval_report out;
    adcgs_progress progress;
    uint32_t done, n;
    adcgs_box box; /**< of --crop */
} report;

static const char *const splits[] = {"train", "val", "test", NULL}; /* in the order of adcgs_split */

static void list_options(adcgs_option_table *out, settings *s)
{
    const adcgs_option table[] = {
        {"split", 0, ADCGS_OPTION_CHOICE, &s->split, 0, 0, "NAME", "views to compare: test, val or train (default test)", splits,
         NULL},
        {"dataset", 0, ADCGS_OPTION_CHOICE, &s->dataset, 0, 0, "KIND",
         "kind of the scene, instead of detecting it by its files:\nauto, transforms, hypernerf, llff, colmap, adcgs, splats\n"
         "or panoptic",
         adcgs_dataset_names, NULL},
        {"frames", 0, ADCGS_OPTION_STRING, &s->frames, 0, 0, "A:B:STEP", "frames that the stream was made of, as for adcgs-enc",
         NULL, NULL},
        {"scale", 0, ADCGS_OPTION_INT, &s->scale, 1, 64, "S",
         "divisor of the image size for the measurement, an integer\n(default: as for the stream's training)", NULL, NULL},
        {"layers", 'L', ADCGS_OPTION_INT, &s->config.layers, 1, 5, "N", "layers of the stream to use, at most", NULL, NULL},
        {.letter = 'l', .kind = ADCGS_OPTION_FORMER, .value = "layers"},
        {"tiers", 0, ADCGS_OPTION_INT, &s->tiers, 1, 8, "N", "tiers of the stream to render; fewer give a coarser image", NULL,
         NULL},
        {"images", 0, ADCGS_OPTION_FILE, &s->images, 0, 0, "DIR", "folder for the decoded views as PNG", NULL, NULL},
        {"beside", 0, ADCGS_OPTION_FLAG, &s->beside, 0, 0, NULL,
         "in these images: ground truth, decoded view, and four times\ntheir difference round grey, side by side", NULL, NULL},
        {"crop", 0, ADCGS_OPTION_STRING, &s->crop, 0, 0, "BOX",
         "region to measure in addition, the visible part of the box\n"
         "X0,Y0,Z0,X1,Y1,Z1; points: a box round the initial points",
         NULL, NULL},
        {"scene-background", 0, ADCGS_OPTION_FLAG, &s->as_is, 0, 0, NULL,
         "composite images with alpha onto the scene's background\ninstead of the stream's", NULL, NULL},
        {"threads", 'T', ADCGS_OPTION_INT, &s->config.threads, 1, 256, "N", "threads (default: one per CPU)", NULL, NULL},
        {"cpu", 0, ADCGS_OPTION_CHOICE, &s->cpu, 0, 0, "LEVEL", "auto, scalar, avx2 or avx512; no effect on the figures",
         adcgs_cpu_names, NULL},
        {"metrics", 0, ADCGS_OPTION_STRING, &s->metrics, 0, 0, "LIST",
         "metrics in addition to PSNR and SSIM: all, or a list of\nfitted-psnr, ms-ssim, dynamic-psnr,\n"
         "fitted-dynamic-psnr, static-variance and flicker",
         NULL, NULL},
        {"csv", 0, ADCGS_OPTION_FILE, &s->csv, 0, 0, "FILE", "table with a row for each view; - prints it", NULL, NULL},
        {"json", 'J', ADCGS_OPTION_FLAG, &s->json, 0, 0, NULL, "print one JSON object", NULL, NULL},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

static adcgs_status write_views(const report *r, const adcgs_view_score *score, const char *path, adcgs_error *error)
{
    const size_t plane = (size_t)score->width * (size_t)score->height;
    const adcgs_samples truth = {score->truth, 1, plane}, decoded = {score->decoded, 1, plane};
    const int beside = r->set->beside;
    adcgs_mosaic mosaic;
    ADCGS_TRY(adcgs_mosaic_init(&mosaic, score->width, score->height, beside ? 3 : 1, 1, path, error));
    adcgs_mosaic_place(&mosaic, beside, 0, decoded);
    if (beside) {
        adcgs_mosaic_place(&mosaic, 0, 0, truth);
        adcgs_mosaic_difference(&mosaic, 2, 0, decoded, truth);
    }
    const adcgs_status status = adcgs_image_write(&mosaic.image, path, 0, error);
    adcgs_mosaic_clear(&mosaic);
    return status;
}

static adcgs_status write_image(const report *r, const adcgs_view_score *score, adcgs_error *error)
{
    const size_t size = strlen(r->set->images) + ADCGS_CAMERA_NAME_MAX + 32;
    char *path = malloc(size);
    if (!path)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", r->set->images);
    const int folder = snprintf(path, size, "%s/", r->set->images);
    snprintf(path + folder, size - (size_t)folder, "%04u-%s.png", r->done, score->view->camera.name);
    for (char *c = path + folder; *c; c++) /* any name stays a file in this folder */
        *c = *c == '/' || (unsigned char)*c < ' ' ? '_' : *c;
    const adcgs_status status = write_views(r, score, path, error);
    free(path);
    return status;
}

/** Parses --crop as six numbers. Returns 0, or -1 if they are no box. */
static int parse_box(const char *text, adcgs_box *box)
{
    for (int i = 0; i < 6; i++) {
        char *end;
        double *to = i < 3 ? &box->low[i] : &box->high[i - 3];
        *to = strtod(text, &end);
        if (end == text || !isfinite(*to) || *end != (i < 5 ? ',' : 0) || (i >= 3 && *to <= box->low[i - 3]))
            return -1;
        text = end + 1;
    }
    return 0;
}

static adcgs_status on_view(void *user, const adcgs_view_score *score, adcgs_error *error)
{
    report *r = user;
    adcgs_crop crop = {.visible = 0};
    adcgs_progress_clear(&r->progress);
    if (r->set->crop)
        ADCGS_TRY(adcgs_crop_measure(&crop, &r->box, score, error));
    if (r->set->images)
        ADCGS_TRY(write_image(r, score, error));
    ADCGS_TRY(adcgs_eval_report_view(&r->out, score, &crop, error));
    r->done++;
    adcgs_progress_show(&r->progress, "view %u of %u", r->done, r->n);
    return adcgs_interrupted() ? adcgs_fail(error, ADCGS_ERR_IO, "interrupted") : ADCGS_OK;
}

/** Frames of splats over time whose file does not state them: those that the stream was made from. 0: unknown. */
static uint32_t splat_frames(const adcgs_info *info)
{
    const double n = floor((info->time_end - info->time_start) * info->frame_rate + 0.5) + 1.0;
    return n >= 1.0 && n <= ADCGS_DYNAMIC_FRAMES_MAX ? (uint32_t)n : 0;
}

/** Opens the scene with the stream's frame rate, as the step of its times, and the stream's background for alpha. */
static adcgs_status open_scene(adcgs_scene **scene, const settings *s, const adcgs_info *info, adcgs_error *error)
{
    adcgs_scene_options options = {.has_background = !s->as_is,
                                   .rate = adcgs_fps_of(info->frame_rate),
                                   .splat_frames = splat_frames(info),
                                   .is_partial = 1,
                                   .dataset = s->dataset};
    if (s->frames)
        ADCGS_TRY(adcgs_frames_parse(&options.frames, s->frames, error));
    memcpy(options.background, info->background, sizeof options.background);
    return adcgs_scene_open(scene, s->scene, &options, error);
}

static adcgs_status compare_views(report *r, adcgs_decoder *decoder, const adcgs_scene *scene, adcgs_error *error)
{
    const adcgs_match match = {r->set->cli, r->set->file, r->set->scene, decoder, scene, (adcgs_split)r->set->split};
    adcgs_evaluation e;
    ADCGS_TRY(adcgs_match_check(&match, error));
    adcgs_eval_report_begin(&r->out);
    const adcgs_status status =
        adcgs_evaluate(&e, decoder, scene, (adcgs_split)r->set->split, r->set->measure, on_view, r, error);
    adcgs_progress_clear(&r->progress);
    ADCGS_TRY(status);
    adcgs_match_report(&match, &e);
    return adcgs_eval_report_end(&r->out, &e, error);
}

/** The divisor of the training images, from the settings in the stream; 1 if the stream has none. */
static int scale_of(const adcgs_decoder *decoder)
{
    const char *const value = adcgs_setting_in_list(adcgs_get_metadata(decoder, "settings"), "scale");
    const int scale = value ? atoi(value) : 1;
    return scale >= 1 && scale <= 64 ? scale : 1;
}

/** Sets the requested size, or that of training. */
static void choose_size(const settings *s, adcgs_decoder *decoder, adcgs_scene *scene)
{
    scene->measured = s->scale ? s->scale : scale_of(decoder);
    if (!s->scale && scene->measured > 1)
        adcgs_cli_note(s->cli,
                       "%s: trained on images of 1/%d of the size, and measured on the same; --scale 1 measures at full "
                       "size",
                       s->file, scene->measured);
}

static adcgs_status compare(report *r, adcgs_decoder *decoder, adcgs_error *error)
{
    const settings *s = r->set;
    adcgs_info info;
    adcgs_scene *scene = NULL;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    ADCGS_TRY(open_scene(&scene, s, &info, error));
    choose_size(s, decoder, scene);
    r->n = scene->n_views[s->split];
    r->out.bytes = info.bytes.total;
    r->out.layers = info.layers;
    adcgs_progress_init(&r->progress, s->cli);
    adcgs_status status = ADCGS_OK;
    if (s->crop && !strcmp(s->crop, "points"))
        status = adcgs_box_of_points(&r->box, scene, error);
    if (status == ADCGS_OK)
        status = compare_views(r, decoder, scene, error);
    adcgs_scene_free(&scene);
    return status;
}

static adcgs_status check_operands(const settings *s, adcgs_error *error)
{
    const adcgs_kind_class class = adcgs_kind_at(s->file)->class;
    if (class != ADCGS_KIND_STREAM && class != ADCGS_KIND_PAGE && adcgs_kind_at(s->scene)->class == ADCGS_KIND_STREAM)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%.100s is a stream and %.100s is not: give the stream first, then the scene",
                          s->scene, s->file);
    return adcgs_kind_check(s->file, ADCGS_WANT_STREAM, error);
}

static adcgs_status decode_and_compare(report *r, adcgs_error *error)
{
    adcgs_decoder *decoder = NULL;
    const double start = adcgs_seconds();
    adcgs_operand source;
    adcgs_status status = adcgs_operand_decode(&decoder, &source, r->set->file, &r->set->config, error);
    r->out.decode_seconds = adcgs_seconds() - start;
    if (status == ADCGS_OK)
        status = adcgs_set_tiers(decoder, r->set->tiers, error);
    if (status == ADCGS_OK)
        status = compare(r, decoder, error);
    adcgs_close(&decoder);
    adcgs_operand_close(&source);
    return status;
}

static adcgs_status run(const settings *s, adcgs_error *error)
{
    report r = {.set = s, .box = s->box};
    r.out = (adcgs_eval_report){.file = s->file,
                                .scene = s->scene,
                                .split = splits[s->split],
                                .csv = s->csv,
                                .measure = s->measure,
                                .as_json = s->json,
                                .box = s->crop ? &r.box : NULL};
    ADCGS_TRY(check_operands(s, error));
    if (s->images && mkdir(s->images, 0777) && errno != EEXIST)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot make the folder: %s", s->images, strerror(errno));
    ADCGS_TRY(adcgs_eval_report_open(&r.out, error));
    adcgs_status status = decode_and_compare(&r, error);
    adcgs_eval_report_clear(&r.out);
    return status == ADCGS_OK ? adcgs_cli_flush(error) : status;
}

int main(int argc, char **argv)
{
    settings s = {.split = ADCGS_SPLIT_TEST};
    adcgs_option_table options = {.n = 0};
    adcgs_config_init(&s.config, sizeof s.config);
    list_options(&options, &s);
    static const adcgs_option_rule rules[] = {{"beside", ADCGS_OPTION_NEEDS, "images"}};
    const adcgs_cli cli = {.program = "adcgs-eval",
                           .operands = "FILE SCENE",
                           .summary = "Render the views of a scene from a stream and compare them with its images.",
                           .details = "PSNR and SSIM are of frames rounded to 8 bits; speed is 1 / the median render time.\n"
                                      "Exit status: 0 done, 2 usage, 3 input or output, 4 invalid data, 5 unsupported.",
                           .options = options.rows,
                           .n_options = options.n,
                           .rules = rules,
                           .n_rules = ADCGS_COUNTOF(rules),
                           .min_operands = 2,
                           .max_operands = 2,
                           .quiet = &s.quiet};
    int first;
    const int done = adcgs_cli_parse(&cli, argc, argv, &first);
    if (done >= 0)
        return done;
    if (s.crop && strcmp(s.crop, "points") && parse_box(s.crop, &s.box))
        return adcgs_cli_error(&cli, ADCGS_ERR_USAGE,
                               "--crop %.100s: expected points, or X0,Y0,Z0,X1,Y1,Z1 with X0 < X1, Y0 < Y1 and Z0 < Z1", s.crop);
    if (s.metrics && adcgs_eval_parse_metrics(s.metrics, &s.measure))
        return adcgs_cli_error(&cli, ADCGS_ERR_USAGE, "--metrics %.100s: expected " ADCGS_EVAL_METRICS, s.metrics);
    if (s.json && s.csv && !strcmp(s.csv, "-"))
        return adcgs_cli_error(&cli, ADCGS_ERR_USAGE, "--json and --csv - both write to standard output: give --csv a file");
    s.cli = &cli;
    s.file = argv[first];
    s.scene = argv[first + 1];
    s.config.cpu = (adcgs_cpu_level)s.cpu;
    adcgs_error error = {0};
    adcgs_interrupt_catch(1);
    error.status = adcgs_cli_pool(&cli, &s.config.pool, s.config.threads, &error);
    if (error.status == ADCGS_OK)
        error.status = run(&s, &error);
    adcgs_pool_free(&s.config.pool);
    return adcgs_cli_leave(&cli, error.status != ADCGS_OK ? adcgs_cli_fail(&cli, &error) : 0);
}
