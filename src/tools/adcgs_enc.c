/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc: trains a scene from posed images and writes it to one file. */
#include "config.h"

#include "base/cpu_detect.h"
#include "cli/text.h"
#include "encode/encode.h"
#include "encode/raw.h"
#include "io/atomic.h"
#include "io/claim.h"
#include "io/extension.h"
#include "io/json.h"
#include "io/kind.h"
#include "layouts/open.h"
#include "tools/enc_footage.h"
#include "tools/enc_live.h"
#include "tools/enc_parts.h"
#include "tools/enc_plan.h"
#include "tools/enc_rank.h"
#include "tools/enc_ranks.h"
#include "tools/enc_report.h"
#include "tools/enc_rescue.h"
#include "tools/enc_run.h"
#include "tools/enc_segments.h"
#include "tools/enc_trials.h"
#include "tools/former_settings.h"
#include "train/settings.h"

#include <adcgs/adcgs.h>

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Configuration ---- */

/**
 * Settings of --fixed: no decision on the model's size depends on the scene. Later decisions need these, so they are off as well.
 */
#define FIXED "detail_anchors=0,static_threshold=0,prune_at=2,prune_units_at=2"

static adcgs_status configure(adcgs_train_config *c, const adcgs_enc_options *o, adcgs_cpu_level cpu, adcgs_error *error)
{
    if (o->bf16)
        ADCGS_TRY(adcgs_bf16_check(cpu, error));
    ADCGS_TRY(adcgs_train_preset(c, o->preset, error));
    if (o->fixed)
        ADCGS_TRY(adcgs_train_set(c, FIXED, error));
    if (o->set)
        ADCGS_TRY(adcgs_train_set(c, o->set, error));
    const struct {
        int given;
        const char *name;
        double value;
    } own[] = {{o->has_lambda, "lambda", o->lambda},   {o->has_iterations, "iterations", o->iterations},
               {o->has_scale, "scale", o->scale},      {o->has_k, "k", o->k},
               {o->has_seed, "seed", (double)o->seed}, {o->has_max_anchors, "max_anchors", o->max_anchors},
               {o->no_progression, "tiers", 1}};
    for (size_t i = 0; i < ADCGS_COUNTOF(own); i++)
        if (own[i].given)
            ADCGS_TRY(adcgs_train_set_value(c, own[i].name, own[i].value, error));
    c->time_limit = o->time_limit;
    c->bf16 = (uint8_t)o->bf16;
    if (o->has_size || o->has_psnr) {
        c->target = o->has_size ? ADCGS_TARGET_SIZE : ADCGS_TARGET_PSNR;
        c->target_value = o->has_size ? (double)o->size : o->psnr;
    }
    if (o->without)
        ADCGS_TRY(adcgs_train_leave_out(c, o->without, error));
    c->without_rate |= o->uncompressed != NULL;
    c->without_rounding |= o->uncompressed != NULL;
    ADCGS_TRY(adcgs_train_check(c, error));
    if (o->beginning && adcgs_train_lambda_from(c) >= 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--beginning: lambda has no effect in this run, so leave out --beginning");
    return ADCGS_OK;
}

/* ---- Output ---- */

/** Finds out before the training that a file cannot be written. The stream is read back, so no pipe or device is allowed. */
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

/** Writes the model as plain numbers, next to the stream. */
static adcgs_status write_uncompressed(adcgs_enc_context *w, const adcgs_model *model, adcgs_error *error)
{
    adcgs_buffer bytes;
    adcgs_buffer_init(&bytes);
    adcgs_status status = adcgs_raw_write(model, &bytes, error);
    if (status == ADCGS_OK)
        status = adcgs_atomic_save(w->o->uncompressed, bytes.data, bytes.size, error);
    w->uncompressed_bytes = bytes.size;
    adcgs_buffer_clear(&bytes);
    return status;
}

static adcgs_status write_stream(adcgs_stream *stream, adcgs_enc_context *w, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_buffer bytes;
    adcgs_buffer_init(&bytes);
    if (w->o->uncompressed)
        adcgs_raw_prepare(w->t->f);
    adcgs_status status = adcgs_enc_encode(stream, &bytes, w, pool, error);
    if (status == ADCGS_OK && w->t->config.target == ADCGS_TARGET_SIZE && bytes.size > w->o->size)
        status = adcgs_fail(error, ADCGS_ERR_USAGE,
                            "%s: not written, since a single anchor and its networks take %zu bytes: "
                            "give a larger --size",
                            w->o->output, bytes.size);
    if (status == ADCGS_OK)
        status = adcgs_atomic_save(w->o->output, bytes.data, bytes.size, error);
    if (status == ADCGS_OK && w->o->uncompressed)
        status = write_uncompressed(w, &stream->segments[0], error);
    adcgs_buffer_clear(&bytes);
    return status;
}

/** Warns if the output is named like a video or another format, since no other player plays a stream. */
static void note_extension(const adcgs_cli *cli, const char *path)
{
    static const char *const others[] = {"mp4", "mkv",  "webm", "mov", "avi", "y4m", "gif", "png",
                                         "jpg", "jpeg", "html", "ply", "spz", "sog", "glb", "splat"};
    const char *const extension = adcgs_extension(path);
    for (size_t i = 0; i < ADCGS_COUNTOF(others); i++)
        if (!strcasecmp(extension, others[i]))
            adcgs_cli_note(cli,
                           "%s: this file will hold an adcgs stream, not %s: name it .adcgs, and convert it with adcgs-dec "
                           "or adcgs-share",
                           path, others[i]);
}

/** Refuses two outputs of the same name. */
static adcgs_status check_distinct(const adcgs_enc_options *o, adcgs_error *error)
{
    const char *const names[] = {o->output, o->beginning, o->uncompressed, o->checkpoint, o->log, o->preview};
    const char *const options[] = {"output", "beginning", "uncompressed", "checkpoint", "log", "preview"};
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++)
        for (size_t j = 0; j < i; j++)
            if (names[i] && names[j] && adcgs_atomic_same(names[i], names[j]))
                return adcgs_fail(error, ADCGS_ERR_USAGE, "--%s and --%s are the same file, %s", options[j], options[i],
                                  names[i]);
    return ADCGS_OK;
}

