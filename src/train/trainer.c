/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The training loop: stages, steps, reports, and rollback. */
#include "train/trainer.h"

#include "base/digest.h"
#include "metric/metric.h"
#include "train/rate/rate_search.h"
#include "train/stage_table.h"
#include "train/stages.h"
#include "train/step.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    SNAPSHOT_EVERY = 500, /* iterations between snapshots for a rollback */
    CHECK_EVERY = 10,     /* iterations between checks for NaN and infinity */
    REPORT_EVERY = 10,    /* iterations between reports */
    AGREE_EVERY = 100,    /* iterations between comparisons of a team's models */
    ROLLBACKS_MAX = 4,    /* maximum number of rollbacks of a run */
    MEANS_AFTER = 100     /* iterations after which the running means are meaningful */
};
/* Chosen by hand, not measured; runs of the presets do not come near them. */
static const double
    LOST_BY = 2,      /* ratio of the RMS error to the images' standard deviation, which is the error of one colour for all */
    LOST_LEAST = 0.1, /* minimum of that deviation, since images of one colour have none */
    BLOWN_BY = 4;     /* ratio of the squared error to its minimum so far */
/* Mean loss above which a run has diverged: that of images alone is at most about 1; chosen by hand, not measured. */
#define LOSS_MOST 4

/** True if every parameter is finite. A splat with a NaN vanishes from the renders, so the loss alone does not reveal it. */
static int is_finite(const adcgs_trainer *t)
{
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        const adcgs_param *p = &t->f->param[i];
        int bad = 0;
        for (size_t j = 0; j < p->n; j++)
            bad |= (adcgs_float_bits(p->p[j]) & 0x7f800000) == 0x7f800000;
        if (bad)
            return 0;
    }
    return 1;
}

/** Checksum of the model, to compare the runs of a team. */
static uint32_t sum_up(const adcgs_trainer *t)
{
    uint32_t crc = adcgs_crc32c(t->run.iteration, &t->f->n, sizeof t->f->n);
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        crc = adcgs_crc32c(crc, t->f->param[i].p, t->f->param[i].n * sizeof(float));
    return crc;
}

/** Compares the runs of a team. Parameters are not sent, so a run that computes differently would spoil the training of all. */
static adcgs_status agree(adcgs_trainer *t, adcgs_error *error)
{
    uint32_t sums[ADCGS_TREE_MOST];
    if (!t->team)
        return ADCGS_OK;
    sums[t->team->rank] = sum_up(t);
    ADCGS_TRY(adcgs_team_gather_each(t->team, sums, sizeof *sums, error));
    for (int r = 1; r < t->team->size; r++)
        if (sums[r] != sums[0]) {
            t->run.torn = 1; /* it is unknown whose state is right */
            return adcgs_fail(error, ADCGS_ERR_DATA,
                              "at iteration %u run %d of the %d that train together has a different model "
                              "from the first: expected the same programs, libraries, images and checkpoints",
                              t->run.iteration, r + 1, t->team->size);
        }
    return ADCGS_OK;
}

static adcgs_status take_snapshot(adcgs_trainer *t, adcgs_error *error)
{
    t->run.snapshot.size = 0;
    t->run.snapshot_at = t->run.iteration;
    return adcgs_trainer_store(t, &t->run.snapshot, error);
}

int adcgs_trainer_is_lost(const adcgs_trainer *t)
{
    const double off = LOST_BY * fmax(t->rate.contrast, LOST_LEAST);
    return t->run.mean_mse > off * off;
}

/**
 * True if steps were too long and the trained images are lost. Without visible primitives there are no gradients, so only an
 * earlier state helps. At the start the means cover too few images.
 */
static int is_blown(const adcgs_trainer *t)
{
    return t->run.iteration >= MEANS_AFTER && t->run.mean_mse > BLOWN_BY * t->run.least_mse && adcgs_trainer_is_lost(t);
}

