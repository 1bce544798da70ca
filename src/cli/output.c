/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Progress and interruption for the programs. */
#include "config.h"

#include "cli/cli.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

/* A signal handler can reach nothing but static storage. */
static volatile sig_atomic_t interrupted;

static void on_signal(int number)
{
    interrupted = number;
    signal(number, SIG_DFL);
}

void adcgs_interrupt_catch(void)
{
    const int numbers[] = {SIGINT, SIGTERM};
    for (size_t i = 0; i < ADCGS_COUNTOF(numbers); i++) {
        struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
        sigemptyset(&action.sa_mask);
        sigaction(numbers[i], &action, NULL);
    }
}

int adcgs_interrupted(void)
{
    return interrupted;
}

void adcgs_progress_init(adcgs_progress *progress)
{
    *progress = (adcgs_progress){.active = isatty(STDERR_FILENO)};
}

void adcgs_progress_show(adcgs_progress *progress, const char *format, ...)
{
    if (!progress->active)
        return;
    const double now = adcgs_seconds();
    if (progress->shown && now - progress->last < 0.1)
        return;
    va_list arguments;
    va_start(arguments, format);
    fputc('\r', stderr);
    vfprintf(stderr, format, arguments);
    fputs("\033[K", stderr);
    va_end(arguments);
    progress->last = now;
    progress->shown = 1;
}

void adcgs_progress_clear(adcgs_progress *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    progress->shown = 0;
}
