/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A thread that looks for footage. */
#include "config.h"

#include "scene/live/live_watch.h"

#include "system/paths.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define LOOK_EVERY 20     /* milliseconds, while nothing arrives */
#define AHEAD 3           /* stretches that are read ahead: one more than a camera may be behind another */
#define NEAR 1e-3         /* of a frame interval: a stream's rounding moves times by less */
#define STRETCHES_MAX 1e9 /* stretches of a stream, at most; a uint32_t counts them */
#define HALF (0.5 + 1e-9) /* of a frame interval: among two equally near frames the first is taken; arithmetic */

/* ---- Time ---- */

double adcgs_live_within(const adcgs_live_watch *l)
{
    return ADCGS_TIME_TOLERANCE * l->seconds;
}

/** Seconds between frames of the camera with the highest rate. */
static double find_interval(const adcgs_live_watch *l)
{
    double rate = 0;
    for (uint32_t i = 0; i < l->n; i++)
        rate = fmax(rate, adcgs_fps_value(l->cameras[i].rate));
    return 1 / rate;
}

/** Length of a stretch in seconds. */
static double length(const adcgs_live_watch *l)
{
    return fmax(l->seconds, find_interval(l));
}

double adcgs_live_cut(const adcgs_live_watch *l, uint32_t stretch)
{
    const double time = stretch * length(l);
    double best = INFINITY;
    for (uint32_t i = 0; stretch && i < l->n; i++) {
        const adcgs_live_camera *c = &l->cameras[i];
        const double frame = ceil((time - c->offset) * adcgs_fps_value(c->rate) - HALF);
        const double at = adcgs_live_camera_time(c, frame > 0 ? (int64_t)frame : 0), nearer = fabs(at - time) - fabs(best - time);
        if (!(nearer > -adcgs_live_within(l)) || (nearer < adcgs_live_within(l) && at < best))
            best = at;
    }
    return stretch ? best : 0;
}

uint32_t adcgs_live_stretch(void *user, double time)
{
    const adcgs_live_watch *l = user;
    uint32_t i = (uint32_t)fmax(0, time / length(l) - 2); /* cuts are within a frame of the multiples */
    while (i > 0 && adcgs_live_cut(l, i) + adcgs_live_within(l) >= time)
        i--;
    while (time > adcgs_live_cut(l, i + 1) + adcgs_live_within(l))
        i++;
    return i;
}

void adcgs_live_frames(const adcgs_live_watch *l, const adcgs_live_camera *c, uint32_t stretch, int64_t span[2])
{
    span[0] = adcgs_live_camera_from(c, adcgs_live_cut(l, stretch), adcgs_live_within(l));
    span[1] = adcgs_live_camera_from(c, adcgs_live_cut(l, stretch + 1), -adcgs_live_within(l));
}

/* ---- Continuing a stream ---- */

/**
 * The first stretch to give when the stream's last segment has the watch's span: the next one. If that segment ended in the
 * middle of a stretch, and began where the stretch begins, this stretch is given again.
 */
static uint32_t first_stretch(adcgs_live_watch *l)
{
    const double slack = fmax(2 * adcgs_live_within(l), NEAR * find_interval(l));
    const uint32_t i = adcgs_live_stretch(l, l->span[1] + slack);
    const double begin = adcgs_live_cut(l, i);
    return begin < l->span[1] - slack && fabs(begin - l->span[0]) > slack ? i + 1 : i;
}

int64_t adcgs_live_first_of_file(const adcgs_live_watch *l, const adcgs_live_camera *c, uint32_t stretch)
{
    return stretch ? adcgs_live_camera_from(c, adcgs_live_cut(l, stretch), -adcgs_live_within(l)) : 0;
}

