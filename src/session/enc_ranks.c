/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc as several ranks: rank 0 hands out segments. */
#include "config.h"

#include "session/enc_ranks.h"

#include "base/cpu_detect.h"
#include "session/enc_rank.h"
#include "session/enc_segments.h"
#include "system/interrupt.h"

#include <adcgs/cpu.h>

#include <math.h>
#include <unistd.h>

#ifdef __linux__
#include <sched.h>
#endif

#define SHOWN 6 /* segments in the progress line; chosen by hand, not measured */

typedef enum state { MISSING, BEGUN, FINISHED } state;

typedef struct leader {
    adcgs_enc_context *w;
    const adcgs_enc_job *job;
    const adcgs_ranks *ranks;
    state *states;         /* [segments] */
    adcgs_rank_note *last; /* [ranks] the last note of each, or that it was told to train */
    uint8_t *there;        /* [ranks] it has sent a note */
    uint32_t done;
    adcgs_rank_note final; /* of the last segment */
    adcgs_time *spent;
    adcgs_rank_trainer own;
    adcgs_progress progress;
} leader;

int adcgs_enc_ranks_threads(const adcgs_ranks *r)
{
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    int share = (int)(online / ADCGS_MAX(r->local_size, 1));
#ifdef __linux__
    cpu_set_t mine;
    if (!sched_getaffinity(0, sizeof mine, &mine) && CPU_COUNT(&mine) < online) /* mpirun has assigned some CPUs to it */
        share = CPU_COUNT(&mine);
#endif
    return ADCGS_MAX(share, 1);
}

void adcgs_enc_ranks_dismiss(const adcgs_ranks *ranks)
{
    adcgs_rank_note n;
    memset(&n, 0, sizeof n);
    n.kind = ADCGS_RANK_DISMISS;
    for (int to = 1; to < ranks->size; to++)
        adcgs_ranks_send(ranks, to, &n, sizeof n);
}

/* ---- Distribution of the work ---- */

/** Maximum number of segments that can be trained concurrently: the keys, or the only segment of the scene. */
static uint32_t keys_of(const adcgs_enc_job *job)
{
    uint32_t keys = job->cuts.n < 2;
    for (uint32_t i = 0; job->cuts.n > 1 && i < job->cuts.n; i++)
        keys += !job->follows[i];
    return keys;
}

/** Reports ranks that stay idle and could be used. */
static void report_idle(const adcgs_enc_job *job)
{
    const uint32_t keys = keys_of(job), batch = job->config.batch;
    const int ranks = job->ranks->size, busy = adcgs_enc_team_busy(job->ranks, batch, keys);
    if (busy == ranks)
        return;
    if (job->cuts.n > 1)
        adcgs_cli_note(job->cli,
                       "%u segments, %u of them keys, batch=%u: at most %d of %d ranks work at a time; --key makes "
                       "more, or --set batch=",
                       job->cuts.n, keys, batch, busy, ranks);
    else
        adcgs_cli_note(job->cli,
                       "one segment, batch=%u: at most %d of %d ranks work; --set batch= makes "
                       "more",
                       batch, busy, ranks);
}

adcgs_status adcgs_enc_ranks_gather(adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_error *error)
{
    if (!job->ranks || job->o->finish) /* it trains nothing */
        return ADCGS_OK;
    adcgs_enc_team_form(&w->team, job->ranks, job->config.batch, keys_of(job));
    w->keeps &= !adcgs_enc_team_follows(&w->team);
    return adcgs_enc_team_meet(&w->team, job->cpu, error);
}

/** Reports that rank 0 was interrupted while it waits for a rank of its team, which may have ended. */
static void report_late(void *user, int rank, const char *host)
{
    adcgs_enc_context *w = user;
    const int keeps = !access(w->state, F_OK);
    adcgs_progress_clear(&w->progress);
    adcgs_cli_error(w->progress.cli, ADCGS_OK, "interrupted at iteration %u, waiting for rank %d on %s; %s%s", w->last.iteration,
                    rank, host, keeps ? "continue with the same command and --resume " : "there is no --checkpoint",
                    keeps ? w->state : "");
}

