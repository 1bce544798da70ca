/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Another program, run to its end: its words go into a log, and each line to who wants to know how far it is. */
#ifndef ADCGS_IMPORT_CHILD_H
#define ADCGS_IMPORT_CHILD_H

#include "base/base.h"

#include <stdio.h>

/** Told each line that the child writes, without its end, and "" every tenth of a second without one; nonzero: stop it. */
typedef int (*adcgs_child_line)(void *user, const char *line);

/**
 * Run argv[0], found along PATH, with argv, NULL behind the last; standard input is empty. log: gets the command and all that it
 * writes; or NULL. *code: its exit code, 128 and more for a signal. ADCGS_ERR_UNSUPPORTED if there is no such program.
 */
adcgs_status adcgs_child_run(char *const argv[], FILE *log, adcgs_child_line line, void *user, int *code, adcgs_error *error);

#endif