/** Skips all earlier footage; of a video, only whole files are skipped. */
static adcgs_status pass_over(adcgs_live_watch *l, adcgs_error *error)
{
    if (!(l->span[1] <= STRETCHES_MAX * l->seconds))
        return adcgs_fail(error, ADCGS_ERR_DATA, "the stream ends at %g s: expected at most %g segments of %g s", l->span[1],
                          STRETCHES_MAX, l->seconds);
    const uint32_t first = first_stretch(l);
    l->is_placed = 1;
    l->taken = l->n_complete = l->n_passed = first;
    for (uint32_t i = 0; i < l->n; i++) {
        adcgs_live_camera *c = &l->cameras[i];
        int64_t span[2];
        adcgs_live_frames(l, c, first, span);
        if (c->is_pipe)
            return adcgs_fail(error, ADCGS_ERR_USAGE,
                              "%s: a pipe cannot repeat footage: continue a stream from image or "
                              "video files",
                              c->source->video);
        adcgs_live_camera_pass_over(c, c->source->video ? adcgs_live_first_of_file(l, c, first ? first - 1 : 0) : span[0]);
    }
    return ADCGS_OK;
}

/* ---- The thread that looks for more ---- */

static int know_rates(const adcgs_live_watch *l)
{
    for (uint32_t i = 0; i < l->n; i++)
        if (!l->cameras[i].rate.den)
            return 0;
    return 1;
}

/** Reads the first lines of videos. */
static adcgs_status begin_all(adcgs_live_watch *l, adcgs_error *error)
{
    for (uint32_t i = 0; i < l->n; i++) {
        ADCGS_TRY(adcgs_live_camera_begin(&l->cameras[i], error));
        if (l->cameras[i].is_over && !l->cameras[i].rate.den)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: ends within its first line", l->sources[i].video);
    }
    return ADCGS_OK;
}

/** Time of the latest available frame of any camera. */
static double find_latest(const adcgs_live_watch *l)
{
    double latest = -INFINITY;
    for (uint32_t i = 0; i < l->n; i++) {
        const adcgs_live_camera *c = &l->cameras[i];
        int64_t frame = c->next - 1;
        while (frame >= c->base && !adcgs_live_camera_has(c, frame))
            frame--;
        if (frame >= c->base)
            latest = fmax(latest, adcgs_live_camera_time(c, frame));
    }
    return latest;
}

adcgs_live_limits adcgs_live_limits_of(adcgs_live_watch *l, uint32_t camera)
{
    return (adcgs_live_limits){.folder = l->folder, .index = camera, .stretch = adcgs_live_stretch, .user = l};
}

/** Lets each camera decide a frame, if it can. */
static adcgs_status look_at_all(adcgs_live_watch *l, int is_end, int *progress, adcgs_error *error)
{
    const double until = l->unbounded ? INFINITY : adcgs_live_cut(l, l->taken + AHEAD) + adcgs_live_within(l);
    for (uint32_t i = 0; i < l->n; i++) {
        adcgs_live_limits limits = adcgs_live_limits_of(l, i);
        l->last = fmax(l->last, find_latest(l));
        limits.until = until;
        limits.given_up = l->last - l->seconds - adcgs_live_within(l);
        limits.is_end = is_end;
        ADCGS_TRY(adcgs_live_camera_look(&l->cameras[i], &limits, progress, error));
    }
    l->last = fmax(l->last, find_latest(l));
    return ADCGS_OK;
}

static int is_complete(const adcgs_live_watch *l, uint32_t stretch)
{
    for (uint32_t i = 0; i < l->n; i++) {
        int64_t span[2];
        adcgs_live_frames(l, &l->cameras[i], stretch, span);
        if (!l->cameras[i].is_over && l->cameras[i].next < span[1])
            return 0;
    }
    return 1;
}

/** Records the segments that are complete now. */
static adcgs_status note_complete(adcgs_live_watch *l, adcgs_error *error)
{
    while (l->last > adcgs_live_cut(l, l->n_complete) + adcgs_live_within(l) && is_complete(l, l->n_complete)) {
        const uint32_t n = l->n_complete - l->n_passed;
        double *came = realloc(l->came, (n + 1) * sizeof *came);
        if (!came)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a segment");
        l->came = came;
        came[n] = adcgs_seconds();
        l->n_complete++;
        pthread_cond_broadcast(&l->changed);
    }
    return ADCGS_OK;
}