void adcgs_enc_ranks_whole(adcgs_enc_context *w, const adcgs_enc_job *job)
{
    if (!job->ranks || job->o->finish)
        return;
    if (job->ranks->rank) {
        w->on_progress = adcgs_rank_ignore_progress;
        return;
    }
    w->team.late = report_late;
    w->team.late_user = w;
    report_idle(job);
}

/* ---- Handing out ---- */

static int is_free(const leader *l, int rank)
{
    return l->there[rank] && (l->last[rank].kind == ADCGS_RANK_READY || l->last[rank].kind == ADCGS_RANK_DONE);
}

/** Number of segments that can be trained one after the other, from this one on. */
static uint32_t chain(const leader *l, uint32_t segment)
{
    uint32_t n = 1;
    while (segment + n < l->job->cuts.n && l->job->follows[segment + n])
        n++;
    return n;
}

/** The segment to train next; the number of segments if there is none now. */
static uint32_t choose(const leader *l)
{
    uint32_t best = l->job->cuts.n, longest = 0;
    for (uint32_t i = 0; i < l->job->cuts.n; i++)
        if (l->states[i] == MISSING && (!l->job->follows[i] || l->states[i - 1] == FINISHED) && chain(l, i) > longest) {
            best = i;
            longest = chain(l, i);
        }
    return best;
}

static void hand_out(leader *l, int rank, uint32_t segment)
{
    adcgs_rank_note *const n = &l->last[rank];
    l->states[segment] = BEGUN;
    n->kind = ADCGS_RANK_LEARN;
    n->segment = segment;
    n->iteration = 0;
    n->rate = 0;
    if (rank)
        adcgs_ranks_send(l->ranks, rank, n, sizeof *n);
    else
        adcgs_rank_give(&l->own, n);
}

static adcgs_status hear_note(leader *l, int rank, const adcgs_rank_note *n, adcgs_error *error)
{
    l->last[rank] = *n;
    l->there[rank] = 1;
    if (n->kind == ADCGS_RANK_READY && n->level != (int32_t)l->job->cpu)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                          "rank %d on %s has kernels of level %s, rank 0 those of %s, which train "
                          "differently: give "
                          "--cpu",
                          rank, n->host, adcgs_cpu_name((adcgs_cpu_level)n->level), adcgs_cpu_name(l->job->cpu));
    if (n->kind != ADCGS_RANK_DONE)
        return ADCGS_OK;
    l->states[n->segment] = FINISHED;
    l->done++;
    *l->spent = adcgs_time_plus(*l->spent, n->spent);
    if (n->segment + 1 == l->job->cuts.n)
        l->final = *n;
    return ADCGS_OK;
}

static adcgs_status hear_all(leader *l, adcgs_error *error)
{
    int from, is_done;
    adcgs_rank_note n;
    while (adcgs_ranks_take(l->ranks, &from, &n, sizeof n))
        ADCGS_TRY(hear_note(l, from, &n, error));
    const int works = !is_free(l, 0);
    ADCGS_TRY(adcgs_rank_ask(&l->own, &n, &is_done, error));
    if (is_done)
        return hear_note(l, 0, &n, error);
    if (works && n.kind == ADCGS_RANK_TOLD)
        l->last[0] = n;
    return ADCGS_OK;
}

/** One progress line for all ranks. */
static void show(leader *l)
{
    char text[SHOWN * 40 + 8] = "", left[32];
    size_t at = 0;
    double rate = 0, iterations = (double)l->job->config.iterations * (l->job->cuts.n - l->done);
    int n = 0;
    for (int i = 0; i < l->ranks->size; i++) {
        const adcgs_rank_note *const x = &l->last[i];
        if (!l->there[i] || is_free(l, i))
            continue;
        rate += x->rate;
        iterations -= x->iteration;
        if (n++ < SHOWN)
            at += (size_t)snprintf(text + at, sizeof text - at, "  %u: %u/%u", x->segment + 1, x->iteration,
                                   l->job->config.iterations);
    }
    adcgs_progress_show(&l->progress, "segments  %u/%u%s%s  %.0f it/s%s", l->done, l->job->cuts.n, text, n > SHOWN ? "  ..." : "",
                        rate, adcgs_progress_eta(rate > 0 ? fmax(iterations, 0) / rate : (double)NAN, left));
}

