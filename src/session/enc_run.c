/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A run of adcgs-enc. */
#include "config.h"

#include "session/enc_run.h"

#include "check/light.h"
#include "metric/metric.h"
#include "model/model_priv.h"
#include "session/enc_footage.h"
#include "session/enc_image_space.h"
#include "session/enc_log.h"
#include "session/enc_rescue.h"
#include "system/interrupt.h"
#include "system/text.h"
#include "train/resolve.h"

#include <stdlib.h>

/* ---- Progress ---- */

/** Saves a checkpoint. If that fails the run continues, and tries again when the next one is due. */
static void save_now_and_then(adcgs_enc_context *w, double seconds)
{
    adcgs_error why = {ADCGS_OK, ""};
    const int failed = w->unsaved;
    w->saved = seconds;
    w->unsaved = adcgs_trainer_save(w->t, w->state, &why) != ADCGS_OK;
    if (w->unsaved == failed)
        return;
    adcgs_progress_clear(&w->progress);
    if (w->unsaved)
        adcgs_cli_error(w->progress.cli, ADCGS_OK, "%s; the run continues, and tries again every %g s", why.text,
                        w->o->checkpoint_every);
    else
        adcgs_cli_note(w->progress.cli, "%s: written again", w->state);
}

static void free_thumbnails(adcgs_enc_context *w)
{
    adcgs_free(NULL, w->thumbnails);
    w->t->views.thumbnails = w->thumbnails = NULL;
}

/** Checks the footage once its images are loaded, before hours are spent on it. */
static void look_at_footage(adcgs_enc_context *w)
{
    if (!w->thumbnails || !w->t->views.divide)
        return;
    adcgs_progress_clear(&w->progress);
    const adcgs_footage_facts facts = {w->t->scene, w->begins, &w->t->stereo, w->thumbnails};
    adcgs_enc_diagnose_footage(w->progress.cli, &facts, w->t->pool, &w->diagnosed);
    free_thumbnails(w);
}

static int observe(void *user, const adcgs_train_report *r)
{
    adcgs_enc_context *w = user;
    char left[32], attempt[32] = "", segment[32] = "";
    if (w->segments)
        snprintf(segment, sizeof segment, "%u/%u ", w->segment + 1, w->segments);
    else if (w->is_live)
        snprintf(segment, sizeof segment, "%u: ", w->segment + 1);
    if (r->attempt > 1)
        snprintf(attempt, sizeof attempt, "try %d: ", r->attempt);
    int stops = 0;
    look_at_footage(w);
    if (w->t->views.divide)
        adcgs_enc_report_no_space(w);
    w->last = *r;
    if (r->iteration && !w->first.iteration)
        w->first = *r;
    if (r->iteration >= w->next_log || r->iteration + 100 < w->next_log) /* a rollback goes back, and so does another try */
        adcgs_enc_log_last(w);
    if (w->t->views.divide) /* contrast determines lambda once the images are loaded */
        adcgs_enc_log_settings(w);
    if (w->on_progress)
        stops = w->on_progress(w->progress_user, w);
    else if (r->iteration)
        adcgs_progress_show(&w->progress, "%s%s%-9s %6u/%u  1/%d  loss %.4f  %.2f dB  %u anchors  %.0f KB  %.0f it/s%s", segment,
                            attempt, r->stage, r->iteration, r->iterations, r->divide, r->loss, r->psnr, r->anchors,
                            r->bytes / 1000, r->rate, adcgs_progress_eta(r->left, left));
    if (r->iteration)
        adcgs_enc_preview_show(&w->preview, w->t, r->stage, &w->progress);
    if (w->keeps && r->spent.clock - w->saved > w->o->checkpoint_every)
        save_now_and_then(w, r->spent.clock);
    return stops || (adcgs_interrupted() && !w->is_live);
}

static int loading(void *user, uint32_t done, uint32_t n)
{
    adcgs_enc_context *w = user;
    if (!w->on_progress)
        adcgs_progress_show(&w->progress, "images    %6u/%u", done, n);
    /* Later there is a run to save, after the images are loaded. */
    return adcgs_interrupted() && !w->t->run.iteration && !w->is_live;
}