/* ---- The run ---- */

static adcgs_status report(adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_time spent, int *met, adcgs_error *error)
{
    return adcgs_enc_report_print(job->cli,
                                  &(adcgs_enc_report){job->o->output, &job->config, job->cpu, job->scene, w->last, spent,
                                                      w->uncompressed_bytes, job->o->threads, job->o->json, w->interrupts},
                                  met, error);
}

static adcgs_status encode_whole(adcgs_enc_context *w, const adcgs_enc_job *job, int *met, adcgs_error *error)
{
    adcgs_stream stream;
    adcgs_enc_ranks_whole(w, job);
    adcgs_status status =
        adcgs_enc_train(w, job, job->scene, NULL, NULL, job->o->finish ? job->o->finish : job->o->resume, job->o->started, error);
    if (adcgs_enc_team_follows(&w->team))
        return status == ADCGS_OK ? adcgs_rank_follow(w, job, error) : adcgs_rank_fail(job, error);
    if (status != ADCGS_OK)
        return status;
    if (!job->o->output)
        return ADCGS_OK;
    adcgs_stream_init(&stream);
    status = write_stream(&stream, w, job->pool, error);
    adcgs_stream_clear(&stream, NULL);
    if (status != ADCGS_OK && status != ADCGS_ERR_DATA) /* the stream cannot hold the scene: encoding it again would fail again */
        adcgs_enc_rescue(job->cli, w, status);
    if (status == ADCGS_OK)
        status = report(w, job, w->last.spent, met, error);
    *met &= !w->cut_short;
    return status;
}

/* ---- Segments ---- */

