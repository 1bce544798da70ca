/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Interruption of the programs. */
#include "config.h"

#include "system/interrupt.h"

#include "base/base.h"

#include <signal.h>
#include <unistd.h>

/* A signal handler may only use static storage. */
static volatile sig_atomic_t interrupted, interrupts, interrupts_most;
static const char *volatile last_word;
static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};

static void on_signal(int number)
{
    interrupted = number;
    interrupts = interrupts + 1;
    for (size_t i = 0; interrupts >= interrupts_most && i < ADCGS_COUNTOF(numbers); i++)
        signal(numbers[i], SIG_DFL);
}

/** Ends the program by the signal's default action, so that a shell sees the signal. */
static void on_last_signal(int number)
{
    const char *const text = last_word;
    if (write(STDERR_FILENO, text, strlen(text)) < 0)
        last_word = text; /* nobody can read it */
    signal(number, SIG_DFL);
    raise(number);
}

/** Install a handler. SIGHUP stays ignored if it was ignored at the start, as under nohup. */
static void handle(void (*handler)(int))
{
    for (size_t i = 0; i < ADCGS_COUNTOF(numbers); i++) {
        struct sigaction before, action = {.sa_handler = handler, .sa_flags = SA_RESTART};
        sigemptyset(&action.sa_mask);
        if (numbers[i] == SIGHUP && !sigaction(SIGHUP, NULL, &before) && before.sa_handler == SIG_IGN)
            continue;
        sigaction(numbers[i], &action, NULL);
    }
}

void adcgs_interrupt_catch(int most)
{
    interrupts_most = most;
    handle(on_signal);
}

void adcgs_interrupt_word(const char *text)
{
    last_word = text;
    handle(on_last_signal);
}

int adcgs_interrupted(void)
{
    return interrupted;
}

int adcgs_interrupts(void)
{
    return interrupts;
}