/* ---- Notes in the stream ---- */

void adcgs_enc_make_notes(adcgs_enc_notes *n, const adcgs_trainer *t, const char *changes)
{
    snprintf(n->seed, sizeof n->seed, "%llu", (unsigned long long)t->config.seed);
    snprintf(n->lambda, sizeof n->lambda, "%g", t->rate.lambda);
    snprintf(n->iterations, sizeof n->iterations, "%u", t->run.iteration);
    adcgs_decisions_format(&t->decisions, n->decisions);
    const adcgs_encode_note list[] = {
        {"encoder", "adcgs-enc " PACKAGE_VERSION},
        {"preset", t->config.preset},
        {"lambda", n->lambda},
        {"iterations", n->iterations},
        {"seed", n->seed},
        {"decisions", n->decisions},
    };
    snprintf(n->trials, sizeof n->trials, "%s", t->trials);
    const adcgs_encode_note some[] = {{"settings", changes}, {"trials", n->trials}};
    memcpy(n->list, list, sizeof list);
    n->n = ADCGS_COUNTOF(list);
    for (size_t i = 0; i < ADCGS_COUNTOF(some); i++)
        if (*some[i].value)
            n->list[n->n++] = some[i];
}

/** The bytes of the run's file. */
static adcgs_status measure(void *user, const adcgs_trainer *t, adcgs_bytes *bytes, adcgs_error *error)
{
    const adcgs_enc_context *w = user;
    adcgs_enc_notes n;
    adcgs_enc_make_notes(&n, t, (const char *)w->changes.data);
    return adcgs_encode_bytes(bytes, t, -1, n.list, n.n, error);
}

adcgs_status adcgs_enc_encode(adcgs_stream *stream, adcgs_buffer *bytes, const adcgs_enc_context *w, adcgs_pool *pool,
                              adcgs_error *error)
{
    adcgs_enc_notes n;
    adcgs_enc_make_notes(&n, w->t, (const char *)w->changes.data);
    ADCGS_TRY(adcgs_encode_stream(stream, w->t, n.list, n.n, error));
    return adcgs_encode_verified(stream, bytes, w->t->cpu, pool, error);
}

/* ---- Training ---- */

static adcgs_status stop_early(const adcgs_cli *cli, adcgs_enc_context *w, adcgs_error *error)
{
    char *path;
    if (adcgs_enc_is_ready(w) && adcgs_interrupts() < 2)
        adcgs_cli_error(cli, ADCGS_OK, "interrupted: saving the state; a second interrupt makes a file of the present state");
    ADCGS_TRY(adcgs_enc_save(w, w->state, 1, &path, error));
    if (!w->on_progress) /* else the listener reports for all */
        adcgs_enc_report_continuation(cli, w, "stopped", path);
    free(path);
    return ADCGS_OK;
}

/** Makes a stream of a run at any stage. */
static adcgs_status finish(const adcgs_cli *cli, adcgs_enc_context *w, adcgs_error *error)
{
    if (!adcgs_trainer_moves(w->t))
        adcgs_cli_error(cli, ADCGS_OK,
                        "%s: at iteration %u of %u nothing moves yet: the file shows a static, coarse scene; a "
                        "run of -n %u shows far more",
                        w->target, w->t->run.iteration, w->t->config.iterations, ADCGS_MAX(w->t->run.iteration, 300));
    adcgs_progress_show(&w->progress, "finish  the state after iteration %u ...", w->t->run.iteration);
    const adcgs_status status = adcgs_trainer_finish(w->t, &w->last, error);
    adcgs_progress_clear(&w->progress);
    ADCGS_TRY(status);
    adcgs_enc_preview_show(&w->preview, w->t, NULL, &w->progress);
    adcgs_cli_note(cli, "a file of the state after iteration %u of %u", w->t->run.iteration, w->t->config.iterations);
    adcgs_enc_log_last(w);
    adcgs_enc_log_settings(w);
    adcgs_enc_log_decisions(w);
    return ADCGS_OK;
}