static adcgs_status encode_segments(adcgs_enc_context *w, const adcgs_enc_job *job, int *met, adcgs_error *error)
{
    adcgs_time spent = {0, 0};
    adcgs_claim *claim = NULL;
    char *name;
    ADCGS_TRY(adcgs_enc_claim_name(&name, w->base, error));
    adcgs_status status = adcgs_claim_take(&claim, name, "the segments", error);
    free(name);
    if (status == ADCGS_OK)
        status = job->ranks ? adcgs_enc_ranks_lead(w, job, &spent, error) : adcgs_enc_segments_train(w, job, &spent, error);
    if (status == ADCGS_OK)
        status = adcgs_enc_segments_write(w, job, &spent, error);
    adcgs_claim_drop(&claim);
    return status == ADCGS_OK ? report(w, job, spent, met, error) : status;
}

/* ---- The program ---- */

/** Checks the options before anything long begins. */
static adcgs_status prepare(adcgs_enc_job *job, adcgs_enc_context *w, adcgs_scene_options *scene, adcgs_error *error)
{
    const adcgs_enc_options *o = job->o;
    ADCGS_TRY(adcgs_cpu_resolve((adcgs_cpu_level)o->cpu, &job->cpu, error));
    if (o->frames)
        ADCGS_TRY(adcgs_frames_parse(&scene->frames, o->frames, error));
    if (o->fps && adcgs_fps_parse(o->fps, &scene->rate))
        return adcgs_fail(error, ADCGS_ERR_USAGE,
                          "--fps %.64s: expected frames per second from %g to %g, as 30, 29.97 or "
                          "30000/1001",
                          o->fps, ADCGS_FPS_MIN, ADCGS_FPS_MAX);
    ADCGS_TRY(configure(&job->config, o, job->cpu, error));
    ADCGS_TRY(check_distinct(o, error));
    if (o->output && !(job->ranks && job->ranks->rank))
        note_extension(job->cli, o->output);
    if (o->live || o->plan)
        return ADCGS_OK;
    ADCGS_TRY(check_writable(w->target, error));
    if (o->checkpoint)
        ADCGS_TRY(check_writable(o->checkpoint, error));
    return o->uncompressed ? check_writable(o->uncompressed, error) : ADCGS_OK;
}

#define PART_NAME 20 /* most bytes that a part's name adds to the state's: ".<number>.adcgs" */

/** Names the run's state: the file of --checkpoint, else the one that the run continues, else one next to its output. */
static adcgs_status name_base(adcgs_enc_context *w, adcgs_error *error)
{
    const adcgs_enc_options *o = w->o;
    const char *given = o->checkpoint ? o->checkpoint : o->has_segment ? o->resume : NULL;
    const char *const name = given ? given : w->target;
    const size_t n = strlen(name) + 16;
    w->base = malloc(n);
    w->state = malloc(n);
    if (!w->base || !w->state)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory");
    snprintf(w->base, n, "%s%s", name, given ? "" : ".checkpoint");
    memcpy(w->state, w->base, n);
    const char *const slash = strrchr(w->base, '/');
    if (strlen(slash ? slash + 1 : w->base) + (o->has_segment ? PART_NAME : 0) > NAME_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE,
                          "the name of the run's state, with its suffix, is longer than %d bytes: give a "
                          "shorter one with --checkpoint",
                          NAME_MAX);
    return ADCGS_OK;
}

static adcgs_status open_log(adcgs_enc_context *w, adcgs_error *error)
{
    const adcgs_enc_options *o = w->o;
    if (adcgs_enc_team_follows(&w->team))
        return ADCGS_OK;
    w->log = o->log ? fopen(o->log, o->resume || o->finish || o->plan ? "a" : "w") : NULL;
    return !o->log || w->log ? ADCGS_OK
                             : adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write the log: %s", o->log, strerror(errno));
}

#define EARLY "interrupted before training began: there is no state to save\n"

