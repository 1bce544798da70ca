/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Files that appear complete or not at all. A file is written under a temporary
 * name in the same folder, synced, then renamed. The programs write every named
 * file through here, so system errors are handled in one place and leave the
 * previous file unchanged.
 *
 * A symbolic link is followed: its target is replaced, not the link. A new file
 * gets the mode that the umask leaves. A replacement keeps the mode of the
 * replaced file, and its owner where that is permitted. A file without write
 * permission is not replaced. Special files (a pipe, a terminal, /dev/null) are
 * written directly, since renaming would replace them.
 */
#ifndef ADCGS_SYSTEM_ATOMIC_H
#define ADCGS_SYSTEM_ATOMIC_H

#include "base/base.h"

#include <stdio.h>

typedef struct adcgs_atomic {
    FILE *file;      /**< output goes here; NULL when nothing is open */
    char *path;      /**< the name as given, for messages */
    char *target;    /**< path after following symbolic links */
    char *temporary; /**< NULL for special files */
} adcgs_atomic;

adcgs_status adcgs_atomic_open(adcgs_atomic *atomic, const char *path, adcgs_error *error);
/** Sync and rename. On failure no temporary file is left and the existing file is unchanged. Closes atomic in either case. */
adcgs_status adcgs_atomic_commit(adcgs_atomic *atomic, adcgs_error *error);
/**
 * For a file that grows under its final name: the content written so far appears, as with adcgs_atomic_commit(). Later output
 * appears at once when it is flushed. On failure the temporary file is removed. atomic is then closed.
 */
adcgs_status adcgs_atomic_show(adcgs_atomic *atomic, adcgs_error *error);
/** Remove the temporary file. Harmless when nothing is open. */
void adcgs_atomic_abort(adcgs_atomic *atomic);
/** Open, write all the data, commit. */
adcgs_status adcgs_atomic_save(const char *path, const void *data, size_t bytes, adcgs_error *error);
/** True if two names refer to one file, which may exist or not yet. Always false for names of special files. */
int adcgs_atomic_same(const char *a, const char *b);

#endif
