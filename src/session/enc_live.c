/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * adcgs-enc --live. Memory holds the images of the segment in training, its model and the previous model. Later images stay at
 * their source (scene/live/live_scene.h).
 */
#include "config.h"

#include "session/enc_live.h"

#include "scene/live/live_scene.h"
#include "session/enc_effort.h"
#include "session/enc_live_file.h"
#include "session/enc_live_resume.h"
#include "session/enc_live_sum.h"
#include "session/enc_parts.h"
#include "session/live_stream.h"
#include "system/claim.h"
#include "system/growing.h"
#include "system/interrupt.h"
#include "system/pipe.h"
#include "train/resolve.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>

#define ANCHORS_MARGIN 2 /* HEAD allows this multiple of the budget; chosen by hand, not measured */

typedef struct live_run {
    adcgs_enc_context *w;
    adcgs_enc_job *job;
    adcgs_live *live;
    adcgs_live_segment segment;
    adcgs_encode_live stream;
    adcgs_enc_live_file file;
    adcgs_claim *claim;         /* on the file; NULL: a pipe */
    adcgs_enc_live_resume past; /* the stream to continue */
    adcgs_buffer bytes;         /* of the current segment */
    int is_open;                /* the stream has a segment */
    double key;                 /* seconds at which the last key began */
    adcgs_enc_effort effort;
    adcgs_enc_live_sum sum;
} live_run;

/* ---- Writing ---- */

static adcgs_status append(live_run *r, adcgs_error *error)
{
    r->file.growing.is_hidden = 0;
    if (r->claim)
        ADCGS_TRY(adcgs_claim_check(r->claim, error));
    ADCGS_TRY(adcgs_enc_live_file_append(&r->file, r->bytes.data, r->bytes.size, error));
    r->sum.bytes += r->bytes.size;
    r->bytes.size = 0;
    return ADCGS_OK;
}

/** Ends the stream and its file. */
static adcgs_status end_stream(live_run *r, adcgs_error *error)
{
    adcgs_buffer head;
    ADCGS_TRY(adcgs_encode_live_end(&r->stream, &r->bytes, error));
    ADCGS_TRY(append(r, error));
    adcgs_buffer_init(&head);
    adcgs_status status = adcgs_grow_settle(r->stream.grow, &head, error);
    if (status == ADCGS_OK)
        status = adcgs_enc_live_file_end(&r->file, &head, error);
    adcgs_buffer_clear(&head);
    adcgs_encode_live_clear(&r->stream);
    r->is_open = 0;
    return status;
}

/** Opens a stream, to which the last trained segment can be added. */
static adcgs_status begin_stream(live_run *r, adcgs_error *error)
{
    const adcgs_enc_job *job = r->job;
    const uint32_t times = adcgs_live_times(r->live, NULL);
    adcgs_enc_notes n;
    adcgs_enc_make_notes(&n, r->w->t, (const char *)r->w->changes.data);
    r->is_open = 1;
    r->sum.streams++;
    adcgs_cuts cuts = {.n = times - 1, .at = adcgs_alloc(NULL, times, sizeof *cuts.at, error)};
    if (!cuts.at)
        return adcgs_alloc_status(error);
    adcgs_live_times(r->live, cuts.at);
    const adcgs_status status =
        adcgs_encode_live_open(&r->stream, adcgs_live_whole(r->live), &cuts, ANCHORS_MARGIN * job->config.max_anchors, n.list,
                               n.n, job->cpu, job->pool, error);
    adcgs_cuts_clear(&cuts);
    return status;
}

/** Ends a stream that has reached its level's limits, and begins another with this segment. */
static adcgs_status begin_another(live_run *r, adcgs_model *model, adcgs_error *error)
{
    ADCGS_TRY(end_stream(r, error));
    ADCGS_TRY(adcgs_enc_live_file_next(&r->file, error));
    adcgs_cli_note(r->job->cli, "the stream is full, with %u segments; another begins: %s", r->past.n + r->sum.n, r->file.path);
    ADCGS_TRY(begin_stream(r, error));
    return adcgs_encode_live_add(&r->stream, model, &r->bytes, error);
}

