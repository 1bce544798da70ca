/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Bytes that are still arriving. */
#include "config.h"

#include "play/feed.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define PIECE_BYTES 65536             /* read at once */
#define BYTES_MAX ((uint64_t)1 << 32) /* of a stream: the same limit as for a played file (dec_play.c) */

struct adcgs_feed {
    adcgs_incoming in; /**< owned by the thread while it runs */
    uint8_t piece[PIECE_BYTES];
    void (*wake)(void *arg);
    void *arg;
    pthread_t thread;
    int running;

    pthread_mutex_t lock; /**< protects the members below */
    uint8_t *data;
    uint64_t bytes, room;
    int ended, leave;
    adcgs_error error; /**< the reason for the end, unless its status is ADCGS_OK */
};

adcgs_status adcgs_feed_open(adcgs_feed **out, const char *path, int (*interrupted)(void), adcgs_error *error)
{
    adcgs_feed *const f = *out = calloc(1, sizeof *f);
    if (!f)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory", path);
    pthread_mutex_init(&f->lock, NULL);
    const adcgs_status status = adcgs_incoming_open(&f->in, path, interrupted, error);
    if (status != ADCGS_OK)
        adcgs_feed_free(out);
    return status;
}

void adcgs_feed_free(adcgs_feed **feed)
{
    adcgs_feed *const f = *feed;
    *feed = NULL;
    if (!f)
        return;
    adcgs_feed_stop(f);
    adcgs_incoming_close(&f->in);
    pthread_mutex_destroy(&f->lock);
    free(f->data);
    free(f);
}

/** Call it with the lock held. */
static adcgs_status append(adcgs_feed *f, size_t n)
{
    if (f->bytes + n > BYTES_MAX)
        return adcgs_fail(&f->error, ADCGS_ERR_LIMIT, "%.160s: more than %llu bytes, the player's limit for a stream", f->in.name,
                          (unsigned long long)BYTES_MAX);
    if (f->bytes + n > f->room) {
        const uint64_t room = ADCGS_MAX(2 * f->room, f->bytes + n);
        uint8_t *const data = room <= SIZE_MAX ? realloc(f->data, (size_t)room) : NULL;
        if (!data)
            return adcgs_fail(&f->error, ADCGS_ERR_MEMORY, "%.160s: out of memory for %llu bytes", f->in.name,
                              (unsigned long long)room);
        f->data = data;
        f->room = room;
    }
    memcpy(f->data + f->bytes, f->piece, n);
    f->bytes += n;
    return ADCGS_OK;
}

/** Waits for bytes and keeps them. \return nonzero if anything has changed */
static int take_bytes(adcgs_feed *f)
{
    adcgs_error error = {.status = ADCGS_OK};
    size_t got;
    adcgs_status status = adcgs_incoming_read(&f->in, f->piece, sizeof f->piece, &got, &error);
    pthread_mutex_lock(&f->lock);
    if (status != ADCGS_OK)
        f->error = error;
    else if (got > 0)
        status = append(f, got);
    f->ended = status != ADCGS_OK || f->in.ended;
    const int changed = got > 0 || f->ended;
    pthread_mutex_unlock(&f->lock);
    return changed;
}

void adcgs_feed_wait(adcgs_feed *f)
{
    if (!f->ended)
        take_bytes(f);
}

static int goes_on(adcgs_feed *f)
{
    pthread_mutex_lock(&f->lock);
    const int goes = !f->ended && !f->leave;
    pthread_mutex_unlock(&f->lock);
    return goes;
}

static void *read_on(void *arg)
{
    adcgs_feed *const f = arg;
    while (goes_on(f))
        if (take_bytes(f))
            f->wake(f->arg);
    return NULL;
}

/** The thread with the window receives the signals. */
adcgs_status adcgs_feed_start(adcgs_feed *f, void (*wake)(void *arg), void *arg, adcgs_error *error)
{
    sigset_t all, before;
    f->wake = wake;
    f->arg = arg;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    f->running = !pthread_create(&f->thread, NULL, read_on, f);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return f->running ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "cannot start a thread for %.160s", f->in.name);
}

void adcgs_feed_stop(adcgs_feed *f)
{
    if (!f->running)
        return;
    pthread_mutex_lock(&f->lock);
    f->leave = 1;
    pthread_mutex_unlock(&f->lock);
    pthread_join(f->thread, NULL);
    f->running = f->leave = 0;
}

uint64_t adcgs_feed_bytes(adcgs_feed *f, int *ended)
{
    pthread_mutex_lock(&f->lock);
    const uint64_t bytes = f->bytes;
    *ended = f->ended;
    pthread_mutex_unlock(&f->lock);
    return bytes;
}

size_t adcgs_feed_copy(adcgs_feed *f, uint64_t at, void *to, size_t n)
{
    pthread_mutex_lock(&f->lock);
    const size_t some = (size_t)ADCGS_MIN((uint64_t)n, f->bytes - at);
    if (some > 0)
        memcpy(to, f->data + at, some);
    pthread_mutex_unlock(&f->lock);
    return some;
}

adcgs_status adcgs_feed_status(adcgs_feed *f, adcgs_error *error)
{
    pthread_mutex_lock(&f->lock);
    const adcgs_status status = f->error.status;
    if (status != ADCGS_OK)
        *error = f->error;
    pthread_mutex_unlock(&f->lock);
    return status;
}

const char *adcgs_feed_name(const adcgs_feed *f)
{
    return f->in.name;
}
