/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Processes that were started together and send each other messages: the front of the module that holds MPI, which nothing else
 * opens. Messages are short and all of one size. Who waits for one asks now and then, and sleeps in between, since MPI's own
 * waiting takes a whole processor. The thread that opens is the one that calls.
 */
#ifndef ADCGS_IO_RANKS_H
#define ADCGS_IO_RANKS_H

#include "base/base.h"

#define ADCGS_RANKS_HOST 64

struct adcgs_mpi;

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

#endif
