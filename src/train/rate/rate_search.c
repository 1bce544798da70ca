/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Search for the lambda of a size or a quality. */
#include "train/rate/rate_search.h"

#include "train/rate/rate_control.h"
#include "train/state/checkpoint.h"

#include <math.h>

/*
 * Origin, unless a line states one: chosen by hand, not measured. The search as a whole: doc/log/rate.md, "A target size with one
 * lambda".
 */
#define LOOK_AFTER 0.06   /* fraction of the run from prune_at to the first measurement of bytes */
#define VERDICT_AFTER 0.1 /* fraction of the run from prune_at to the second measurement */
/** Predicted further change of the bytes, relative to the change between the measurements, which grows with lambda. */
#define FALL_AHEAD 1.0
#define NEAR 0.08        /* |log of bytes over room| up to which the controller can take over */
#define LEAP 4.0         /* maximum |log of the factor| from one try's lambda to the next */
#define POWER 0.3        /* bytes vary with about this power of lambda; later tries use the power of the last two */
#define POWER_LEAST 0.1  /* minimum of the power from two tries */
#define POWER_MOST 0.6   /* maximum of the power from two tries */
#define MISSED_POWER 1.0 /* approximate dB lost when lambda grows by a factor of e */
#define MISSED_DOUBT 0.1 /* dB added to a shortfall at the end */
enum { TRIES = 4 };      /* lambdas of a search, the first included */

static double verdict_at(const adcgs_train_config *c)
{
    return (double)c->prune_at + VERDICT_AFTER;
}

int adcgs_rate_is_sought(const adcgs_trainer *t)
{
    const adcgs_train_config *c = &t->config;
    return c->target != ADCGS_TARGET_NONE && t->rate.control.tries < TRIES && !(c->time_limit > 0) && !c->without_rate &&
           verdict_at(c) > (double)c->rate_start && verdict_at(c) < fmin((double)c->quant_round_start, 1);
}

/** Next lambda, by the power that the last two tries show. */
static double next_lambda(const adcgs_trainer *t, double off)
{
    const adcgs_rate_control *s = &t->rate.control;
    double power = POWER;
    if (s->tries)
        power = fmin(fmax((s->off - off) / log(t->rate.lambda / s->tried), POWER_LEAST), POWER_MOST);
    const double wanted = t->rate.lambda * exp(fmin(fmax(off / power, -LEAP), LEAP));
    return adcgs_rate_bounded(t, wanted);
}

static adcgs_status keep_beginning(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_buffer begin;
    adcgs_buffer_init(&begin);
    const adcgs_status status = adcgs_trainer_store(t, &begin, error);
    if (status == ADCGS_OK)
        t->rate.begin = begin;
    else
        adcgs_buffer_clear(&begin);
    return status;
}

adcgs_status adcgs_rate_search_return(adcgs_trainer *t, adcgs_error *error)
{
    const double lambda = t->rate.next_lambda;
    const adcgs_rate_control tried = t->rate.control;
    const adcgs_time elapsed = t->run.elapsed;
    adcgs_buffer begin = t->rate.begin;
    adcgs_buffer_init(&t->rate.begin); /* the restored state contains none */
    const adcgs_status status = adcgs_trainer_restore(t, begin.data, begin.size, error);
    adcgs_buffer_clear(&t->rate.begin);
    t->rate.begin = begin;
    t->rate.control = tried;
    t->run.elapsed = elapsed;
    t->rate.lambda = lambda;
    t->rate.next_lambda = 0;
    return status;
}

adcgs_status adcgs_rate_search_step(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const int is_size = t->config.target == ADCGS_TARGET_SIZE;
    adcgs_rate_control *s = &t->rate.control;
    double off;
    if (progress < (double)t->config.rate_start)
        return ADCGS_OK;
    if (!t->rate.begin.size)
        return keep_beginning(t, error);
    if (progress < (double)t->config.prune_at + LOOK_AFTER || (s->looked && progress < verdict_at(&t->config)))
        return ADCGS_OK;
    ADCGS_TRY(adcgs_rate_measure(t, progress, &off, error));
    if (!s->looked) {
        s->looked = 1;
        s->early = off;
        return ADCGS_OK;
    }
    s->looked = 0;
    s->error = off; /* control starts here; for a quality, much later, when values are rounded */
    s->at = is_size ? progress : 0;
    off += is_size ? FALL_AHEAD * (off - s->early) : 0;
    const double lambda = next_lambda(t, off), tried = t->rate.lambda;
    const int settled = fabs(off) < NEAR || s->tries + 1 == TRIES || lambda == tried;
    s->tries = settled ? TRIES : s->tries + 1;
    s->tried = tried;
    s->off = off;
    if (!settled)
        t->rate.next_lambda = lambda;
    else if (is_size)
        adcgs_buffer_clear(&t->rate.begin);
    return ADCGS_OK;
}

void adcgs_rate_search_end(adcgs_trainer *t, double missing)
{
    adcgs_rate_control *s = &t->rate.control;
    if (missing > 0 && t->rate.begin.size && !s->missed) {
        s->missed = 1;
        s->tries = TRIES - 1;
        t->rate.next_lambda = adcgs_rate_bounded(t, s->tried * exp(-(missing + MISSED_DOUBT) / MISSED_POWER));
    } else
        adcgs_buffer_clear(&t->rate.begin);
}