/** Remarks that the figures alone do not show. */
static void remark(const adcgs_cli *cli, const adcgs_enc_context *w)
{
    const adcgs_trainer *t = w->t;
    if (t->run.rollbacks)
        adcgs_cli_note(cli, "training began to diverge; it continued from an earlier state, with half the learning rates%s",
                       t->run.rollbacks > 1 ? ", more than once" : "");
    if (adcgs_trainer_is_lost(t))
        adcgs_cli_note(cli, "the training views are rendered with %.1f dB, where a single colour would have %.1f: check %s",
                       w->last.psnr, adcgs_psnr_from_mse(t->rate.contrast * t->rate.contrast), "poses, points and settings");
}

/** Trains, in a team if there is one. The processor time is that of all ranks, except for time from a checkpoint. */
static adcgs_status run(adcgs_enc_context *w, int *stopped, adcgs_error *error)
{
    const double before = w->t->run.elapsed.cpu;
    w->t->team = adcgs_enc_team_of(&w->team);
    adcgs_status status = adcgs_trainer_run(w->t, observe, w, stopped, error);
    double cpu = w->t->run.elapsed.cpu - before;
    if (status == ADCGS_OK && !*stopped)
        status = adcgs_enc_team_sum(&w->team, &cpu, error);
    if (w->t->team)
        w->last.spent.cpu = before + cpu;
    return status;
}

static adcgs_status save_beginning(const adcgs_cli *cli, adcgs_enc_context *w, adcgs_error *error)
{
    char *path;
    ADCGS_TRY(adcgs_enc_save(w, w->o->beginning, 1, &path, error));
    if (strcmp(path, w->o->beginning))
        adcgs_cli_error(cli, ADCGS_OK, "%s could not be written: the state is %s", w->o->beginning, path);
    free(path);
    return ADCGS_OK;
}

/** state: a checkpoint to continue from, or NULL. */
static adcgs_status train(const adcgs_cli *cli, adcgs_enc_context *w, const char *state, adcgs_error *error)
{
    int stopped;
    if (state)
        ADCGS_TRY(adcgs_trainer_load(w->t, state, error));
    if (w->o->beginning && w->t->rate.lambda_used)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: this run is past its beginning", state);
    w->t->rate.until_lambda = w->o->beginning != NULL;
    w->saved = w->t->run.elapsed.clock;
    if (w->o->finish)
        return finish(cli, w, error);
    if (!w->is_live)
        adcgs_interrupt_catch(w->o->output && !w->segments ? 2 : 1);
    const adcgs_status status = run(w, &stopped, error);
    adcgs_progress_clear(&w->progress);
    if (status == ADCGS_OK && adcgs_enc_team_follows(&w->team)) /* another rank reports and saves the state */
        return stopped && adcgs_interrupted() ? adcgs_fail(error, ADCGS_ERR_IO, "interrupted") : ADCGS_OK;
    if (w->last.stage && w->last.iteration + 100 != w->next_log)
        adcgs_enc_log_last(w);
    if (status != ADCGS_OK)
        adcgs_enc_rescue(cli, w, error->status);
    ADCGS_TRY(status);
    if (!stopped) {
        adcgs_enc_preview_show(&w->preview, w->t, NULL, &w->progress);
        remark(cli, w);
        adcgs_enc_log_decisions(w);
        return ADCGS_OK;
    }
    if (w->o->beginning && !adcgs_interrupted())
        return save_beginning(cli, w, error);
    ADCGS_TRY(stop_early(cli, w, error));
    w->cut_short = adcgs_enc_is_ready(w) && adcgs_interrupts() > 1;
    if (w->cut_short)
        return finish(cli, w, error);
    return adcgs_fail(error, ADCGS_ERR_IO, "interrupted; nothing was written to %s", w->target);
}

