/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * An unnamed file in TMPDIR (default: /var/tmp), for images that do not fit into memory. Its limit is known before the first
 * write, and leaves a part of the free space to others: a full disk would also stop the run's own outputs.
 */
#ifndef ADCGS_SCENE_SPOOL_H
#define ADCGS_SCENE_SPOOL_H

#include "base/base.h"

typedef struct adcgs_spool {
    char *folder;
    int file;      /**< -1: none yet */
    int problem;   /**< errno if the file could not be created or cannot grow; 0: only its room limits it */
    uint64_t room; /**< bytes that the file may take; known once the file exists */
    uint64_t used;
} adcgs_spool;

/** The folder, from malloc(); NULL on allocation failure. */
char *adcgs_spool_folder(void);
/** Bytes that may be written there: 15/16 of the free space, or the process's limit of file size if lower. *problem: errno. */
uint64_t adcgs_spool_room(const char *folder, int *problem);

adcgs_status adcgs_spool_init(adcgs_spool *spool, adcgs_error *error);
/** Closes the file, which deletes it. Accepts a spool that is zero except for file, -1. */
void adcgs_spool_clear(adcgs_spool *spool);
/** Takes this many bytes; creates the file if needed. \return true if there is room. One thread at a time. */
int adcgs_spool_take(adcgs_spool *spool, size_t bytes, uint64_t *at);
/** Any thread may call. \return 0, or errno */
int adcgs_spool_write(const adcgs_spool *spool, const void *data, size_t bytes, uint64_t at);
int adcgs_spool_read(const adcgs_spool *spool, void *data, size_t bytes, uint64_t at);

#endif
