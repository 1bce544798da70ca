/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A scene in segments. */
#include "config.h"

#include "session/enc_segments.h"

#include "base/digest.h"
#include "scene/layouts/open.h"
#include "session/enc_parts.h"
#include "session/enc_rescue.h"
#include "session/enc_whole.h"
#include "session/plan_parts.h"
#include "system/atomic.h"
#include "train/resolve.h"

#include <stdlib.h>
#include <unistd.h>

void adcgs_enc_cut_config(adcgs_enc_job *job)
{
    job->whole = job->config;
    if (job->cuts.n > 1)
        adcgs_resolve_parts(&job->config, job->cuts.moments);
}

adcgs_status adcgs_enc_cut(adcgs_enc_job *job, double seconds, adcgs_error *error)
{
    ADCGS_TRY(adcgs_cuts_find(&job->cuts, job->scene, seconds, job->o->fade, error));
    adcgs_enc_cut_config(job);
    job->follows = adcgs_alloc(NULL, job->cuts.n, sizeof *job->follows, error);
    if (!job->follows)
        return adcgs_alloc_status(error);
    const double *at = job->cuts.at, every = job->o->has_key ? job->o->key : ADCGS_ENC_KEY_EVERY;
    for (uint32_t i = 1, key = 0; i < job->cuts.n; i++) {
        job->follows[i] = at[i + 1] - at[key] <= every + 1e-6;
        key = job->follows[i] ? key : i;
    }
    return ADCGS_OK;
}

/** The notes of a run that has ended, except lambda. */
static void expect_notes(adcgs_enc_notes *n, const adcgs_enc_context *w, const adcgs_enc_job *job)
{
    adcgs_trainer ended = {.config = job->config, .run.iteration = job->config.iterations};
    memcpy(ended.trials, w->trials, sizeof ended.trials);
    adcgs_enc_make_notes(n, &ended, (const char *)w->changes.data);
}

/** Loads the model that the part is trained from; with a plan, that part must belong to the plan, too. */
static adcgs_status load_before(adcgs_model *before, const adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_error *error)
{
    if (!job->follows[w->segment])
        return ADCGS_OK;
    if (job->ranks)
        adcgs_enc_part_await(w->base, w->segment - 1);
    return job->plan ? adcgs_plan_part_model(before, job->plan, w->base, w->segment - 1, job->cpu, job->pool, error)
                     : adcgs_enc_part_model(before, w->base, w->segment - 1, job->cpu, job->pool, error);
}

/** Adds notes on the part's plan and on the model that it continues. */
static void add_plan_notes(adcgs_enc_notes *n, const adcgs_enc_context *w, const adcgs_enc_job *job)
{
    if (!job->plan)
        return;
    n->list[n->n++] = (adcgs_encode_note){ADCGS_NOTE_PLAN, job->plan->digest};
    if (!job->follows[w->segment])
        return;
    adcgs_md5_hex(w->t->before, n->follows);
    n->list[n->n++] = (adcgs_encode_note){ADCGS_NOTE_FOLLOWS, n->follows};
}

static adcgs_status learn_scene(adcgs_enc_context *w, const adcgs_enc_job *job, const adcgs_scene *scene, adcgs_time *spent,
                                adcgs_error *error)
{
    adcgs_model before = {.n = 0};
    adcgs_enc_notes n;
    const int resumes = job->plan || job->o->resume;
    w->next_log = 0;
    adcgs_status status = job->scene->is_outline ? adcgs_scene_check_files(scene, error) : ADCGS_OK;
    if (status == ADCGS_OK)
        status = load_before(&before, w, job, error);
    if (status == ADCGS_OK)
        status = adcgs_enc_train(w, job, scene, job->follows[w->segment] ? &before : NULL, NULL,
                                 resumes && !access(w->state, F_OK) ? w->state : NULL, adcgs_time_now(), error);
    adcgs_model_clear(&before, NULL);
    *spent = adcgs_time_plus(*spent, w->last.spent);
    if (status != ADCGS_OK || adcgs_enc_team_follows(&w->team))
        return status;
    adcgs_enc_make_notes(&n, w->t, (const char *)w->changes.data);
    add_plan_notes(&n, w, job);
    status = adcgs_enc_part_save(w->base, &job->cuts, w->segment, w->t, n.list, n.n, job->pool, error);
    if (status != ADCGS_OK && status != ADCGS_ERR_DATA)
        adcgs_enc_rescue(job->cli, w, status);
    return status;
}

adcgs_status adcgs_enc_segment_train(adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_time *spent, adcgs_error *error)
{
    adcgs_scene part;
    if (job->cuts.n > 1)
        ADCGS_TRY(adcgs_scene_part(&part, job->scene, &job->cuts, w->segment, error));
    const adcgs_status status = learn_scene(w, job, job->cuts.n > 1 ? &part : job->scene, spent, error);
    adcgs_trainer_free(&w->t);
    if (job->cuts.n > 1)
        adcgs_scene_part_clear(&part);
    return status;
}

adcgs_status adcgs_enc_segment_begin(adcgs_enc_context *w, uint32_t segment, adcgs_error *error)
{
    free(w->state);
    w->state = NULL;
    w->segment = segment;
    return adcgs_enc_part_name(&w->state, w->base, segment, 0, error);
}

adcgs_status adcgs_enc_segment_find(adcgs_enc_context *w, const adcgs_enc_job *job, uint32_t segment, int *found,
                                    adcgs_error *error)
{
    adcgs_enc_notes expected;
    *found = 0;
    if (!job->o->resume)
        return ADCGS_OK;
    expect_notes(&expected, w, job);
    return adcgs_enc_part_check(w->base, job->scene, &job->cuts, segment, expected.list, expected.n, job->cpu, job->pool, found,
                                error);
}

adcgs_status adcgs_enc_segments_train(adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_time *spent, adcgs_error *error)
{
    w->segments = job->cuts.n;
    for (uint32_t i = 0; i < w->segments; i++) {
        int found;
        ADCGS_TRY(adcgs_enc_segment_begin(w, i, error));
        ADCGS_TRY(adcgs_enc_segment_find(w, job, i, &found, error));
        if (!found)
            ADCGS_TRY(adcgs_enc_segment_train(w, job, spent, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_enc_segments_write(adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_time *spent, adcgs_error *error)
{
    adcgs_stream stream;
    adcgs_buffer bytes;
    adcgs_buffer_init(&bytes);
    for (uint32_t i = 0; job->ranks && i < job->cuts.n; i++)
        adcgs_enc_part_await(w->base, i);
    adcgs_status status =
        adcgs_enc_parts_join(&stream, w->base, job->scene, &job->cuts, job->follows, job->cpu, job->pool, error);
    if (status == ADCGS_OK)
        status = adcgs_encode_verified(&stream, &bytes, job->cpu, job->pool, error);
    if (status == ADCGS_OK && job->o->or_whole)
        status = adcgs_enc_try_whole(w, job, &bytes, spent, error);
    if (status == ADCGS_OK)
        status = adcgs_atomic_save(job->o->output, bytes.data, bytes.size, error);
    if (status == ADCGS_OK) {
        adcgs_enc_parts_remove(w->base, job->cuts.n);
        if (job->o->or_whole)
            adcgs_enc_part_remove(w->base, job->cuts.n, 0);
    }
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
    return status;
}
