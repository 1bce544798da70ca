/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Progress and interruption for the programs. */
#include "config.h"

#include "cli/cli.h"

#include "cli/text.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#define TERMINAL_EVERY 0.1 /* seconds */
#define LINES_FIRST 5.0
#define LINES_MOST 30.0

/* A signal handler can reach nothing but static storage. */
static volatile sig_atomic_t interrupted, interrupts, interrupts_most;
static const int numbers[] = {SIGINT, SIGTERM};

static void on_signal(int number)
{
    interrupted = number;
    interrupts = interrupts + 1;
    for (size_t i = 0; interrupts >= interrupts_most && i < ADCGS_COUNTOF(numbers); i++)
        signal(numbers[i], SIG_DFL);
}

void adcgs_interrupt_catch(int most)
{
    interrupts_most = most;
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

int adcgs_interrupts(void)
{
    return interrupts;
}

void adcgs_progress_init(adcgs_progress *progress, const adcgs_cli *cli)
{
    const int is_terminal = isatty(STDERR_FILENO);
    *progress = (adcgs_progress){
        .cli = cli, .is_terminal = is_terminal, .last = adcgs_seconds(), .every = is_terminal ? TERMINAL_EVERY : LINES_FIRST};
}

void adcgs_progress_show(adcgs_progress *progress, const char *format, ...)
{
    char text[256];
    va_list arguments;
    const double now = adcgs_seconds();
    if ((progress->cli->quiet && *progress->cli->quiet) || now - progress->last < progress->every)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    progress->last = now;
    progress->shown = progress->is_terminal;
    if (!progress->is_terminal) {
        progress->every = ADCGS_MIN(2.0 * progress->every, LINES_MOST);
        adcgs_cli_note(progress->cli, "%s", text);
        return;
    }
    fputc('\r', stderr);
    adcgs_text_show(stderr, text);
    fputs("\033[K", stderr);
}

void adcgs_progress_clear(adcgs_progress *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    progress->shown = 0;
}
