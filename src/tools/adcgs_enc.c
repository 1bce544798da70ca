/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc: learn a scene from posed pictures and write it to one file. */
#include "config.h"

#include "encode/encode.h"
#include "io/atomic.h"
#include "metric/evaluate.h"
#include "tools/cli.h"

#include <adcgs/adcgs.h>

#include <stdlib.h>
#include <sys/stat.h>

static const char *const cpu_names[] = { "auto", "scalar", "avx2", "avx512", NULL };
static const char *const stage_names[] = { "none", "coarse", "fine", "deformation", "rate", "refinement", NULL };

typedef struct enc_options {
    const char *scene, *output, *preset, *checkpoint, *resume, *log, *points;
    double lambda, time_limit;
    int iterations, scale, k, max_anchors, threads, cpu, without, json, has_lambda;
    uint64_t seed;
} enc_options;

/* ---- What the run shows and logs ---- */

typedef struct watcher {
    const enc_options *o;
    adcgs_trainer *t;
    adcgs_progress progress;
    FILE *log;
    double saved;
    adcgs_train_report last;
    uint32_t next_log; /**< iteration */
    adcgs_error error;
} watcher;

static void log_last(watcher *w)
{
    const adcgs_train_report *r = &w->last;
    if (!w->log)
        return;
    w->next_log = r->iteration + 100;
    fprintf(w->log,
            "{\"stage\":\"%s\",\"iteration\":%u,\"of\":%u,\"loss\":%.6g,\"psnr\":%.4f,\"anchors\":%u,\"divide\":%d,"
            "\"bytes\":%.0f,\"rate\":%.2f,\"seconds\":%.2f,\"rollbacks\":%d}\n",
            r->stage, r->iteration, r->iterations, r->loss, r->psnr, r->anchors, r->divide, r->bytes, r->rate, r->seconds,
            r->rollbacks);
    fflush(w->log);
}

static int observe(void *user, const adcgs_train_report *r)
{
    watcher *w = user;
    w->last = *r;
    if (r->iteration >= w->next_log || r->iteration + 100 < w->next_log) /* a rollback goes back */
        log_last(w);
    adcgs_progress_show(&w->progress, "%-9s %6u/%u  1/%d  loss %.4f  %.2f dB  %u anchors  %.0f KB  %.0f it/s  %d:%02d left",
                        r->stage, r->iteration, r->iterations, r->divide, r->loss, r->psnr, r->anchors, r->bytes / 1000, r->rate,
                        (int)r->left / 60, (int)r->left % 60);
    if (w->o->checkpoint && r->seconds - w->saved > 60) {
        w->saved = r->seconds;
        if (adcgs_trainer_save(w->t, w->o->checkpoint, &w->error) != ADCGS_OK)
            return 1;
    }
    return adcgs_interrupted();
}

/* ---- Configuration ---- */

static adcgs_status configure(adcgs_train_config *c, const enc_options *o, adcgs_error *error)
{
    ADCGS_TRY(adcgs_train_preset(c, o->preset, error));
    c->seed = o->seed;
    c->time_limit = o->time_limit;
    c->scale = o->scale;
    if (o->has_lambda)
        c->lambda = (float)o->lambda;
    if (o->iterations)
        c->iterations = (uint32_t)o->iterations;
    if (o->k)
        c->params.k = (uint8_t)o->k;
    if (o->max_anchors) {
        c->max_anchors = (uint32_t)o->max_anchors;
        c->start_anchors = ADCGS_MIN(c->start_anchors, c->max_anchors);
    }
    c->without_coarse = o->without == 1 || o->without == 3;
    c->without_fine = o->without == 2 || o->without == 3;
    c->without_rate = o->without == 4;
    c->without_refinement = o->without == 5;
    return ADCGS_OK;
}

/* ---- Output ---- */

