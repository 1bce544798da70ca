/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Files that appear complete or not at all: written under a temporary name in
 * the same folder, synced, then renamed. Special files (a pipe, a terminal,
 * /dev/null) are written directly, since renaming would replace them.
 */
#ifndef ADCGS_IO_ATOMIC_H
#define ADCGS_IO_ATOMIC_H

#include "base/base.h"

#include <stdio.h>

typedef struct adcgs_atomic {
    FILE *file;      /**< write here; NULL when nothing is open */
    char *path;      /**< final name */
    char *temporary; /**< NULL for special files */
} adcgs_atomic;

adcgs_status adcgs_atomic_open(adcgs_atomic *atomic, const char *path, adcgs_error *error);
/** Reopened by name: for libraries that insist on opening the file themselves. They write to the name returned. */
const char *adcgs_atomic_name(const adcgs_atomic *atomic);
/** Sync and rename. On failure nothing is left behind and the file of that name is as it was. Either way it is closed. */
adcgs_status adcgs_atomic_commit(adcgs_atomic *atomic, adcgs_error *error);
/** Remove the temporary file. Harmless when nothing is open. */
void adcgs_atomic_abort(adcgs_atomic *atomic);

#endif
