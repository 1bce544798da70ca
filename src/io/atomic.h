/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Files that appear complete or not at all: written under a temporary name in
 * the same folder, synced, then renamed. Everything that the programs write to
 * a named file goes through here, so an error of the system is seen in one
 * place and leaves what was there before as it was.
 *
 * A symbolic link is followed: what it points to is replaced, not the link. A
 * new file has the mode that the umask leaves; one that replaces another has
 * the other's mode, and its owner where we may set it. A file that may not be
 * written to is not replaced. Special files (a pipe, a terminal, /dev/null) are
 * written directly, since renaming would replace them.
 */
#ifndef ADCGS_IO_ATOMIC_H
#define ADCGS_IO_ATOMIC_H

#include "base/base.h"

#include <stdio.h>

typedef struct adcgs_atomic {
    FILE *file;      /**< write here; NULL when nothing is open */
    char *path;      /**< the name that was given, for messages */
    char *target;    /**< what it stands for after symbolic links */
    char *temporary; /**< NULL for special files */
} adcgs_atomic;

adcgs_status adcgs_atomic_open(adcgs_atomic *atomic, const char *path, adcgs_error *error);
/** Sync and rename. On failure nothing is left behind and the file of that name is as it was. Either way it is closed. */
adcgs_status adcgs_atomic_commit(adcgs_atomic *atomic, adcgs_error *error);
/**
 * For a file that grows under its name: what was written so far appears, as adcgs_atomic_commit() has it appear, and what is
 * written from then on does at once, when it is flushed. On failure it is as if nothing had been opened.
 */
adcgs_status adcgs_atomic_show(adcgs_atomic *atomic, adcgs_error *error);
/** Remove the temporary file. Harmless when nothing is open. */
void adcgs_atomic_abort(adcgs_atomic *atomic);
/** Open, write all of the data, commit. */
adcgs_status adcgs_atomic_save(const char *path, const void *data, size_t bytes, adcgs_error *error);
/** Whether two names stand for one file, which may be there or yet to be written. Names of special files never do. */
int adcgs_atomic_same(const char *a, const char *b);

#endif