/** Learn before the training, not after it, that a file cannot be written. The stream is read back: no pipe, no device. */
static adcgs_status check_writable(const char *path, adcgs_error *error)
{
    struct stat s;
    adcgs_atomic probe;
    if (!stat(path, &s) && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: not a regular file", path);
    ADCGS_TRY(adcgs_atomic_open(&probe, path, error));
    adcgs_atomic_abort(&probe);
    return ADCGS_OK;
}

static adcgs_status write_stream(adcgs_stream *stream, const watcher *w, const adcgs_train_config *c, adcgs_pool *pool,
                                 adcgs_error *error)
{
    char seed[32], lambda[32], iterations[32];
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)c->seed);
    snprintf(lambda, sizeof lambda, "%g", (double)c->lambda);
    snprintf(iterations, sizeof iterations, "%u", w->t->iteration);
    const adcgs_encode_note notes[] = {
        { "encoder", "adcgs-enc " PACKAGE_VERSION }, { "preset", c->preset }, { "lambda", lambda }, { "iterations", iterations },
        { "seed", seed },
    };
    adcgs_buffer bytes;
    adcgs_atomic file;
    adcgs_buffer_init(&bytes);
    adcgs_status status = adcgs_encode_stream(stream, w->t, notes, ADCGS_COUNTOF(notes), error);
    if (status == ADCGS_OK)
        status = adcgs_encode_verified(stream, &bytes, w->t->cpu, pool, error);
    if (status == ADCGS_OK)
        status = adcgs_atomic_open(&file, w->o->output, error);
    if (status == ADCGS_OK) {
        if (fwrite(bytes.data, 1, bytes.size, file.file) == bytes.size)
            status = adcgs_atomic_commit(&file, error);
        else {
            adcgs_atomic_abort(&file);
            status = adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write %zu bytes", w->o->output, bytes.size);
        }
    }
    adcgs_buffer_clear(&bytes);
    return status;
}

static void print_text(const enc_options *o, const adcgs_info *info, const adcgs_evaluation *e, const char *split, double seconds)
{
    const adcgs_bytes *b = &info->bytes;
    const uint64_t features = b->layer[0] + b->layer[1] + b->layer[2] + b->layer[3] + b->layer[4];
    fprintf(stderr, "%s: %llu bytes: networks %llu, geometry %llu, features %llu, cameras %llu, rest %llu\n", o->output,
            (unsigned long long)b->total, (unsigned long long)b->networks, (unsigned long long)b->geometry,
            (unsigned long long)features, (unsigned long long)b->cameras, (unsigned long long)(b->header + b->metadata));
    fprintf(stderr, "%u anchors (%u static), %u primitives; trained in %.0f s\n", info->anchors, info->static_anchors,
            info->gaussians, seconds);
    fprintf(stderr, "decoded from the file, %u %s views: %.2f dB PSNR, %.4f SSIM\n", e->n, split, e->psnr, e->ssim);
}

static adcgs_status print_json(const enc_options *o, const adcgs_info *info, const adcgs_evaluation *e, const char *split,
                               double seconds, adcgs_error *error)
{
    adcgs_json j;
    adcgs_json_init(&j, stdout);
    adcgs_json_open(&j, NULL, '{');
    adcgs_json_string(&j, "file", o->output);
    adcgs_json_int(&j, "bytes", (int64_t)info->bytes.total);
    adcgs_json_open(&j, "components", '{');
    adcgs_json_int(&j, "header", (int64_t)info->bytes.header);
    adcgs_json_int(&j, "networks", (int64_t)info->bytes.networks);
    adcgs_json_int(&j, "geometry", (int64_t)info->bytes.geometry);
    for (int i = 0; i < 5; i++) {
        char name[24];
        snprintf(name, sizeof name, "layer%d", i);
        adcgs_json_int(&j, name, (int64_t)info->bytes.layer[i]);
    }
    adcgs_json_int(&j, "cameras", (int64_t)info->bytes.cameras);
    adcgs_json_int(&j, "metadata", (int64_t)info->bytes.metadata);
    adcgs_json_close(&j, '}');
    adcgs_json_int(&j, "anchors", info->anchors);
    adcgs_json_int(&j, "static_anchors", info->static_anchors);
    adcgs_json_int(&j, "primitives", info->gaussians);
    adcgs_json_real(&j, "training_seconds", seconds);
    adcgs_json_string(&j, "split", split);
    adcgs_json_real(&j, "psnr", e->psnr);
    adcgs_json_real(&j, "ssim", e->ssim);
    adcgs_json_close(&j, '}');
    return adcgs_json_finish(&j, error);
}

