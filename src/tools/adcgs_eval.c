/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-eval: measure a stream against the pictures of a scene. */
#include "config.h"

#include "base/cpu.h"
#include "metric/crop.h"
#include "tools/cli.h"
#include "tools/mosaic.h"

#include <adcgs/adcgs.h>

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>

typedef struct settings {
    const char *file, *scene, *images, *crop, *frames;
    adcgs_config config;
    adcgs_box box; /**< of --crop, where it gives numbers */
    int split, cpu, json, as_is, beside, dataset;
} settings;

/** What the views' scores go through. */
typedef struct report {
    const settings *set;
    adcgs_json json;
    adcgs_progress progress;
    uint32_t done, n;
    adcgs_box box;      /**< of --crop */
    adcgs_crop crop;    /**< sums over the views that see it, then means */
    uint32_t n_crops;
} report;

static const char *const splits[] = {"train", "val", "test", NULL}; /* in the order of adcgs_split */

#define OPTION_COUNT 11
static void make_options(settings *s, adcgs_option options[OPTION_COUNT])
{
    const adcgs_option table[OPTION_COUNT] = {
        {"split", 0, ADCGS_OPTION_CHOICE, &s->split, 0, 0, "NAME", "views to compare: test (the default), val or train", splits,
         NULL},
        {"dataset", 0, ADCGS_OPTION_CHOICE, &s->dataset, 0, 0, "KIND",
         "kind of the scene, instead of telling it by its files:\nauto, transforms, hypernerf, llff, colmap, adcgs or splats",
         adcgs_dataset_names, NULL},
        {"frames", 0, ADCGS_OPTION_STRING, &s->frames, 0, 0, "A:B:STEP",
         "the frames that the stream was made of, as for adcgs-enc", NULL, NULL},
        {"layers", 'l', ADCGS_OPTION_INT, &s->config.layers, 1, 5, "N", "use at most N layers of the stream", NULL, NULL},
        {"images", 0, ADCGS_OPTION_STRING, &s->images, 0, 0, "DIR", "write the decoded views there as PNG", NULL, NULL},
        {"beside", 0, ADCGS_OPTION_FLAG, &s->beside, 0, 0, NULL,
         "in these pictures: truth, decoded view, and four times their\ndifference round grey, side by side", NULL, NULL},
        {"crop", 0, ADCGS_OPTION_STRING, &s->crop, 0, 0, "BOX",
         "measure, too, where the box X0,Y0,Z0,X1,Y1,Z1 is seen;\npoints: a box round the scene's initial points", NULL, NULL},
        {"scene-background", 0, ADCGS_OPTION_FLAG, &s->as_is, 0, 0, NULL,
         "put pictures with alpha on the scene's background\ninstead of the stream's", NULL, NULL},
        {"threads", 0, ADCGS_OPTION_INT, &s->config.threads, 1, 256, "N", "threads; without it one per processor", NULL, NULL},
        {"cpu", 0, ADCGS_OPTION_CHOICE, &s->cpu, 0, 0, "LEVEL", "auto, scalar, avx2 or avx512; figures do not depend on it",
         adcgs_cpu_names, NULL},
        {"json", 0, ADCGS_OPTION_FLAG, &s->json, 0, 0, NULL, "print one JSON object", NULL, NULL},
    };
    memcpy(options, table, sizeof table);
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
    snprintf(path, size, "%s/%04u-%s.png", r->set->images, r->done, score->view->camera.name);
    const adcgs_status status = write_views(r, score, path, error);
    free(path);
    return status;
}

/** --crop as six numbers: 0, or -1 if they are no box. */
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

static adcgs_status add_crop(report *r, const adcgs_view_score *score, adcgs_crop *crop, adcgs_error *error)
{
    *crop = (adcgs_crop){.psnr = NAN, .ssim = NAN};
    if (!r->set->crop)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_crop_measure(crop, &r->box, score, error));
    if (crop->visible) {
        r->crop.psnr += crop->psnr;
        r->crop.ssim += crop->ssim;
        r->n_crops++;
    }
    return ADCGS_OK;
}

