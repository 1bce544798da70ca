/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Processes that were started together and send each other messages: the front of the module that holds MPI, which nothing else
 * opens. Messages are short and all of one size; beside them some of the processes swap bytes, as many as they like. Who waits
 * asks now and then, and sleeps in between, since MPI's own waiting takes a whole processor. Any thread may call, but for opening
 * and closing.
 */
#ifndef ADCGS_IO_RANKS_H
#define ADCGS_IO_RANKS_H

#include "base/base.h"

#define ADCGS_RANKS_HOST 64

struct adcgs_mpi;

/** Bytes for another rank, or room for what comes from it. */
typedef struct adcgs_ranks_part {
    int rank;
    void *data;
    size_t bytes;
} adcgs_ranks_part;

/** One of them. size 0: not opened. */
typedef struct adcgs_ranks {
    int rank, size;
    int local_size;              /**< of them on this host */
    char host[ADCGS_RANKS_HOST]; /**< this one */
    const struct adcgs_mpi *mpi;
} adcgs_ranks;

/** How many were started together, as the environment says: more than 1 by mpirun, or by srun for MPI. */
int adcgs_ranks_expected(void);
/** ADCGS_ERR_UNSUPPORTED without MPI. */
adcgs_status adcgs_ranks_open(adcgs_ranks *ranks, adcgs_error *error);
/** Waits for all others. Does nothing to what is not open. */
void adcgs_ranks_close(adcgs_ranks *ranks);
/** End all of them; this one leaves with the code. */
void adcgs_ranks_abort(const adcgs_ranks *ranks, int code);
void adcgs_ranks_send(const adcgs_ranks *ranks, int to, const void *message, int bytes);
/** \return whether there was a message, of that size; *from: whose it is */
int adcgs_ranks_take(const adcgs_ranks *ranks, int *from, void *message, int bytes);
/**
 * Begin to send parts and to receive others; their ranks are counted from `first`. Both sides know their sizes, and their order
 * between each two of them. What they point to is untouched until adcgs_ranks_swapped() says so; a process is at one swap at a
 * time.
 */
adcgs_status adcgs_ranks_swap(const adcgs_ranks *ranks, int first, const adcgs_ranks_part *out, int n_out,
                              const adcgs_ranks_part *in, int n_in, adcgs_error *error);
/** \return whether all is there; if not *missing is one of the ranks that are waited for, counted from 0 */
int adcgs_ranks_swapped(const adcgs_ranks *ranks, int *missing);

#endif
