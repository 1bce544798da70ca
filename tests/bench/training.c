/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Complete iterations of training; then decoding and playing of the trained model. */
#include "bench_parts.h"

#include "encode/encode.h"
#include "scene/layouts/open.h"
#include "synthetic/scenes.h"
#include "train/settings.h"
#include "train/trainer.h"

#include <adcgs/decoder.h>

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>

/* Training asks its callback every tenth iteration whether to continue, so these are multiples of ten. */
enum { YOUTH = 1500, WARM_UP = 40, AT_A_TIME = 10, ROUNDED = 20, FRAMES = 32 };

typedef struct training {
    adcgs_trainer *t;
    uint32_t until;
} training;

static int reached(void *user, const adcgs_train_report *report)
{
    return report->iteration >= ((const training *)user)->until;
}

static void iterate(training *r, uint32_t n)
{
    adcgs_error error = {.status = ADCGS_OK};
    int stopped;
    r->until = r->t->run.iteration + n;
    bench_check(adcgs_trainer_run(r->t, reached, r, &stopped, &error), &error);
    if (r->t->run.iteration != r->until) {
        fprintf(stderr, "adcgs-bench: %u iterations asked for, %u more were made\n", n, r->t->run.iteration - r->until);
        exit(1);
    }
}

static void some_iterations(void *arg)
{
    iterate(arg, AT_A_TIME);
}

/**
 * Every mechanism takes part in every iteration, and the number of anchors stays the same. Splats start large and faint, with
 * hundreds over each other. A first phase with small images, as presets have it, brings them to the state of most of a run.
 */
static adcgs_train_config steady(const char *preset, uint32_t anchors)
{
    adcgs_train_config c;
    adcgs_error error = {.status = ADCGS_OK};
    bench_check(adcgs_train_preset(&c, preset, &error), &error);
    c.iterations = 1000000;
    c.start_anchors = c.max_anchors = anchors;
    c.quarter_size_until = (float)YOUTH / (float)c.iterations;
    c.curriculum_until = c.half_size_until = c.scale_reg_start = 0;
    c.deform_start = c.fine_start = c.quant_noise_start = c.rate_start = c.densify_start = c.densify_until = 0;
    c.prune_units_at = c.prune_at = c.quant_round_start = c.freeze_start = 2;
    return c;
}

static adcgs_scene *open_scene(const char *folder, int width, int height)
{
    char path[512];
    struct stat there;
    adcgs_scene *scene;
    adcgs_error error = {.status = ADCGS_OK};
    const adcgs_scenes_options made = {.name = "tiny", .width = width, .height = height, .format = "ppm"};
    const adcgs_scene_options options = {.points_path = NULL};
    snprintf(path, sizeof path, "%s/tiny-%dx%d", folder, width, height);
    if (stat(path, &there) != 0) {
        mkdir(folder, 0777); /* if it fails, the next call fails with a message */
        bench_check(adcgs_scenes_write(path, &made, NULL, NULL, NULL, &error), &error);
    }
    bench_check(adcgs_scene_open(&scene, path, &options, &error), &error);
    return scene;
}

/* ---- Playing ---- */

typedef struct player {
    const adcgs_buffer *stream;
    adcgs_config config;
    adcgs_decoder *decoder;
    adcgs_camera camera;
    adcgs_frame frame;
    double length;
    int next;
} player;

static void open_stream(void *arg)
{
    player *p = arg;
    adcgs_error error = {.status = ADCGS_OK};
    adcgs_close(&p->decoder);
    bench_check(adcgs_open_memory(&p->decoder, p->stream->data, p->stream->size, &p->config, &error), &error);
}

/** Plays one frame after another, each at its own time. */
static void play(void *arg)
{
    player *p = arg;
    adcgs_error error = {.status = ADCGS_OK};
    p->next = (p->next + 1) % FRAMES;
    bench_check(adcgs_render(p->decoder, &p->camera, p->length * p->next / FRAMES, &p->frame, &error), &error);
}

static void splats_alone(void *arg)
{
    player *p = arg;
    adcgs_primitives primitives;
    p->next = (p->next + 1) % FRAMES;
    bench_check(adcgs_get_primitives(p->decoder, p->length * p->next / FRAMES, &primitives, NULL), NULL);
}