/** Measure the file just written, from disk, on views that training never saw if the scene has any. */
static adcgs_status report(const enc_options *o, const adcgs_scene *scene, double seconds, adcgs_error *error)
{
    const adcgs_split split = scene->n_views[ADCGS_SPLIT_TEST] ? ADCGS_SPLIT_TEST :
                              scene->n_views[ADCGS_SPLIT_VAL]  ? ADCGS_SPLIT_VAL : ADCGS_SPLIT_TRAIN;
    adcgs_config config;
    adcgs_decoder *decoder;
    adcgs_info info;
    adcgs_evaluation evaluation;
    adcgs_config_init(&config);
    config.threads = o->threads;
    config.cpu = (adcgs_cpu_level)o->cpu;
    ADCGS_TRY(adcgs_open_file(&decoder, o->output, &config, error));
    adcgs_status status = adcgs_get_info(decoder, &info);
    if (status == ADCGS_OK)
        status = adcgs_evaluate(&evaluation, decoder, scene, split, NULL, NULL, error);
    if (status == ADCGS_OK && o->json)
        status = print_json(o, &info, &evaluation, adcgs_split_name(split), seconds, error);
    else if (status == ADCGS_OK)
        print_text(o, &info, &evaluation, adcgs_split_name(split), seconds);
    adcgs_close(&decoder);
    return status;
}

/* ---- The run ---- */

static adcgs_status stop_early(const adcgs_cli *cli, watcher *w, adcgs_error *error)
{
    char *name = NULL;
    const char *path = w->o->checkpoint;
    if (!path) {
        const size_t n = strlen(w->o->output) + 16;
        name = malloc(n);
        if (!name)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory");
        snprintf(name, n, "%s.checkpoint", w->o->output);
        path = name;
    }
    const adcgs_status status = adcgs_trainer_save(w->t, path, error);
    if (status == ADCGS_OK)
        adcgs_cli_note(cli, "stopped at iteration %u; go on with the same command and --resume %s", w->t->iteration, path);
    free(name);
    return status;
}

static adcgs_status train(const adcgs_cli *cli, watcher *w, adcgs_error *error)
{
    int stopped;
    if (w->o->resume)
        ADCGS_TRY(adcgs_trainer_load(w->t, w->o->resume, error));
    w->saved = w->t->elapsed;
    adcgs_interrupt_catch();
    adcgs_progress_init(&w->progress);
    const adcgs_status status = adcgs_trainer_run(w->t, observe, w, &stopped, error);
    adcgs_progress_clear(&w->progress);
    if (w->last.stage && w->last.iteration + 100 != w->next_log)
        log_last(w);
    ADCGS_TRY(status);
    if (w->error.status != ADCGS_OK) {
        *error = w->error;
        return w->error.status;
    }
    if (!stopped)
        return ADCGS_OK;
    ADCGS_TRY(stop_early(cli, w, error));
    return adcgs_fail(error, ADCGS_ERR_IO, "interrupted; nothing was written to %s", w->o->output);
}

static adcgs_status encode(const adcgs_cli *cli, const enc_options *o, adcgs_pool *pool, adcgs_error *error)
{
    const adcgs_scene_options scene_options = { .points_path = o->points };
    adcgs_scene *scene = NULL;
    adcgs_train_config config;
    adcgs_cpu_level cpu;
    watcher w = { .o = o };
    adcgs_stream stream;
    adcgs_stream_init(&stream);
    adcgs_status status = adcgs_cpu_resolve((adcgs_cpu_level)o->cpu, &cpu, error);
    if (status == ADCGS_OK)
        status = configure(&config, o, error);
    if (status == ADCGS_OK)
        status = check_writable(o->output, error);
    if (status == ADCGS_OK && o->checkpoint)
        status = check_writable(o->checkpoint, error);
    if (status == ADCGS_OK)
        status = adcgs_scene_open(&scene, o->scene, &scene_options, error);
    if (status == ADCGS_OK)
        status = adcgs_trainer_create(&w.t, scene, &config, cpu, pool, error);
    if (status == ADCGS_OK && o->log) {
        w.log = fopen(o->log, o->resume ? "a" : "w");
        if (!w.log)
            status = adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write the log", o->log);
    }
    if (status == ADCGS_OK) {
        w.t->quantise = adcgs_encode_quantise_hook;
        w.t->quantise_user = &w.t->cpu;
        status = train(cli, &w, error);
    }
    if (status == ADCGS_OK)
        status = write_stream(&stream, &w, &config, pool, error);
    if (status == ADCGS_OK)
        status = report(o, scene, w.t->elapsed, error);
    if (w.log)
        fclose(w.log);
    adcgs_stream_clear(&stream, NULL);
    adcgs_trainer_free(&w.t);
    adcgs_scene_free(&scene);
    return status;
}

/* ---- Command line ---- */

static const adcgs_cli program = {
    .program = "adcgs-enc",
    .operands = "SCENE",
    .summary = "Learn a dynamic scene from posed pictures and write it to one file.",
    .details = "SCENE is a folder with transforms_train.json or transforms.json, or such a file.",
    .min_operands = 1,
    .max_operands = 1,
};