static adcgs_status run(adcgs_enc_job *job, adcgs_enc_context *w, int *met, adcgs_error *error)
{
    const adcgs_enc_options *o = job->o;
    adcgs_scene_options scene = {.points_path = o->points, .dataset = o->dataset};
    ADCGS_TRY(prepare(job, w, &scene, error));
    const int follows = job->ranks && job->ranks->rank;
    const uint32_t shared = o->live || o->finish ? 1 : job->config.batch;
    if (follows && (!o->has_segment || o->live) && (uint32_t)job->ranks->rank >= shared) /* this rank has no views to share */
        return adcgs_rank_follow(w, job, error);
    if (!follows)
        ADCGS_TRY(open_log(w, error));
    if (o->plan)
        return o->has_segment ? adcgs_enc_plan_train(w, job, error) : adcgs_enc_plan_make(job, &scene, error);
    if (o->live)
        return adcgs_enc_live(w, job, error);
    ADCGS_TRY(name_base(w, error));
    adcgs_interrupt_word(isatty(STDERR_FILENO) ? "\nadcgs-enc: " EARLY : "adcgs-enc: " EARLY);
    ADCGS_TRY(adcgs_scene_open(&job->scene, o->scene, &scene, error));
    if (!follows)
        adcgs_enc_report_remarks(job->cli, job->scene);
    adcgs_progress_show(&w->progress, "scene   %u training view%s, read in %.0f s", job->scene->n_views[ADCGS_SPLIT_TRAIN],
                        adcgs_s(job->scene->n_views[ADCGS_SPLIT_TRAIN]), adcgs_seconds() - o->started.clock);
    if (w->preview.path)
        ADCGS_TRY(adcgs_enc_preview_begin(o->preview, job->scene, error));
    adcgs_enc_reduce_large(job, job->scene, &w->progress);
    ADCGS_TRY(adcgs_enc_compensate_light(job, &w->progress, error));
    ADCGS_TRY(adcgs_enc_try(job, w, error));
    ADCGS_TRY(adcgs_train_changes(&job->config, &w->changes, error));
    if (o->has_segment)
        ADCGS_TRY(adcgs_enc_cut(job, o->segment, error));
    ADCGS_TRY(adcgs_enc_ranks_gather(w, job, error));
    if (follows)
        ADCGS_TRY(open_log(w, error));
    if (follows && (job->cuts.n > 1 || !adcgs_enc_team_follows(&w->team)))
        return adcgs_rank_follow(w, job, error);
    return job->cuts.n > 1 ? encode_segments(w, job, met, error) : encode_whole(w, job, met, error);
}

static adcgs_status encode(const adcgs_cli *cli, const adcgs_enc_options *o, const adcgs_ranks *ranks, adcgs_pool *pool, int *met,
                           adcgs_error *error)
{
    adcgs_enc_job job = {.cli = cli, .o = o, .ranks = ranks->size > 1 ? ranks : NULL, .pool = pool};
    adcgs_enc_context w = {.o = o,
                           .target = o->plan        ? o->plan
                                     : o->beginning ? o->beginning
                                                    : o->output,
                           .keeps = o->checkpoint || o->plan,
                           .preview = {.path = ranks->rank ? NULL : o->preview}};
    adcgs_progress_init(&w.progress, cli);
    adcgs_progress_keep(&w.progress);
    adcgs_buffer_init(&w.changes);
    const adcgs_status status = run(&job, &w, met, error);
    adcgs_progress_end(&w.progress);
    if (w.log && fclose(w.log))
        adcgs_fail(&w.log_error, ADCGS_ERR_IO, "%s: cannot write the log", o->log);
    if (w.log_error.status != ADCGS_OK)
        adcgs_cli_error(cli, ADCGS_OK, "%s; the run continued without it", w.log_error.text);
    adcgs_buffer_clear(&w.changes);
    adcgs_enc_team_clear(&w.team);
    free(w.base);
    free(w.state);
    adcgs_trainer_free(&w.t);
    adcgs_cuts_clear(&job.cuts);
    adcgs_free(NULL, job.follows);
    adcgs_scene_free(&job.scene);
    return status;
}

/* ---- Command line ---- */

#define OPERANDS_MAX 1000000

static const adcgs_cli program = {
    .program = "adcgs-enc",
    .operands = "SCENE",
    .summary = "Train a dynamic scene from posed images and write it to one file.",
    .details = "SCENE is a folder in the layout of D-NeRF, nerfstudio, HyperNeRF, LLFF, Neu3D, COLMAP or\n"
               "Dynamic 3D Gaussians, a transforms.json, a scene file, or a file of splats (PLY, SPZ, GLB), whose\n"
               "views are rendered. Seconds may have a unit: 500ms, 2s, 10m, 1.5h. Counts may be in thousands or\n"
               "millions: 20k, 2M.",
    .min_operands = 0,
    .max_operands = OPERANDS_MAX, /* one is expected; the message depends on the others */
};