/** follows: the segment was trained from the previous one. */
static adcgs_status add_segment(live_run *r, int follows, adcgs_model *model, adcgs_error *error)
{
    const adcgs_live_segment *s = &r->segment;
    ADCGS_TRY(adcgs_encode_model(model, &r->stream.front, r->w->t, s->begin, s->end, error));
    if (follows)
        ADCGS_TRY(adcgs_encode_predict(model, &r->stream.model, error));
    const adcgs_status status = adcgs_encode_live_add(&r->stream, model, &r->bytes, error);
    return status == ADCGS_ERR_LIMIT && r->stream.model.n ? begin_another(r, model, error) : status;
}

static adcgs_status write_segment(live_run *r, int follows, adcgs_error *error)
{
    adcgs_model model = {.n = 0};
    if (!r->is_open)
        ADCGS_TRY(begin_stream(r, error));
    const adcgs_status status = add_segment(r, follows, &model, error);
    adcgs_model_clear(&model, NULL);
    if (status == ADCGS_OK && !r->stream.model.predicted) {
        r->key = r->segment.begin;
        r->sum.keys++;
    }
    return status == ADCGS_OK ? append(r, error) : status;
}

/* ---- Training ---- */

/**
 * True if the segment is trained from the previous one: no key is due yet, or it has too few timestamps for a key's time table.
 */
static int is_to_follow(const live_run *r)
{
    const adcgs_live_segment *s = &r->segment;
    const double every = r->job->o->has_key ? r->job->o->key : ADCGS_ENC_KEY_EVERY;
    return r->is_open && (s->end - r->key <= every + 1e-6 || s->scene->n_times < r->stream.front.params.time_rows);
}

static adcgs_status learn_segment(live_run *r, adcgs_error *error)
{
    adcgs_enc_context *w = r->w;
    const int follows = is_to_follow(r);
    const adcgs_model *before = r->is_open ? &r->stream.model : NULL;
    const double started = adcgs_seconds();
    if (r->is_open) /* keys have the parameters of the first segment */
        adcgs_resolve_key(&r->job->config, r->stream.front.params.time_rows);
    w->segment = r->past.n + r->sum.n;
    w->next_log = 0;
    w->first = w->last = (adcgs_train_report){.iteration = 0};
    adcgs_enc_effort_choose(&r->effort, r->job, r->segment.came, r->segment.end - r->segment.begin, w->segment);
    ADCGS_TRY(adcgs_enc_train(w, r->job, r->segment.scene, follows ? before : NULL, before, NULL, (adcgs_time){0, 0}, error));
    ADCGS_TRY(write_segment(r, w->t->f->follows, error));
    adcgs_enc_effort_train(&r->effort, &w->first, &w->last, adcgs_seconds() - started);
    adcgs_enc_live_sum_add(&r->sum, r->segment.begin, r->segment.end, r->segment.came, w->last.iteration);
    return ADCGS_OK;
}

static void report_missing(live_run *r)
{
    double time;
    for (const char *name; (name = adcgs_live_missing(r->live, &time));)
        adcgs_cli_error(r->job->cli, ADCGS_OK,
                        "%s: no image at %g s; this time, and similar ones, are trained without it "
                        "(reported once)",
                        name, time);
}

/* ---- Continuing a stream ---- */

/** Takes the stream of an earlier run. The file does not change before another segment follows. */
static adcgs_status take_past(live_run *r, adcgs_live_options *options, adcgs_error *error)
{
    const adcgs_model *const last = &r->past.last;
    ADCGS_TRY(
        adcgs_enc_live_resume_read(&r->past, &r->stream, &r->file, ANCHORS_MARGIN * r->job->config.max_anchors, r->job, error));
    options->last[0] = last->time_start;
    options->last[1] = last->time_end;
    memcpy(options->origin, r->stream.front.scene_origin, sizeof options->origin);
    options->scale = r->stream.front.scene_scale;
    return ADCGS_OK;
}

/** Completes the earlier stream, now that the next segment is known. */
static adcgs_status go_on(live_run *r, adcgs_error *error)
{
    const double begin = r->segment.scene ? r->segment.begin : INFINITY, end = r->past.last.time_end;
    if (r->segment.scene)
        ADCGS_TRY(adcgs_encode_live_check(&r->stream, adcgs_live_whole(r->live), error));
    ADCGS_TRY(adcgs_enc_live_resume_end(&r->past, &r->stream, &r->file, begin, error));
    r->key = r->past.key;
    r->sum.bytes = r->past.bytes;
    r->sum.past = r->past.n;
    r->is_open = r->stream.model.n > 0;
    r->sum.streams = (uint32_t)r->is_open;
    if (!r->is_open) /* its only segment is trained again */
        adcgs_encode_live_clear(&r->stream);
    else if (r->segment.scene && begin > r->stream.model.time_end + 1e-3)
        adcgs_cli_note(r->job->cli, "nothing is trained between %g and %g s: the earlier run had other segment boundaries", end,
                       begin);
    return ADCGS_OK;
}

