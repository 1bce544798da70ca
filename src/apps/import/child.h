/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Runs another program to its end. Its output goes into a log, and each line to a callback for progress. */
#ifndef ADCGS_APPS_IMPORT_CHILD_H
#define ADCGS_APPS_IMPORT_CHILD_H

#include "base/base.h"

#include <stdio.h>

/**
 * Called with each line of the child, without its end, and with "" every tenth of a second without one; nonzero: stop the
 * child.
 */
typedef int (*adcgs_child_line)(void *user, const char *line);

/**
 * Runs argv[0], found along PATH, with argv, which ends with NULL; standard input is empty. log: receives the command and its
 * output; or NULL. *code: its exit code, 128 and more for a signal. ADCGS_ERR_UNSUPPORTED if there is no such program.
 */
adcgs_status adcgs_child_run(char *const argv[], FILE *log, adcgs_child_line line, void *user, int *code, adcgs_error *error);

#endif