/** Reports surplus operands. Other players take a file of splats for each timestamp. */
static int report_surplus(const adcgs_cli *cli, int n, char **operands)
{
    int splats = 0;
    while (splats < n && adcgs_kind_at(operands[splats])->class == ADCGS_KIND_SPLATS)
        splats++;
    if (splats == n)
        return adcgs_cli_error(cli, ADCGS_ERR_UNSUPPORTED,
                               "%.100s and %d more files of splats: sequences of splats are not read, expected one file",
                               *operands, n - 1);
    return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "%s: one operand too many; try '%s --help'", operands[1], cli->program);
}

static int list_settings(const adcgs_cli *cli, const adcgs_enc_options *o)
{
    adcgs_train_config config;
    adcgs_error error;
    if (adcgs_train_preset(&config, o->preset, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_train_list(&config, stdout);
    return adcgs_cli_leave(cli, 0);
}

/** Checks the options that --live excludes. Returns like parse(). */
static int check_live(const adcgs_cli *cli, adcgs_enc_options *o)
{
    if (!o->has_segment)
        o->segment = ADCGS_ENC_LIVE_SEGMENT;
    if (o->has_size || o->has_psnr || o->beginning || o->uncompressed || o->time_limit > 0 || o->frames || o->fps ||
        o->checkpoint || o->dataset || o->or_whole || o->has_fade)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE,
                               "--live excludes --size, --psnr, --beginning, --uncompressed, --time-limit, "
                               "--frames, --fps, --checkpoint, --dataset, --or-whole and --fade");
    if (o->has_delay && o->delay <= o->segment)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE,
                               "--delay %g: a segment of %g s is trained after its end is filmed: give a "
                               "longer delay, or a shorter --segment",
                               o->delay, o->segment);
    if (o->json && !strcmp(o->output, "-"))
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--json and -o - both write to standard output");
    return -1;
}

