/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc: trains a scene from posed images and writes it to one file. */
#include "config.h"

#include "apps/enc/enc_command.h"
#include "apps/enc/enc_configure.h"
#include "apps/shared/former_settings.h"
#include "base/cpu_detect.h"
#include "encode/encode.h"
#include "encode/raw.h"
#include "scene/layouts/open.h"
#include "session/enc_footage.h"
#include "session/enc_live.h"
#include "session/enc_parts.h"
#include "session/enc_plan.h"
#include "session/enc_rank.h"
#include "session/enc_ranks.h"
#include "session/enc_report.h"
#include "session/enc_rescue.h"
#include "session/enc_run.h"
#include "session/enc_segments.h"
#include "session/enc_trials.h"
#include "system/atomic.h"
#include "system/claim.h"
#include "system/extension.h"
#include "system/interrupt.h"
#include "system/json.h"
#include "system/text.h"
#include "train/settings.h"

#include <adcgs/adcgs.h>

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* ---- The job ---- */

/** Checks the options before anything long begins. */
static adcgs_status prepare(adcgs_enc_job *job, adcgs_train_config *requested, adcgs_enc_context *w, adcgs_scene_options *scene,
                            adcgs_error *error)
{
    const adcgs_enc_options *o = job->o;
    ADCGS_TRY(adcgs_cpu_resolve((adcgs_cpu_level)o->cpu, &job->cpu, error));
    if (o->frames)
        ADCGS_TRY(adcgs_frames_parse(&scene->frames, o->frames, error));
    if (o->fps)
        ADCGS_TRY(adcgs_fps_read_option(&scene->rate, o->fps, error));
    ADCGS_TRY(adcgs_enc_configure(requested, o, job->cpu, error));
    job->requested = requested;
    job->config = *requested;
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

#define PART_NAME 20 /* most bytes that a part's name adds to the state's: ".<number>.adcgs"; arithmetic */

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
    adcgs_scene_options scene = {.points_path = o->points,
                                 .dataset = o->dataset,
                                 .splat_frames = (uint32_t)o->splat_frames,
                                 .is_partial = o->is_partial};
    adcgs_train_config requested;
    ADCGS_TRY(prepare(job, &requested, w, &scene, error));
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

/* ---- The program ---- */

#define OPERANDS_MAX 1000000 /* operands of a command; chosen by hand, not measured */

static const adcgs_cli program = {
    .program = "adcgs-enc",
    .operands = "SCENE",
    .summary = "Train a dynamic scene from posed images and write it to one file.",
    .details = "SCENE is a folder in the layout of D-NeRF, nerfstudio, HyperNeRF, LLFF, Neu3D, COLMAP or\n"
               "Dynamic 3D Gaussians, a transforms.json, a scene file, or splats, whose views are rendered: a file\n"
               "(PLY, SPZ, GLB, SOG, .splat, .ksplat), or splats over time, as a file or a folder of numbered files.\n"
               "Seconds may have a unit: 500ms, 2s, 10m, 1.5h. Counts may be in thousands or millions: 20k, 2M.",
    .min_operands = 0,
    .max_operands = OPERANDS_MAX, /* one is expected; the message depends on the others */
};

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
    const int code = adcgs_enc_parse(&cli, &o, argc, argv);
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