/** Reports all ranks with their segments in one line, since the signal's sender has named at most one. */
static void report_stopped(leader *l)
{
    char text[400] = "";
    size_t at = 0;
    for (int i = 0; i < l->ranks->size && at < sizeof text; i++)
        if (l->there[i] && !is_free(l, i))
            at += (size_t)snprintf(text + at, sizeof text - at, "%srank %d on %s at iteration %u of segment %u", at ? ", " : "",
                                   i, l->last[i].host, l->last[i].iteration, l->last[i].segment + 1);
    adcgs_progress_clear(&l->progress);
    adcgs_cli_error(l->job->cli, ADCGS_OK,
                    "stopped, with %u of %u segments done%s%s; continue with the same command and "
                    "--resume %s",
                    l->done, l->job->cuts.n, *text ? ": " : "", text, l->w->base);
}

static adcgs_status lead(leader *l, adcgs_error *error)
{
    while (l->done < l->job->cuts.n) {
        ADCGS_TRY(hear_all(l, error));
        for (int i = 0; i < l->ranks->size; i++) {
            const uint32_t next = is_free(l, i) ? choose(l) : l->job->cuts.n;
            if (next < l->job->cuts.n)
                hand_out(l, i, next);
        }
        show(l);
        if (adcgs_interrupted()) {
            report_stopped(l);
            return adcgs_fail(error, ADCGS_ERR_IO, "interrupted; nothing was written to %s", l->w->target);
        }
        adcgs_rank_nap();
    }
    return ADCGS_OK;
}

/** Finds the segments of an earlier run. */
static adcgs_status find_done(leader *l, adcgs_error *error)
{
    for (uint32_t i = 0; i < l->job->cuts.n; i++) {
        int found = 0;
        ADCGS_TRY(adcgs_enc_segment_find(l->w, l->job, i, &found, error));
        l->states[i] = found ? FINISHED : MISSING;
        l->done += (uint32_t)found;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_enc_ranks_lead(adcgs_enc_context *w, const adcgs_enc_job *job, adcgs_time *spent, adcgs_error *error)
{
    const adcgs_ranks *const ranks = job->ranks;
    leader l = {.w = w, .job = job, .ranks = ranks, .spent = spent, .own = {.w = w, .job = job}};
    adcgs_progress_init(&l.progress, job->cli);
    adcgs_interrupt_catch(1);
    w->segments = job->cuts.n;
    l.states = adcgs_alloc(NULL, job->cuts.n, sizeof *l.states, error);
    l.last = adcgs_alloc(NULL, (size_t)ranks->size, sizeof *l.last, error);
    l.there = adcgs_alloc(NULL, (size_t)ranks->size, sizeof *l.there, error);
    adcgs_status status = l.states && l.last && l.there ? find_done(&l, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        status = adcgs_rank_start(&l.own, error);
    if (status == ADCGS_OK) {
        report_idle(job);
        l.last[0] = adcgs_rank_say(ADCGS_RANK_READY, job);
        l.there[0] = 1;
        status = lead(&l, error);
        adcgs_progress_clear(&l.progress);
        adcgs_rank_end(&l.own);
        if (status == ADCGS_OK && l.final.iterations) {
            w->last.iteration = l.final.iteration;
            w->last.loss = l.final.loss;
            w->last.psnr = l.final.psnr;
        }
    }
    adcgs_free(NULL, l.states);
    adcgs_free(NULL, l.last);
    adcgs_free(NULL, l.there);
    return status;
}
