/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Visitors of a run's state: they store, restore or sum up each number that a walk passes. */
#ifndef ADCGS_TRAIN_STATE_VISIT_H
#define ADCGS_TRAIN_STATE_VISIT_H

#include "bits/bytes.h"

#include <stdio.h>

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

#endif
