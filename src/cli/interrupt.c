/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Interruption of the programs. */
#include "config.h"

#include "cli/cli.h"

#include <signal.h>

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