/** Fixes all settings, now that the size of the images is known. */
static adcgs_status settle(live_run *r, adcgs_error *error)
{
    adcgs_train_config sized = *r->job->requested;
    adcgs_enc_reduce_large(r->job, r->segment.scene, &r->w->progress);
    adcgs_resolve_size(&sized, r->job->config.scale);
    return adcgs_train_changes(&sized, &r->w->changes, error);
}

static adcgs_status learn_all(live_run *r, adcgs_error *error)
{
    for (int is_first = 1;; is_first = 0) {
        ADCGS_TRY(adcgs_live_next(r->live, &r->segment, error));
        if (r->past.last.n)
            ADCGS_TRY(go_on(r, error));
        if (!r->segment.scene)
            return ADCGS_OK;
        if (is_first)
            ADCGS_TRY(settle(r, error));
        report_missing(r);
        const adcgs_status status = learn_segment(r, error);
        adcgs_trainer_free(&r->w->t);
        ADCGS_TRY(status);
    }
}

/** True if the stream of a failed run can be ended: all its segments are written. */
static int can_end(const live_run *r, adcgs_status status)
{
    return r->is_open && r->stream.model.n && !r->bytes.size && !r->file.growing.is_hidden && status != ADCGS_ERR_INTERNAL;
}

/** Claims the file: two writers would overwrite each other. */
static adcgs_status claim_file(live_run *r, adcgs_error *error)
{
    char *name;
    if (adcgs_pipe_is(r->job->o->output))
        return ADCGS_OK;
    ADCGS_TRY(adcgs_enc_claim_name(&name, r->job->o->output, error));
    const adcgs_status status = adcgs_claim_take(&r->claim, name, "this output", error);
    free(name);
    return status;
}

static adcgs_status run(live_run *r, adcgs_error *error)
{
    const adcgs_enc_options *o = r->job->o;
    adcgs_live_options options = {.seconds = o->segment,
                                  .unbounded = o->has_delay,
                                  .points_path = o->points,
                                  .interrupted = adcgs_interrupted};
    adcgs_interrupt_catch(1);
    signal(SIGPIPE, SIG_IGN); /* a reader that leaves is a write error */
    ADCGS_TRY(adcgs_enc_live_file_open(&r->file, o->output, o->resume, error));
    ADCGS_TRY(claim_file(r, error));
    if (o->resume)
        ADCGS_TRY(take_past(r, &options, error));
    ADCGS_TRY(adcgs_live_open(&r->live, o->scene, &options, error));
    const adcgs_status status = learn_all(r, error);
    if (status != ADCGS_OK) {
        adcgs_error ignored;
        if (can_end(r, status))
            end_stream(r, &ignored);
        return status;
    }
    ADCGS_TRY(end_stream(r, error));
    return adcgs_enc_live_sum_print(&r->sum, r->job, error);
}

adcgs_status adcgs_enc_live(adcgs_enc_context *w, adcgs_enc_job *job, adcgs_error *error)
{
    live_run r = {.w = w, .job = job};
    if (job->config.exposure_step_compensation)
        return adcgs_fail(error, ADCGS_ERR_USAGE,
                          "--live: exposure_step_compensation needs all images before training: leave it out");
    w->is_live = 1;
    adcgs_resolve_live(&job->config);
    adcgs_buffer_init(&r.bytes);
    adcgs_enc_effort_init(&r.effort, job);
    const adcgs_status status = run(&r, error);
    adcgs_live_segment_clear(&r.segment);
    adcgs_encode_live_clear(&r.stream);
    adcgs_enc_live_resume_clear(&r.past);
    adcgs_trainer_free(&w->t); /* before the scene that it uses */
    adcgs_live_close(&r.live);
    adcgs_enc_live_file_close(&r.file);
    adcgs_claim_drop(&r.claim);
    adcgs_buffer_clear(&r.bytes);
    return status;
}