static adcgs_status poll_cameras(adcgs_live_watch *l, int *progress, adcgs_error *error)
{
    const int stops = l->interrupted() != 0;
    const int is_end = stops || adcgs_is_there(l->end_path); /* checked before the last footage is looked for */
    ADCGS_TRY(begin_all(l, error));
    if (!know_rates(l)) {
        l->is_over = is_end;
        return ADCGS_OK;
    }
    if (l->goes_on && !l->is_placed)
        ADCGS_TRY(pass_over(l, error));
    if (!stops)
        ADCGS_TRY(look_at_all(l, is_end, progress, error));
    l->is_over = 1;
    for (uint32_t i = 0; i < l->n; i++) {
        l->cameras[i].is_over |= stops;
        l->is_over &= l->cameras[i].is_over;
    }
    return note_complete(l, error);
}

/** Sleeps for a while, or until an empty pipe has data. */
static void rest(adcgs_live_watch *l)
{
    nfds_t n = 0;
    for (uint32_t i = 0; i < l->n; i++)
        if (l->cameras[i].waits && l->cameras[i].has_begun && l->cameras[i].is_pipe && !l->cameras[i].is_over)
            l->pipes[n++] = (struct pollfd){.fd = l->cameras[i].fd, .events = POLLIN};
    poll(l->pipes, n, LOOK_EVERY);
}

static void *run(void *user)
{
    adcgs_live_watch *l = user;
    for (int on = 1; on;) {
        int progress = 0;
        pthread_mutex_lock(&l->lock);
        l->error.status = poll_cameras(l, &progress, &l->error);
        on = !l->stop && !l->is_over && l->error.status == ADCGS_OK;
        if (!on)
            pthread_cond_broadcast(&l->changed);
        const int wanted = l->wanted;
        pthread_mutex_unlock(&l->lock);
        if (on && wanted) /* a mutex is not fair, so let the waiting thread have it */
            poll(NULL, 0, 1);
        else if (on && !progress)
            rest(l);
    }
    return NULL;
}

adcgs_status adcgs_live_watch_start(adcgs_live_watch *l, adcgs_error *error)
{
    l->last = -INFINITY;
    l->pipes = calloc(l->n, sizeof *l->pipes);
    if (!l->pipes)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for cameras");
    pthread_mutex_init(&l->lock, NULL);
    pthread_cond_init(&l->changed, NULL);
    l->has_thread = !pthread_create(&l->thread, NULL, run, l);
    if (l->has_thread)
        return ADCGS_OK;
    pthread_mutex_destroy(&l->lock);
    pthread_cond_destroy(&l->changed);
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "cannot start a thread that looks for footage");
}

void adcgs_live_watch_stop(adcgs_live_watch *l)
{
    if (l->has_thread) {
        adcgs_live_lock(l);
        l->stop = 1;
        pthread_mutex_unlock(&l->lock);
        pthread_join(l->thread, NULL);
        pthread_mutex_destroy(&l->lock);
        pthread_cond_destroy(&l->changed);
    }
    free(l->pipes);
    free(l->came);
}

void adcgs_live_lock(adcgs_live_watch *l)
{
    atomic_fetch_add(&l->wanted, 1);
    pthread_mutex_lock(&l->lock);
    atomic_fetch_sub(&l->wanted, 1);
}

adcgs_status adcgs_live_await(adcgs_live_watch *l, adcgs_error *error)
{
    while (l->taken == l->n_complete && !l->is_over && l->error.status == ADCGS_OK)
        pthread_cond_wait(&l->changed, &l->lock);
    if (l->taken < l->n_complete || l->error.status == ADCGS_OK)
        return ADCGS_OK;
    *error = l->error;
    return error->status;
}