static void show_crop(report *r, const adcgs_crop *crop)
{
    if (!r->set->json) {
        printf(crop->visible ? "   crop %8.2f dB %8.4f" : "   crop out of sight", crop->psnr, crop->ssim);
        return;
    }
    if (crop->visible) {
        adcgs_json_open(&r->json, "crop", '[');
        for (int i = 0; i < 4; i++)
            adcgs_json_int(&r->json, NULL, crop->rectangle[i]);
        adcgs_json_close(&r->json, ']');
    }
    adcgs_json_real(&r->json, "crop_psnr", crop->psnr);
    adcgs_json_real(&r->json, "crop_ssim", crop->ssim);
}

static adcgs_status on_view(void *user, const adcgs_view_score *score, adcgs_error *error)
{
    report *r = user;
    adcgs_crop crop;
    adcgs_progress_clear(&r->progress);
    ADCGS_TRY(add_crop(r, score, &crop, error));
    if (r->set->images)
        ADCGS_TRY(write_image(r, score, error));
    if (r->set->json) {
        adcgs_json_open(&r->json, NULL, '{');
        adcgs_json_string(&r->json, "name", score->view->camera.name);
        adcgs_json_real(&r->json, "time", score->view->time);
        adcgs_json_real(&r->json, "psnr", score->psnr);
        adcgs_json_real(&r->json, "ssim", score->ssim);
        adcgs_json_real(&r->json, "milliseconds", 1e3 * score->seconds);
    } else
        printf("%-24s %8.3f s %8.2f dB %8.4f", score->view->camera.name, score->view->time, score->psnr, score->ssim);
    if (r->set->crop)
        show_crop(r, &crop);
    if (r->set->json)
        adcgs_json_close(&r->json, '}');
    else
        printf("\n");
    r->done++;
    adcgs_progress_show(&r->progress, "view %u of %u", r->done, r->n);
    return adcgs_interrupted() ? adcgs_fail(error, ADCGS_ERR_IO, "interrupted") : ADCGS_OK;
}

static void begin_json(report *r, const adcgs_info *info, double decode_seconds)
{
    adcgs_json_init(&r->json, stdout);
    adcgs_json_open(&r->json, NULL, '{');
    adcgs_json_string(&r->json, "file", r->set->file);
    adcgs_json_string(&r->json, "scene", r->set->scene);
    adcgs_json_string(&r->json, "split", splits[r->set->split]);
    adcgs_json_int(&r->json, "bytes", (int64_t)info->bytes.total);
    adcgs_json_int(&r->json, "layers", info->layers);
    adcgs_json_real(&r->json, "decode_seconds", decode_seconds);
    if (r->set->crop) {
        adcgs_json_open(&r->json, "crop_box", '[');
        for (int i = 0; i < 6; i++)
            adcgs_json_real(&r->json, NULL, i < 3 ? r->box.low[i] : r->box.high[i - 3]);
        adcgs_json_close(&r->json, ']');
    }
    adcgs_json_open(&r->json, "views", '[');
}

static adcgs_status end_json(report *r, const adcgs_evaluation *e, adcgs_error *error)
{
    adcgs_json_close(&r->json, ']');
    adcgs_json_real(&r->json, "psnr", e->psnr);
    adcgs_json_real(&r->json, "ssim", e->ssim);
    if (r->set->crop) {
        adcgs_json_int(&r->json, "crop_views", r->n_crops);
        adcgs_json_real(&r->json, "crop_psnr", r->crop.psnr);
        adcgs_json_real(&r->json, "crop_ssim", r->crop.ssim);
    }
    adcgs_json_real(&r->json, "frames_per_second", e->frames_per_second);
    adcgs_json_close(&r->json, '}');
    return adcgs_json_finish(&r->json, error);
}

static void end_text(const report *r, const adcgs_info *info, const adcgs_evaluation *e, double decode_seconds)
{
    printf("mean of %-3u %s views %14.2f dB %8.4f\n", e->n, splits[r->set->split], e->psnr, e->ssim);
    if (r->n_crops)
        printf("mean of %-3u crops %18.2f dB %8.4f\n", r->n_crops, r->crop.psnr, r->crop.ssim);
    else if (r->set->crop)
        printf("no view sees the box\n");
    printf("%llu bytes, decoded in %.3f s, %.1f frames per second\n", (unsigned long long)info->bytes.total, decode_seconds,
           e->frames_per_second);
}

