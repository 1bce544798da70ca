/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Progress: a line that rewrites itself, or occasional lines, which a thread
 * repeats while long work reports none.
 */
#include "config.h"

#include "cli/cli.h"

#include "system/text.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define TERMINAL_EVERY 0.1 /* seconds between two updates on a terminal */
#define LINES_FIRST 5.0    /* seconds to the first line without a terminal; each further interval is doubled */
#define LINES_MOST 25.0    /* upper bound of the seconds between two lines */
#define PULSE_AFTER 5.0    /* seconds that a due line is left to the program, whose text is newer */

/** A thread that repeats the last line. */
struct adcgs_pulse {
    adcgs_progress *progress;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    int ended;
};

static void lock(const adcgs_progress *p)
{
    if (p->pulse)
        pthread_mutex_lock(&p->pulse->lock);
}

static void unlock(const adcgs_progress *p)
{
    if (p->pulse)
        pthread_mutex_unlock(&p->pulse->lock);
}

void adcgs_progress_init(adcgs_progress *progress, const adcgs_cli *cli)
{
    const int is_terminal = isatty(STDERR_FILENO);
    *progress = (adcgs_progress){.cli = cli,
                                 .is_terminal = is_terminal,
                                 .last = adcgs_seconds(),
                                 .grace = PULSE_AFTER,
                                 .every = is_terminal ? TERMINAL_EVERY : LINES_FIRST};
}

static void print_line(adcgs_progress *p, double now, const char *text)
{
    p->last = now;
    p->shown = p->is_terminal;
    if (!p->is_terminal) {
        p->every = ADCGS_MIN(2.0 * p->every, LINES_MOST);
        adcgs_cli_note(p->cli, "%s", text);
        return;
    }
    fputc('\r', stderr);
    adcgs_text_show(stderr, text);
    fputs("\033[K", stderr);
}

void adcgs_progress_show(adcgs_progress *progress, const char *format, ...)
{
    va_list arguments;
    const double now = adcgs_seconds();
    if (progress->cli->quiet && *progress->cli->quiet)
        return;
    lock(progress);
    va_start(arguments, format);
    vsnprintf(progress->said, sizeof progress->said, format, arguments);
    va_end(arguments);
    progress->said_at = now;
    if (now - progress->last >= progress->every)
        print_line(progress, now, progress->said);
    unlock(progress);
}

void adcgs_progress_clear(adcgs_progress *progress)
{
    lock(progress);
    if (progress->shown)
        fputs("\r\033[K", stderr);
    progress->shown = 0;
    progress->said[0] = 0;
    unlock(progress);
}

const char *adcgs_progress_eta(double seconds, char text[32])
{
    const unsigned whole = seconds >= 0 && seconds < 1e9 ? (unsigned)seconds : 0;
    if (whole >= 3600)
        snprintf(text, 32, "  %u:%02u:%02u left", whole / 3600, whole / 60 % 60, whole % 60);
    else
        snprintf(text, 32, "  %u:%02u left", whole / 60, whole % 60);
    return isnan(seconds) ? "" : text;
}

/* ---- The thread ---- */

static struct timespec moment_of(double seconds)
{
    const time_t whole = (time_t)seconds;
    return (struct timespec){.tv_sec = whole, .tv_nsec = (long)(1e9 * (seconds - (double)whole))};
}

static void *beat(void *user)
{
    struct adcgs_pulse *const pulse = user;
    adcgs_progress *const p = pulse->progress;
    pthread_mutex_lock(&pulse->lock);
    while (!pulse->ended) {
        const double now = adcgs_seconds();
        if (now >= p->last + p->every + p->grace) {
            char text[sizeof p->said + 32];
            const size_t n = strlen(p->said);
            if (n > 4 && !strcmp(p->said + n - 4, " ...")) /* the work still runs */
                snprintf(text, sizeof text, "%.*s, %.0f s", (int)n - 4, p->said, now - p->said_at);
            else
                snprintf(text, sizeof text, "%s (%.0f s ago)", p->said, now - p->said_at);
            if (p->said[0])
                print_line(p, now, text);
            else
                p->last = now;
        }
        const struct timespec due = moment_of(p->last + p->every + p->grace);
        pthread_cond_timedwait(&pulse->changed, &pulse->lock, &due);
    }
    pthread_mutex_unlock(&pulse->lock);
    return NULL;
}

void adcgs_progress_keep(adcgs_progress *progress)
{
    pthread_condattr_t steady;
    const int is_silent = progress->is_terminal || (progress->cli->quiet && *progress->cli->quiet);
    struct adcgs_pulse *const pulse = is_silent ? NULL : malloc(sizeof *pulse);
    if (!pulse) /* without memory, no line is repeated */
        return;
    *pulse = (struct adcgs_pulse){.progress = progress};
    pthread_condattr_init(&steady);
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC); /* the clock of adcgs_seconds() */
    pthread_mutex_init(&pulse->lock, NULL);
    pthread_cond_init(&pulse->changed, &steady);
    pthread_condattr_destroy(&steady);
    progress->pulse = pulse;
    if (pthread_create(&pulse->thread, NULL, beat, pulse)) {
        pulse->ended = 1;
        adcgs_progress_end(progress);
    }
}

void adcgs_progress_end(adcgs_progress *progress)
{
    struct adcgs_pulse *const pulse = progress->pulse;
    if (!pulse)
        return;
    const int runs = !pulse->ended;
    pthread_mutex_lock(&pulse->lock);
    pulse->ended = 1;
    pthread_cond_signal(&pulse->changed);
    pthread_mutex_unlock(&pulse->lock);
    if (runs)
        pthread_join(pulse->thread, NULL);
    pthread_cond_destroy(&pulse->changed);
    pthread_mutex_destroy(&pulse->lock);
    progress->pulse = NULL;
    free(pulse);
}