/** Returns -1 to continue, else the exit code. */
static int parse(adcgs_cli *cli, adcgs_enc_options *o, int argc, char **argv)
{
    const adcgs_setting *const lambda = adcgs_setting_find("lambda"), *const iterations = adcgs_setting_find("iterations");
    const adcgs_setting *const scale = adcgs_setting_find("scale"), *const seed = adcgs_setting_find("seed");
    const adcgs_setting *const k = adcgs_setting_find("k"), *const anchors = adcgs_setting_find("max_anchors");
    const char *names[ADCGS_SETTING_NAMES + 1];
    adcgs_setting_names(names);
    const adcgs_option options[] = {
        {"output", 'o', ADCGS_OPTION_FILE, &o->output, 0, 0, "FILE", "stream to write (required, except with --beginning)", NULL,
         NULL},
        {"preset", 'p', ADCGS_OPTION_STRING, &o->preset, 0, 0, "NAME", "draft, fast, medium, slow or paper (default fast)",
         adcgs_train_presets, NULL},
        {"lambda", 'l', ADCGS_OPTION_REAL, &o->lambda, lambda->min, lambda->max, "X",
         "loss per mebibyte of features and networks; a larger value\nmakes smaller files (default: the preset's, times the\n"
         "images' contrast over 0.22)",
         NULL, &o->has_lambda},
        {"size", 's', ADCGS_OPTION_SIZE, &o->size, ADCGS_TARGET_SIZE_MIN, ADCGS_TARGET_SIZE_MAX, "BYTES",
         "maximum file size, reached within 3 % (150k, 1.5M, 2MiB);\nreplaces --lambda", NULL, &o->has_size},
        {"psnr", 0, ADCGS_OPTION_REAL, &o->psnr, ADCGS_TARGET_PSNR_MIN, ADCGS_TARGET_PSNR_MAX, "DB",
         "target mean PSNR of the training views, decoded from the\nfile, dB, +/- 0.1; the file is as small as it allows; test\n"
         "views are never used",
         NULL, &o->has_psnr},
        {"iterations", 'n', ADCGS_OPTION_INT, &o->iterations, iterations->min, iterations->max, "N",
         "iterations of the run (default: the preset's)", NULL, &o->has_iterations},
        {"scale", 0, ADCGS_OPTION_INT, &o->scale, scale->min, scale->max, "S",
         "divisor of the image size, an integer (default: 1, more for\nimages of over 1600 pixels)", NULL, &o->has_scale},
        {"k", 0, ADCGS_OPTION_INT, &o->k, k->min, k->max, "N", "primitives per anchor, 1 to 16 (default: the preset's)", NULL,
         &o->has_k},
        {"max-anchors", 0, ADCGS_OPTION_INT, &o->max_anchors, anchors->min, anchors->max, "N",
         "budget of anchors (default: from the amount of detail in\nthe images)", NULL, &o->has_max_anchors},
        {"dataset", 0, ADCGS_OPTION_CHOICE, &o->dataset, 0, 0, "KIND",
         "kind of the scene, instead of detecting it by its files:\nauto, transforms, hypernerf, llff, colmap, adcgs, splats\n"
         "or panoptic",
         adcgs_dataset_names, NULL},
        {"frames", 0, ADCGS_OPTION_STRING, &o->frames, 0, 0, "A:B:STEP",
         "frames A, A + STEP, ... below B of videos, or timestamps of\nimages, counted so; A, B or :STEP may be left out", NULL,
         NULL},
        {"fps", 0, ADCGS_OPTION_STRING, &o->fps, 0, 0, "N[/D]",
         "rate of the selected frames, per second (default: the\nscene's, else 30)", NULL, NULL},
        {"points", 0, ADCGS_OPTION_FILE, &o->points, 0, 0, "FILE",
         "initial points (PLY, NPY or Draco) instead of the scene's\nor random ones", NULL, NULL},
        {"segment", 0, ADCGS_OPTION_SECONDS, &o->segment, 1e-3, 1e6, "S",
         "length of segments, seconds, cut at the nearest timestamp;\n"
         "each is trained from the previous one, in a run of its own;\n"
         "with --plan: number of the only segment to train",
         NULL, &o->has_segment},
        {"plan", 0, ADCGS_OPTION_FILE, &o->plan, 0, 0, "FILE",
         "plan of the segments, with all settings: written, or read\nwith --segment 1, 2, ..., which trains one part anywhere;\n"
         "adcgs-join joins the parts",
         NULL, NULL},
        {"cut", 0, ADCGS_OPTION_SECONDS, &o->cut, 1e-3, 1e6, "S", "with --plan: length of segments, seconds (default 2)", NULL,
         &o->has_cut},
        {"key", 0, ADCGS_OPTION_SECONDS, &o->key, 0, 1e6, "S",
         "with --segment: longest interval of key segments, which need\n"
         "no other and where playback can begin, seconds (default 10)",
         NULL, &o->has_key},
        {"fade", 0, ADCGS_OPTION_SECONDS, &o->fade, 0, 1e6, "S",
         "with --segment: crossfade from the previous segment, seconds,\n"
         "at most a quarter of a segment (default 0.2; 0: none)",
         NULL, &o->has_fade},
        {"or-whole", 0, ADCGS_OPTION_FLAG, &o->or_whole, 0, 0, NULL,
         "with --segment: also train one segment of the whole time,\nand write that if it is neither larger nor worse", NULL,
         NULL},
        {"live", 0, ADCGS_OPTION_FLAG, &o->live, 0, 0, NULL,
         "train footage while it arrives: SCENE is a scene file, or a\n"
         "folder with scene.json; segments, of 2 s or as --segment says,\n"
         "are written when done; -o - writes to standard output; a\ncamera's video may be -, standard input",
         NULL, NULL},
        {"delay", 0, ADCGS_OPTION_SECONDS, &o->delay, 1e-3, 1e6, "S",
         "with --live: maximum time from filming to writing, seconds;\neffort falls if needed (default: no limit)", NULL,
         &o->has_delay},
        {"without", 0, ADCGS_OPTION_STRING, &o->without, 0, 0, "PART,...",
         "parts to leave out: coarse, fine, deformation (both), rate,\n"
         "densification, anchors, removal or weight_steps",
         NULL, NULL},
        {"uncompressed", 0, ADCGS_OPTION_FILE, &o->uncompressed, 0, 0, "FILE",
         "file for the model as plain binary32 numbers, trained\nwithout rate and rounding; the stream is then the finest", NULL,
         NULL},
        {"fixed", 0, ADCGS_OPTION_FLAG, &o->fixed, 0, 0, NULL, "model size from the preset alone, not from the scene", NULL,
         NULL},
        {"no-progression", 0, ADCGS_OPTION_FLAG, &o->no_progression, 0, 0, NULL,
         "all anchors at once, instead of tiers that each add detail\nto the previous ones; a few percent smaller", NULL, NULL},
        {"set", 0, ADCGS_OPTION_STRING, &o->set, 0, 0, "NAME=VALUE,...",
         "changes of the preset's settings; 'list' shows them all", names, NULL},
        {"time-limit", 0, ADCGS_OPTION_SECONDS, &o->time_limit, 0, ADCGS_TIME_LIMIT_MAX, "S",
         "time until training ends, seconds, load time included; the\n"
         "result then depends on the machine's speed (default: no limit)",
         NULL, NULL},
        {"seed", 0, ADCGS_OPTION_SIZE, &o->seed, seed->min, seed->max, "N", "seed of every random choice (default 1)", NULL,
         &o->has_seed},
        {"checkpoint", 0, ADCGS_OPTION_FILE, &o->checkpoint, 0, 0, "FILE",
         "file for the state of the run, saved every minute and when\n"
         "interrupted (default then: the output's name.checkpoint)",
         NULL, NULL},
        {"checkpoint-every", 0, ADCGS_OPTION_SECONDS, &o->checkpoint_every, 0, 1e6, "S",
         "interval of such saves, seconds (default 60)", NULL, NULL},
        {"resume", 0, ADCGS_OPTION_FILE, &o->resume, 0, 0, "FILE",
         "state to continue from; same scene, same options (with --live:\nthe output that a run has left)", NULL, NULL},
        {"finish", 0, ADCGS_OPTION_FILE, &o->finish, 0, 0, "FILE",
         "state to make a stream of without more training; same scene,\nsame options", NULL, NULL},
        {"beginning", 0, ADCGS_OPTION_FILE, &o->beginning, 0, 0, "FILE",
         "file for the state up to which lambda has no effect; the run\nends there; runs with any lambda can --resume it", NULL,
         NULL},
        {"log", 0, ADCGS_OPTION_FILE, &o->log, 0, 0, "FILE",
         "progress as JSON lines; appended with --resume, and by a\nplan's segments", NULL, NULL},
        {"preview", 0, ADCGS_OPTION_FILE, &o->preview, 0, 0, "FILE",
         "image (PNG, JPEG, ...) of a view as filmed and as rendered,\nupdated every 30 seconds", NULL, NULL},
        {"memory", 0, ADCGS_OPTION_SIZE, &o->memory, 1, 1e15, "BYTES",
         "maximum memory of images, bytes (2G); the others are kept in\n"
         "a file in TMPDIR (default: half of the machine's); no effect\non the result",
         NULL, NULL},
        {"threads", 't', ADCGS_OPTION_INT, &o->threads, 0, 256, "N", "threads (default: one per CPU); no effect on the result",
         NULL, NULL},
        {"cpu", 0, ADCGS_OPTION_CHOICE, &o->cpu, 0, 0, "LEVEL", "kernels: auto, scalar, avx2, avx512 (default auto)",
         adcgs_cpu_names, NULL},
        {"bf16", 0, ADCGS_OPTION_FLAG, &o->bf16, 0, 0, NULL,
         "train the networks of the rendered values in bf16, which is\nfaster; needs a CPU with AVX512-BF16", NULL, NULL},
        {"json", 0, ADCGS_OPTION_FLAG, &o->json, 0, 0, NULL, "print the result as one JSON object on stdout", NULL, NULL},
    };
    cli->options = options;
    cli->n_options = ADCGS_COUNTOF(options);
    cli->quiet = &o->quiet;
    const adcgs_enc_options before = *o;
    int first, code = adcgs_cli_parse(cli, argc, argv, &first);
    if (code < 0 && o->plan)
        code = adcgs_enc_plan_check(cli, o, &before);
    cli->n_options = 0; /* options is local to this function */
    if (code >= 0)
        return code;
    if (o->set && !strcmp(o->set, "list"))
        return list_settings(cli, o);
    if (first >= argc)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "one operand expected: SCENE");
    if (first + 1 < argc)
        return report_surplus(cli, argc - first, argv + first);
    o->scene = argv[first];
    if (o->plan)
        return -1;
    if (o->has_cut)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--cut needs --plan");
    if (!o->output == !o->beginning)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE,
                               o->output ? "give either -o FILE or --beginning FILE" : "no output: give -o FILE");
    if (o->has_lambda + o->has_size + o->has_psnr > 1)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--lambda, --size and --psnr exclude each other");
    if (o->finish && (o->resume || o->beginning || o->checkpoint || o->has_segment || o->live || o->time_limit > 0))
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE,
                               "--finish excludes --resume, --beginning, --checkpoint, --segment, --live "
                               "and --time-limit");
    if (o->live)
        return check_live(cli, o);
    if (o->has_delay)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--delay needs --live");
    if ((o->has_key || o->has_fade || o->or_whole) && !o->has_segment)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--%s needs --segment",
                               o->has_key    ? "key"
                               : o->has_fade ? "fade"
                                             : "or-whole");
    if (o->has_segment && (o->has_size || o->beginning || o->uncompressed || o->time_limit > 0))
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--segment excludes --size, --beginning, --uncompressed and --time-limit");
    return -1;
}