/** -1 to go on, else the exit code to leave with. */
static int parse(enc_options *o, int argc, char **argv)
{
    const adcgs_option options[] = {
        { "output", 'o', ADCGS_OPTION_STRING, &o->output, 0, 0, "FILE", "write the stream here (required)", NULL, NULL },
        { "preset", 'p', ADCGS_OPTION_STRING, &o->preset, 0, 0, "NAME",
          "draft, fast, medium, slow or paper (default fast)", NULL, NULL },
        { "lambda", 'l', ADCGS_OPTION_REAL, &o->lambda, 0, 1000, "X",
          "loss per mebibyte of features: larger makes smaller\nfiles (default: the preset's)", NULL, &o->has_lambda },
        { "iterations", 'n', ADCGS_OPTION_INT, &o->iterations, 10, 10000000, "N",
          "length of the run (default: the preset's)", NULL, NULL },
        { "scale", 0, ADCGS_OPTION_INT, &o->scale, 1, 64, "S",
          "divide the pictures' size by this integer (default 1)", NULL, NULL },
        { "k", 0, ADCGS_OPTION_INT, &o->k, 1, ADCGS_K_MAX, "N",
          "primitives per anchor, 1 to 16 (default: the preset's)", NULL, NULL },
        { "max-anchors", 0, ADCGS_OPTION_INT, &o->max_anchors, 1, 1000000, "N",
          "budget of anchors (default: the preset's)", NULL, NULL },
        { "points", 0, ADCGS_OPTION_STRING, &o->points, 0, 0, "FILE",
          "initial points (PLY or Draco) instead of the scene's or\nrandom ones", NULL, NULL },
        { "without", 0, ADCGS_OPTION_CHOICE, &o->without, 0, 0, "STAGE",
          "leave out coarse, fine, deformation (both), rate or\nrefinement", stage_names, NULL },
        { "time-limit", 0, ADCGS_OPTION_REAL, &o->time_limit, 0, 1e7, "S",
          "train for at most S seconds; the result then depends on\nthe speed of the machine", NULL, NULL },
        { "seed", 0, ADCGS_OPTION_SIZE, &o->seed, 0, 1e15, "N", "seed of every random choice (default 1)", NULL, NULL },
        { "checkpoint", 0, ADCGS_OPTION_STRING, &o->checkpoint, 0, 0, "FILE",
          "save the state of the run here every minute and when\ninterrupted (default then: the output's name.checkpoint)", NULL,
          NULL },
        { "resume", 0, ADCGS_OPTION_STRING, &o->resume, 0, 0, "FILE",
          "go on from such a state; same scene, same options", NULL, NULL },
        { "log", 0, ADCGS_OPTION_STRING, &o->log, 0, 0, "FILE",
          "write progress as JSON lines; appended with --resume", NULL, NULL },
        { "threads", 't', ADCGS_OPTION_INT, &o->threads, 0, 256, "N",
          "threads (default: one per CPU); the result does not\ndepend on it", NULL, NULL },
        { "cpu", 0, ADCGS_OPTION_CHOICE, &o->cpu, 0, 0, "LEVEL",
          "kernels: auto, scalar, avx2, avx512 (default auto)", cpu_names, NULL },
        { "json", 0, ADCGS_OPTION_FLAG, &o->json, 0, 0, NULL, "print the result as one JSON object on stdout", NULL, NULL },
    };
    adcgs_cli cli = program;
    cli.options = options;
    cli.n_options = ADCGS_COUNTOF(options);
    int first;
    const int code = adcgs_cli_parse(&cli, argc, argv, &first);
    if (code >= 0)
        return code;
    if (!o->output)
        return adcgs_cli_error(&cli, ADCGS_ERR_USAGE, "no output: give -o FILE");
    o->scene = argv[first];
    return -1;
}

int main(int argc, char **argv)
{
    enc_options o = { .preset = "fast", .scale = 1, .seed = 1 };
    const int code = parse(&o, argc, argv);
    if (code >= 0)
        return code;
    adcgs_error error = { ADCGS_OK, "" };
    adcgs_pool *pool = NULL;
    adcgs_status status = adcgs_pool_create(&pool, o.threads, &error);
    if (status == ADCGS_OK)
        status = encode(&program, &o, pool, &error);
    adcgs_pool_free(&pool);
    if (status != ADCGS_OK) {
        error.status = status;
        return adcgs_cli_fail(&program, &error);
    }
    return 0;
}