adcgs_status adcgs_enc_train(adcgs_enc_context *w, const adcgs_enc_job *job, const adcgs_scene *scene, const adcgs_model *before,
                             const adcgs_model *otherwise, const char *state, adcgs_time started, adcgs_error *error)
{
    if (!adcgs_enc_team_follows(&w->team))
        adcgs_progress_show(&w->progress, "start   %u view%s: matching ...", scene->n_views[ADCGS_SPLIT_TRAIN],
                            adcgs_s(scene->n_views[ADCGS_SPLIT_TRAIN]));
    const int is_one_of_many = job->ranks && job->ranks->rank;                               /* the first rank reports for all */
    const int tells = !*job->cli->quiet && !w->is_live && !is_one_of_many && !scene->splats; /* nor live footage, nor splats */
    adcgs_trainer_input input = {.before = before,
                                 .details = job->plan && job->plan->has_details ? &job->plan->details : NULL,
                                 .judges_poses = tells && !w->diagnosed}; /* by the first part of a scene */
    adcgs_enc_keep_images(job, scene);
    ADCGS_TRY(adcgs_trainer_create_from(&w->t, scene, &job->config, &input, job->cpu, job->pool, error));
    if (!before && otherwise && !adcgs_params_equal(&w->t->f->params, &otherwise->params)) {
        adcgs_trainer_free(&w->t);
        input.before = otherwise;
        ADCGS_TRY(adcgs_trainer_create_from(&w->t, scene, &job->config, &input, job->cpu, job->pool, error));
    }
    if (tells) {
        w->t->views.thumbnails = w->thumbnails = adcgs_alloc(NULL, w->t->views.n, sizeof *w->thumbnails, error);
        if (!w->thumbnails)
            return adcgs_alloc_status(error);
    }
    w->told_settings = 0;
    w->begins = scene->whole && job->cuts.n ? job->cuts.at[w->segment] : 0;
    memcpy(w->t->trials, w->trials, sizeof w->trials);
    w->t->quantise = adcgs_encode_quantise_hook;
    w->t->rate.measure = measure;
    w->t->rate.measure_user = w;
    w->t->views.memory = job->o->memory;
    if (job->ranks && !job->o->memory) /* the ranks of a host share it */
        w->t->views.memory = adcgs_image_store_default_memory() / (uint64_t)ADCGS_MAX(job->ranks->local_size, 1);
    w->t->views.loading = loading;
    w->t->views.loading_user = w;
    w->t->run.started = started;
    if (tells)
        ADCGS_TRY(adcgs_enc_report_space(w, error));
    const adcgs_status status = train(job->cli, w, state, error);
    w->interrupts = adcgs_interrupts();
    free_thumbnails(w);
    return status;
}

void adcgs_enc_reduce_large(adcgs_enc_job *job, adcgs_scene *scene, adcgs_progress *progress)
{
    int side = 0;
    for (uint32_t i = 0; i < scene->n_views[ADCGS_SPLIT_TRAIN]; i++) {
        const adcgs_camera *const c = &scene->views[ADCGS_SPLIT_TRAIN][i].camera;
        side = ADCGS_MAX(side, ADCGS_MAX(c->width, c->height));
    }
    if (!adcgs_setting_is_given(job->requested, "scale") && side > ADCGS_SIDE_MOST) {
        adcgs_resolve_size(&job->config, (side + ADCGS_SIDE_MOST - 1) / ADCGS_SIDE_MOST);
        if (progress)
            adcgs_progress_clear(progress);
        adcgs_cli_note(job->cli, "%s: images of %d pixels are reduced to 1/%d of that; --scale 1 keeps their size",
                       scene->directory, side, job->config.scale);
    }
    scene->measured = job->config.scale;
    if (!job->o->has_segment && !job->o->live)
        adcgs_enc_keep_images(job, scene);
}

static int looking(void *user, uint32_t done, uint32_t n)
{
    adcgs_progress_show(user, "light     %6u/%u", done, n);
    return adcgs_interrupted();
}

adcgs_status adcgs_enc_compensate_light(const adcgs_enc_job *job, adcgs_progress *progress, adcgs_error *error)
{
    const adcgs_image_store_config config = {.memory = job->o->memory, .progress = looking, .user = progress};
    adcgs_fault found;
    if (!job->config.exposure_step_compensation)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_light_compensate(job->scene, &found, &config, job->pool, error));
    adcgs_progress_clear(progress);
    if (!job->ranks || !job->ranks->rank)
        adcgs_enc_report_light(job->cli, job->scene, &found);
    return ADCGS_OK;
}