static adcgs_status run_program(const adcgs_cli *cli, adcgs_enc_options *o, const adcgs_ranks *ranks, int *met,
                                adcgs_error *error)
{
    adcgs_pool *pool = NULL;
    char log[PATH_MAX];
    if (ranks->size && !o->threads)
        o->threads = adcgs_enc_ranks_threads(ranks);
    if (ranks->rank && !o->has_segment)
        o->quiet = 1;            /* rank 0 reports for all */
    if (ranks->rank && o->log) { /* a log has one writer */
        snprintf(log, sizeof log, "%s.%d", o->log, ranks->rank);
        o->log = log;
    }
    if (o->set)
        adcgs_former_settings_report(cli, o->set);
    adcgs_status status = adcgs_cli_pool(cli, &pool, o->threads, error);
    if (status == ADCGS_OK)
        status = encode(cli, o, ranks, pool, met, error);
    adcgs_pool_free(&pool);
    return status;
}

int main(int argc, char **argv)
{
    adcgs_enc_options o = {.preset = "fast",
                           .fade = ADCGS_ENC_FADE,
                           .cut = ADCGS_ENC_LIVE_SEGMENT,
                           .checkpoint_every = 60,
                           .started = adcgs_time_now()};
    adcgs_cli cli = program;
    const int code = parse(&cli, &o, argc, argv);
    if (code >= 0)
        return code;
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_ranks ranks = {.size = 0};
    int met = 1;
    adcgs_status status = o.plan || adcgs_ranks_expected() == 1 ? ADCGS_OK : adcgs_ranks_open(&ranks, &error);
    if (status == ADCGS_OK)
        status = run_program(&cli, &o, &ranks, &met, &error);
    if (status == ADCGS_OK) {
        if (ranks.size && !ranks.rank)
            adcgs_enc_ranks_dismiss(&ranks);
        adcgs_ranks_close(&ranks);
        return adcgs_cli_leave(&cli, met ? 0 : 1);
    }
    error.status = status;
    const int bad = adcgs_cli_fail(&cli, &error);
    if (ranks.size && !adcgs_interrupted()) /* an interrupt has reached all ranks already */
        adcgs_ranks_abort(&ranks, bad);
    return bad;
}