/** After NaN, infinity or a sharp rise of the loss: restores the last good state and halves the steps. */
static adcgs_status guard(adcgs_trainer *t, double before, adcgs_error *error)
{
    const double progress = adcgs_trainer_progress(t);
    /* Also before values derived from the parameters are fixed: at the end, and at a change of stage. */
    const int due = t->run.iteration % CHECK_EVERY == 0 || progress >= 1 ||
                    adcgs_train_stage(&t->config, progress) != adcgs_train_stage(&t->config, before);
    if (isfinite(t->run.mean_loss) && t->run.mean_loss <= LOSS_MOST && !is_blown(t) && (!due || is_finite(t)))
        return t->run.iteration % SNAPSHOT_EVERY == 0 ? take_snapshot(t, error) : ADCGS_OK;
    t->run.torn = 1;
    const uint32_t rollbacks = t->run.rollbacks + 1;
    const float lr = t->run.lr_scale * 0.5f;
    t->run.diverged = rollbacks > ROLLBACKS_MAX;
    if (t->run.diverged)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "training diverged at iteration %u (loss %g) after %u rollbacks: check poses, exposure and settings",
                          t->run.iteration, t->run.mean_loss, t->run.rollbacks);
    ADCGS_TRY(adcgs_trainer_restore(t, t->run.snapshot.data, t->run.snapshot.size, error));
    if (!t->run.iteration)
        t->views.divide = 0; /* contrast and black levels are measured again */
    t->run.rollbacks = rollbacks;
    t->run.lr_scale = lr;
    return ADCGS_OK;
}

static void fill_report(const adcgs_trainer *t, double progress, double rate, adcgs_train_report *r)
{
    r->stage = adcgs_train_stage(&t->config, progress);
    r->iteration = t->run.iteration;
    r->iterations = t->config.iterations;
    r->anchors = t->f->n;
    r->divide = t->views.divide ? t->views.divide : adcgs_stages_divide(t, progress);
    r->loss = t->run.mean_loss;
    r->psnr = adcgs_psnr_from_mse(t->run.mean_mse);
    r->bytes = 0;
    for (int i = 0; i < ADCGS_GROUPS; i++)
        r->bytes += r->stream[i] = t->rate.mean_bits[i] / 8;
    r->lambda = t->rate.lambda;
    r->spent = t->run.elapsed;
    r->rate = rate;
    r->left = adcgs_time_left_of(&t->run.left, &t->config, t->run.iteration, t->run.elapsed.clock);
    r->rollbacks = (int)t->run.rollbacks;
    r->attempt = t->rate.begin.size && adcgs_rate_is_sought(t) ? (int)t->rate.control.tries + 1 : 0;
}

/** Start of this program, moved back by the time that the run has already taken. */
static adcgs_time begin_of(const adcgs_trainer *t)
{
    return adcgs_time_less(fabs(t->run.started.clock) > 0 ? t->run.started : adcgs_time_now(), t->run.elapsed);
}

adcgs_status adcgs_trainer_finish(adcgs_trainer *t, adcgs_train_report *report, adcgs_error *error)
{
    const adcgs_time begin = begin_of(t);
    if (!t->run.iteration)
        return adcgs_fail(error, ADCGS_ERR_DATA, "no file to write: the run is before its first iteration");
    if (!is_finite(t))
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "no file to write: training has diverged at iteration %u; continue the run, "
                          "which then rolls back",
                          t->run.iteration);
    adcgs_trainer_prepare_networks(t);
    ADCGS_TRY(adcgs_stages_skip(t, error));
    ADCGS_TRY(adcgs_stages_finish(t, error));
    t->run.elapsed = adcgs_time_less(adcgs_time_now(), begin);
    fill_report(t, 1, 0, report);
    return ADCGS_OK;
}

int adcgs_trainer_moves(const adcgs_trainer *t)
{
    return t->f->follows || t->stereo.n_bodies || t->scene->n_times < 2 ||
           adcgs_stage_begin(&t->config, ADCGS_STAGE_COARSE) >= 1 || (t->config.without_coarse && t->config.without_fine) ||
           adcgs_stage_has_begun(&t->config, ADCGS_STAGE_COARSE, adcgs_trainer_progress(t));
}