static void decode_and_play(const bench *b, const adcgs_buffer *stream, bench_place place)
{
    for (int threads = 1; threads <= b->threads; threads = bench_more_threads(b, threads)) {
        player p = {.stream = stream};
        adcgs_info info;
        adcgs_config_init(&p.config, sizeof p.config);
        p.config.threads = threads;
        p.config.cpu = b->level;
        open_stream(&p);
        bench_check(adcgs_get_info(p.decoder, &info, sizeof info, NULL), NULL);
        bench_check(adcgs_get_camera(p.decoder, 0, &p.camera, NULL), NULL);
        p.length = info.time_end - info.time_start;
        p.frame = (adcgs_frame){.width = p.camera.width,
                                .height = p.camera.height,
                                .rgb = bench_floats(3 * (size_t)p.camera.width * (size_t)p.camera.height)};
        place.threads = threads;
        place.anchors = info.anchors;
        place.splats = info.gaussians;
        const bench_item items[] = {{"open and decode", open_stream, &p, (double)stream->size, "byte", 0},
                                    {"splats of a moment", splats_alone, &p, 1, "frame", 0},
                                    {"a whole frame", play, &p, 1, "frame", 0}};
        bench_group(b, &place, items, ADCGS_COUNTOF(items), 0);
        adcgs_free(NULL, p.frame.rgb);
        adcgs_close(&p.decoder);
    }
}

/** Rounds and freezes the model, and writes it. */
static void write_stream(training *r, adcgs_pool *pool, adcgs_buffer *out)
{
    adcgs_stream stream;
    adcgs_error error = {.status = ADCGS_OK};
    r->t->config.quant_round_start = 0;
    iterate(r, ROUNDED);
    r->t->config.freeze_start = 0;
    iterate(r, ROUNDED);
    bench_check(adcgs_encode_stream(&stream, r->t, NULL, 0, &error), &error);
    bench_check(adcgs_encode_verified(&stream, out, r->t->cpu, pool, &error), &error);
    adcgs_stream_clear(&stream, NULL);
}

void bench_training(const bench *b, const char *scenes, int width, int height, uint32_t anchors, const char *preset)
{
    char group[64];
    adcgs_error error = {.status = ADCGS_OK};
    adcgs_buffer stream;
    snprintf(group, sizeof group, "train by preset %s", preset);
    if (!bench_wants(b, group) && !bench_wants(b, "play"))
        return;
    adcgs_buffer_init(&stream);
    adcgs_scene *scene = open_scene(scenes, width, height);
    adcgs_train_config config = steady(preset, anchors);
    const int runs = !strcmp(preset, "paper") && adcgs_bf16_check(b->level, NULL) == ADCGS_OK ? 2 : 1;
    for (int threads = 1; threads <= b->threads; threads = bench_more_threads(b, threads)) {
        training r[2] = {{.until = 0}};
        adcgs_pool *pool = NULL;
        bench_check(adcgs_pool_create(&pool, threads, &error), &error);
        for (int i = 0; i < runs; i++) {
            config.bf16 = i > 0;
            bench_check(adcgs_trainer_create(&r[i].t, scene, &config, b->level, pool, &error), &error);
            r[i].t->quantise = adcgs_encode_quantise_hook;
            iterate(&r[i], YOUTH + WARM_UP);
        }
        const bench_item items[] = {{"iterations", some_iterations, &r[0], AT_A_TIME, "iteration", 0},
                                    {"iterations in bf16", some_iterations, &r[1], AT_A_TIME, "iteration", 0}};
        const uint32_t n = r[0].t->f->n;
        bench_group(b, &(bench_place){group, width, height, n, n * r[0].t->f->params.k, threads}, items, runs, 1);
        if (threads == 1)
            write_stream(&r[0], pool, &stream);
        for (int i = 0; i < runs; i++)
            adcgs_trainer_free(&r[i].t);
        adcgs_pool_free(&pool);
    }
    snprintf(group, sizeof group, "play preset %s", preset);
    decode_and_play(b, &stream, (bench_place){.group = group, .width = width, .height = height});
    adcgs_scene_free(&scene);
    adcgs_buffer_clear(&stream);
}