/** Scenes give times in steps of a frame, and their alpha over a background: both are the stream's. */
static adcgs_status open_scene(adcgs_scene **scene, const settings *s, const adcgs_info *info, adcgs_error *error)
{
    adcgs_scene_options options = {.has_background = !s->as_is, .frame_rate = info->frame_rate, .dataset = s->dataset};
    if (s->frames)
        ADCGS_TRY(adcgs_frames_parse(&options.frames, s->frames, error));
    memcpy(options.background, info->background, sizeof options.background);
    return adcgs_scene_open(scene, s->scene, &options, error);
}

static adcgs_status compare_views(report *r, adcgs_decoder *decoder, const adcgs_scene *scene, const adcgs_info *info,
                                  double decode_seconds, adcgs_error *error)
{
    adcgs_evaluation e;
    if (r->set->json)
        begin_json(r, info, decode_seconds);
    const adcgs_status status = adcgs_evaluate(&e, decoder, scene, (adcgs_split)r->set->split, on_view, r, error);
    adcgs_progress_clear(&r->progress);
    ADCGS_TRY(status);
    r->crop.psnr /= r->n_crops; /* not a number, which JSON shows as null, when no view sees the box */
    r->crop.ssim /= r->n_crops;
    if (r->set->json)
        return end_json(r, &e, error);
    end_text(r, info, &e, decode_seconds);
    return ADCGS_OK;
}

static adcgs_status compare(const settings *s, adcgs_decoder *decoder, double decode_seconds, adcgs_error *error)
{
    adcgs_info info;
    adcgs_scene *scene = NULL;
    ADCGS_TRY(adcgs_get_info(decoder, &info));
    ADCGS_TRY(open_scene(&scene, s, &info, error));
    report r = {.set = s, .n = scene->n_views[s->split], .box = s->box};
    adcgs_progress_init(&r.progress);
    adcgs_status status = ADCGS_OK;
    if (s->crop && !strcmp(s->crop, "points"))
        status = adcgs_box_of_points(&r.box, scene, error);
    if (status == ADCGS_OK)
        status = compare_views(&r, decoder, scene, &info, decode_seconds, error);
    adcgs_scene_free(&scene);
    return status;
}

static adcgs_status run(const settings *s, adcgs_error *error)
{
    adcgs_decoder *decoder;
    if (s->images && mkdir(s->images, 0777) && errno != EEXIST)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot make the folder: %s", s->images, strerror(errno));
    const double start = adcgs_seconds();
    ADCGS_TRY(adcgs_open_file(&decoder, s->file, &s->config, error));
    adcgs_status status = compare(s, decoder, adcgs_seconds() - start, error);
    adcgs_close(&decoder);
    if (status == ADCGS_OK && fflush(stdout))
        status = adcgs_fail(error, ADCGS_ERR_IO, "standard output: cannot write");
    return status;
}

int main(int argc, char **argv)
{
    settings s = {.split = ADCGS_SPLIT_TEST};
    adcgs_option options[OPTION_COUNT];
    adcgs_config_init(&s.config);
    make_options(&s, options);
    const adcgs_cli cli = {.program = "adcgs-eval",
                           .operands = "FILE SCENE",
                           .summary = "Render the views of a scene from a stream and compare them with its pictures.",
                           .details = "PSNR and SSIM are of frames rounded to 8 bits; speed is 1 / the median time to render.\n"
                                      "Exit status: 0 done, 2 usage, 3 input or output, 4 invalid data, 5 unsupported.",
                           .options = options,
                           .n_options = OPTION_COUNT,
                           .min_operands = 2,
                           .max_operands = 2};
    int first;
    const int done = adcgs_cli_parse(&cli, argc, argv, &first);
    if (done >= 0)
        return done;
    if (s.crop && strcmp(s.crop, "points") && parse_box(s.crop, &s.box))
        return adcgs_cli_error(&cli, ADCGS_ERR_USAGE,
                               "--crop %.100s: expected points, or X0,Y0,Z0,X1,Y1,Z1 with X0 < X1, Y0 < Y1 and Z0 < Z1", s.crop);
    if (s.beside && !s.images)
        return adcgs_cli_error(&cli, ADCGS_ERR_USAGE, "--beside needs --images");
    s.file = argv[first];
    s.scene = argv[first + 1];
    s.config.cpu = (adcgs_cpu_level)s.cpu;
    adcgs_error error = {0};
    adcgs_interrupt_catch();
    error.status = run(&s, &error);
    return error.status != ADCGS_OK ? adcgs_cli_fail(&cli, &error) : 0;
}
