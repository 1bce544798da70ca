/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Training effort of a live segment. */
#include "config.h"

#include "session/enc_effort.h"

#include "train/resolve.h"

#include <math.h>

/* Origin: chosen by hand, not measured. */
#define LEAST 200   /* minimum iterations */
#define SAFETY 0.85 /* share of the remaining time that is planned */
#define GUARD 0.95  /* share of the remaining time at which the time limit lies */
#define BLIND 2.0   /* seconds that must remain for a segment to be trained by the clock before any speed is known */
#define NEWS 0.4    /* relative change of effort that is reported again */
#define FRAMES 8    /* matched frames of a segment with a delay, without rigid bodies: matching takes as long as much of a run */

void adcgs_enc_effort_init(adcgs_enc_effort *e, adcgs_enc_job *job)
{
    *e = (adcgs_enc_effort){.delay = job->o->has_delay ? job->o->delay : 0, .most = job->config.iterations};
    if (!(e->delay > 0))
        return;
    adcgs_resolve_delay(&job->config, FRAMES);
}

static void say(adcgs_enc_effort *e, const adcgs_enc_job *job, uint32_t number, double left)
{
    const uint32_t n = job->config.iterations, before = e->said ? e->said : e->most;
    if (fabs((double)n - before) <= NEWS * before)
        return;
    e->said = n;
    adcgs_cli_note(job->cli, "segment %u: %u iterations, with %.1f s until it is due", number + 1, n, left);
}

void adcgs_enc_effort_choose(adcgs_enc_effort *e, adcgs_enc_job *job, double came, double seconds, uint32_t number)
{
    const uint32_t least = ADCGS_MIN(LEAST, e->most);
    const double left = came + e->delay - seconds - adcgs_seconds();
    if (!(e->delay > 0))
        return;
    const double n = e->rate > 0 ? e->rate * (SAFETY * left - e->overhead) : left > BLIND ? e->most : 0;
    if (n > least)
        adcgs_resolve_effort(&job->config, (uint32_t)fmin(n, e->most), GUARD * left - e->overhead);
    else
        adcgs_resolve_effort(&job->config, least, 0);
    say(e, job, number, left);
}

void adcgs_enc_effort_train(adcgs_enc_effort *e, const adcgs_train_report *first, const adcgs_train_report *last, double seconds)
{
    const double taken = last->spent.clock - first->spent.clock;
    if (!(taken > 0) || last->iteration <= first->iteration)
        return;
    const double rate = (last->iteration - first->iteration) / taken, overhead = fmax(seconds - last->iteration / rate, 0);
    e->rate = e->rate > 0 ? (e->rate + rate) / 2 : rate;
    e->overhead = e->overhead > 0 ? (e->overhead + overhead) / 2 : overhead;
}
