/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * One walk over the state of a run visits every number that the rest of the run depends on. Storing and restoring are its
 * visitors.
 */
#ifndef ADCGS_TRAIN_STATE_CHECKPOINT_WALK_H
#define ADCGS_TRAIN_STATE_CHECKPOINT_WALK_H

#include "train/state/checkpoint.h"

#include <stdio.h>

/** Format number; the first number that the walk visits, as 64 bits; definition, one more with each change. */
enum { ADCGS_CHECKPOINT_FORMAT = 34 };

typedef struct adcgs_checkpoint_walk {
    adcgs_buffer *out; /* storing to memory */
    FILE *file;        /* or storing to a file, without memory */
    uint32_t crc;      /* of the bytes in the file */
    int unwritten;     /* writing to the file failed; the state must not change for it */
    adcgs_reader *in;  /* or restoring */
    int failed;        /* the bytes do not fit */
    char differs[160]; /* restoring: the mismatch between run and file; "" if there is none */
} adcgs_checkpoint_walk;

/** Visits a number or an array: stores or restores it. */
void adcgs_checkpoint_visit(adcgs_checkpoint_walk *w, void *data, size_t bytes);
/** Stores the whole state. */
void adcgs_checkpoint_walk_all(adcgs_checkpoint_walk *w, const adcgs_trainer *trainer);

#endif
