/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A file without a name in TMPDIR (/var/tmp without it), for images that memory has no room for. The room is known before
 * anything is written, and a part of it is left to others: a disk that is full stops the run's own outputs, too.
 */
#ifndef ADCGS_DATA_SPOOL_H
#define ADCGS_DATA_SPOOL_H

#include "base/base.h"

typedef struct adcgs_spool {
    char *folder;
    int file;      /**< -1: none yet */
    int problem;   /**< errno of why the file is not there, or grows no more; 0: there is nothing but its room to bound it */
    uint64_t room; /**< bytes that the file may take; known once there is a file */
    uint64_t used;
} adcgs_spool;

/** The folder, from malloc(); NULL without memory. */
char *adcgs_spool_folder(void);
/** Bytes that may be written there: 15/16 of the free space, and the process's limit of a file's size. *problem: errno. */
uint64_t adcgs_spool_room(const char *folder, int *problem);

adcgs_status adcgs_spool_init(adcgs_spool *spool, adcgs_error *error);
/** The file is closed, and so is gone. Accepts one that is zero except its file, -1. */
void adcgs_spool_clear(adcgs_spool *spool);
/** Take so many bytes; \return whether there is room, which makes the file. One thread at a time. */
int adcgs_spool_take(adcgs_spool *spool, size_t bytes, uint64_t *at);
/** Any threads. \return 0, or errno */
int adcgs_spool_write(const adcgs_spool *spool, const void *data, size_t bytes, uint64_t at);
int adcgs_spool_read(const adcgs_spool *spool, void *data, size_t bytes, uint64_t at);

#endif
