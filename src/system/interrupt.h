/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Signals that ask a program to end. */
#ifndef ADCGS_SYSTEM_INTERRUPT_H
#define ADCGS_SYSTEM_INTERRUPT_H

/** Let the first `most` of the signals SIGINT, SIGTERM and SIGHUP (if not ignored) set a flag; the next one kills. */
void adcgs_interrupt_catch(int most);
/** Let one of these signals print a line on standard error before it kills. text must stay valid. */
void adcgs_interrupt_word(const char *text);
/** The last signal, 0 if none. */
int adcgs_interrupted(void);
/** Number of signals received. */
int adcgs_interrupts(void);

#endif
