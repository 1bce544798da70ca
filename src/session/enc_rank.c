/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One of the ranks of adcgs-enc. */
#include "config.h"

#include "session/enc_rank.h"

#include "session/enc_segments.h"
#include "system/interrupt.h"

#include <time.h>

#define NAP 10000000L  /* nanoseconds between looks for a message; chosen by hand, not measured */
#define TELL_EVERY 0.5 /* seconds between two progress notes of a segment; chosen by hand, not measured */

adcgs_rank_note adcgs_rank_say(int kind, const adcgs_enc_job *job)
{
    adcgs_rank_note n;
    memset(&n, 0, sizeof n); /* includes padding: the whole struct is sent */
    n.kind = kind;
    n.level = (int32_t)job->cpu;
    memcpy(n.host, job->ranks->host, sizeof n.host);
    return n;
}

void adcgs_rank_nap(void)
{
    const struct timespec nap = {0, NAP};
    nanosleep(&nap, NULL);
}

adcgs_status adcgs_rank_fail(const adcgs_enc_job *job, adcgs_error *error)
{
    const adcgs_error why = *error;
    return adcgs_fail(error, why.status, "rank %d on %s: %.160s", job->ranks->rank, job->ranks->host, why.text);
}

static void take_report(adcgs_rank_note *n, const adcgs_enc_context *w)
{
    n->segment = w->segment;
    n->iteration = w->last.iteration;
    n->iterations = w->last.iterations;
    n->rate = w->last.rate;
    n->loss = w->last.loss;
    n->psnr = w->last.psnr;
}

/** Trains the note's segment. The first rank of a team informs the others. A failure names the rank and its segment. */
static adcgs_status learn(adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_rank_note *n, adcgs_error *error)
{
    n->spent = (adcgs_time){0, 0};
    n->kind = ADCGS_RANK_LEARN;
    for (int r = 1; !w->team.team.rank && r < w->team.team.size; r++)
        adcgs_ranks_send(job->ranks, w->team.first + r, n, sizeof *n);
    adcgs_status status = adcgs_enc_segment_begin(w, n->segment, error);
    if (status == ADCGS_OK)
        status = adcgs_enc_segment_train(w, job, &n->spent, error);
    take_report(n, w);
    n->kind = ADCGS_RANK_DONE;
    const adcgs_error why = *error;
    return status == ADCGS_OK ? status
                              : adcgs_fail(error, status, "rank %d on %s, segment %u: %.160s", job->ranks->rank, job->ranks->host,
                                           n->segment + 1, why.text);
}

/* ---- Ranks after rank 0 ---- */

typedef struct follower {
    const adcgs_ranks *ranks;
    adcgs_rank_note last;
    double told; /* time of the last progress note */
} follower;

static int tell(void *user, const adcgs_enc_context *w)
{
    follower *f = user;
    const double now = adcgs_seconds();
    if (now - f->told < TELL_EVERY)
        return 0;
    f->told = now;
    f->last.kind = ADCGS_RANK_TOLD;
    take_report(&f->last, w);
    adcgs_ranks_send(f->ranks, 0, &f->last, sizeof f->last);
    return 0;
}

int adcgs_rank_ignore_progress(void *user, const adcgs_enc_context *w)
{
    (void)user;
    (void)w;
    return 0;
}

adcgs_status adcgs_rank_follow(adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_error *error)
{
    const int leads = !w->team.team.rank && w->team.team.size; /* a team, or trains alone */
    follower f = {.ranks = job->ranks, .last = adcgs_rank_say(ADCGS_RANK_READY, job)};
    w->on_progress = leads ? tell : adcgs_rank_ignore_progress;
    w->progress_user = &f;
    w->segments = job->cuts.n;
    adcgs_interrupt_catch(1);
    if (leads)
        adcgs_ranks_send(job->ranks, 0, &f.last, sizeof f.last);
    for (;;) {
        int from;
        adcgs_rank_note asked;
        if (adcgs_interrupted())
            return adcgs_fail(error, ADCGS_ERR_IO, "rank %d on %s: interrupted", job->ranks->rank, job->ranks->host);
        if (!adcgs_ranks_take(job->ranks, &from, &asked, sizeof asked)) {
            adcgs_rank_nap();
            continue;
        }
        if (asked.kind == ADCGS_RANK_DISMISS)
            return ADCGS_OK;
        f.last.segment = asked.segment;
        ADCGS_TRY(learn(w, job, &f.last, error));
        if (leads)
            adcgs_ranks_send(job->ranks, 0, &f.last, sizeof f.last);
    }
}

/* ---- Training in rank 0, next to handing out ---- */

static int on_progress(void *user, const adcgs_enc_context *w)
{
    adcgs_rank_trainer *l = user;
    pthread_mutex_lock(&l->lock);
    l->last.kind = ADCGS_RANK_TOLD;
    take_report(&l->last, w);
    const int ends = l->ends;
    pthread_mutex_unlock(&l->lock);
    return ends;
}

static void *run_learner(void *user)
{
    adcgs_rank_trainer *l = user;
    pthread_mutex_lock(&l->lock);
    for (;;) {
        while (!l->asked && !l->ends)
            pthread_cond_wait(&l->wake, &l->lock);
        if (!l->asked)
            break;
        adcgs_rank_note n = l->last;
        l->asked = 0;
        pthread_mutex_unlock(&l->lock);
        const adcgs_status status = learn(l->w, l->job, &n, &l->error);
        pthread_mutex_lock(&l->lock);
        l->last = n;
        l->status = status;
        l->answered = 1;
    }
    pthread_mutex_unlock(&l->lock);
    return NULL;
}

adcgs_status adcgs_rank_start(adcgs_rank_trainer *l, adcgs_error *error)
{
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->wake, NULL);
    l->w->on_progress = on_progress;
    l->w->progress_user = l;
    if (!pthread_create(&l->thread, NULL, run_learner, l))
        return ADCGS_OK;
    pthread_mutex_destroy(&l->lock);
    pthread_cond_destroy(&l->wake);
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "cannot start a thread for training");
}

void adcgs_rank_give(adcgs_rank_trainer *l, const adcgs_rank_note *n)
{
    pthread_mutex_lock(&l->lock);
    l->last = *n;
    l->asked = 1;
    pthread_cond_signal(&l->wake);
    pthread_mutex_unlock(&l->lock);
}

adcgs_status adcgs_rank_ask(adcgs_rank_trainer *l, adcgs_rank_note *n, int *is_done, adcgs_error *error)
{
    pthread_mutex_lock(&l->lock);
    *n = l->last;
    *is_done = l->answered;
    l->answered = 0;
    pthread_mutex_unlock(&l->lock);
    if (!*is_done || l->status == ADCGS_OK)
        return ADCGS_OK;
    *error = l->error;
    return l->status;
}

void adcgs_rank_end(adcgs_rank_trainer *l)
{
    pthread_mutex_lock(&l->lock);
    l->ends = 1;
    pthread_cond_signal(&l->wake);
    pthread_mutex_unlock(&l->lock);
    pthread_join(l->thread, NULL);
    pthread_mutex_destroy(&l->lock);
    pthread_cond_destroy(&l->wake);
    l->w->on_progress = NULL;
}