/** Updates the elapsed time. With a time limit all runs of a team use the time of rank 0, so that progress is the same. */
static adcgs_status take_time(adcgs_trainer *t, adcgs_time begin, adcgs_error *error)
{
    t->run.elapsed = adcgs_time_less(adcgs_time_now(), begin);
    return t->config.time_limit > 0 ? adcgs_team_broadcast(t->team, &t->run.elapsed, sizeof t->run.elapsed, error) : ADCGS_OK;
}

typedef struct reports {
    adcgs_train_observe observe;
    void *user;
    double last, rate; /* time of the last report, and iterations per second */
    uint32_t iteration;
} reports;

/** Reports progress. *stops: rank 0 decides for all. */
static adcgs_status tell(const adcgs_trainer *t, reports *r, double progress, int *stops, adcgs_error *error)
{
    const double at = adcgs_seconds();
    const double lately =
        at > r->last && t->run.iteration > r->iteration ? (t->run.iteration - r->iteration) / (at - r->last) : r->rate;
    adcgs_train_report report;
    r->rate = r->rate > 0 ? 0.9 * r->rate + 0.1 * lately : lately;
    r->iteration = t->run.iteration;
    r->last = at;
    fill_report(t, progress, r->rate, &report);
    *stops = r->observe && r->observe(r->user, &report);
    return adcgs_team_broadcast(t->team, stops, sizeof *stops, error);
}

/** Finishes the run. The end must not be applied twice: if it, or writing its result, fails, the state before it is saved. */
static adcgs_status end(adcgs_trainer *t, adcgs_error *error)
{
    ADCGS_TRY(take_snapshot(t, error));
    t->run.torn = 1;
    return adcgs_stages_finish(t, error);
}

adcgs_status adcgs_trainer_run(adcgs_trainer *t, adcgs_train_observe observe, void *user, int *stopped, adcgs_error *error)
{
    const adcgs_time begin = begin_of(t);
    reports r = {observe, user, adcgs_seconds(), 0, t->run.iteration};
    *stopped = 0;
    adcgs_trainer_prepare_networks(t);
    ADCGS_TRY(take_snapshot(t, error));
    ADCGS_TRY(agree(t, error));
    for (;;) {
        t->run.torn = 0;
        ADCGS_TRY(take_time(t, begin, error));
        const double progress = adcgs_trainer_progress(t);
        if (progress >= 1 && !t->run.iteration)
            return adcgs_fail(error, ADCGS_ERR_USAGE,
                              "the time limit of %g s ended after %.1f s, before training began: "
                              "it includes reading the scene",
                              t->config.time_limit, t->run.elapsed.clock);
        if (t->run.iteration % REPORT_EVERY == 0 || progress >= 1) {
            int stops;
            ADCGS_TRY(tell(t, &r, progress, &stops, error));
            if (stops && progress < 1) {
                *stopped = 1;
                return ADCGS_OK;
            }
        }
        if (progress >= 1)
            return end(t, error);
        if (t->rate.until_lambda && progress >= adcgs_train_lambda_from(&t->config)) {
            *stopped = 1;
            return ADCGS_OK;
        }
        ADCGS_TRY(adcgs_stages_before(t, progress, error));
        if (t->rate.next_lambda > 0) { /* another try from an earlier state, which is then the last good one */
            t->run.torn = 1;
            ADCGS_TRY(adcgs_rate_search_return(t, error));
            ADCGS_TRY(take_time(t, begin, error));
            ADCGS_TRY(take_snapshot(t, error));
            continue;
        }
        ADCGS_TRY(take_time(t, begin, error));
        if (adcgs_trainer_progress(t) >= 1) /* loading images or changing anchors used up the time */
            continue;
        ADCGS_TRY(adcgs_train_step(t, progress, error));
        adcgs_time_left_add(&t->run.left, t->views.divide / t->config.scale,
                            adcgs_seconds() - begin.clock - t->run.elapsed.clock);
        ADCGS_TRY(take_time(t, begin, error));
        if (t->run.iteration % AGREE_EVERY == 0 || adcgs_trainer_progress(t) >= 1)
            ADCGS_TRY(agree(t, error));
        ADCGS_TRY(guard(t, progress, error));
    }
}
