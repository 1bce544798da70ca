/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Processes that were started together and exchange messages: the front of the
 * module with MPI, which is opened only here. Messages are short and have the
 * same size. In addition, some of the processes swap any number of bytes.
 * Waiting callers poll, and sleep in between, since MPI's own waiting occupies
 * a whole processor. Any thread may call, except for opening and closing.
 */
#ifndef ADCGS_NET_RANKS_H
#define ADCGS_NET_RANKS_H

#include "base/base.h"

#define ADCGS_RANKS_HOST 64 /**< bytes of a host's name, its terminating zero included; chosen by hand, not measured */

struct adcgs_mpi;

/** Bytes for another rank, or room for bytes from it. */
typedef struct adcgs_ranks_part {
    int rank;
    void *data;
    size_t bytes;
} adcgs_ranks_part;

/** One of the processes. size 0: not opened. */
typedef struct adcgs_ranks {
    int rank, size;
    int local_size;              /**< number of processes on this host */
    char host[ADCGS_RANKS_HOST]; /**< of this process */
    const struct adcgs_mpi *mpi;
} adcgs_ranks;

/** Number of processes started together, from the environment: more than 1 by mpirun, or by srun for MPI. */
int adcgs_ranks_expected(void);
/** ADCGS_ERR_UNSUPPORTED without MPI. */
adcgs_status adcgs_ranks_open(adcgs_ranks *ranks, adcgs_error *error);
/** Waits for all other ranks. No effect if not open. */
void adcgs_ranks_close(adcgs_ranks *ranks);
/** End all ranks; this one exits with the code. */
void adcgs_ranks_abort(const adcgs_ranks *ranks, int code);
void adcgs_ranks_send(const adcgs_ranks *ranks, int to, const void *message, int bytes);
/** \return whether there was a message, of this size; *from: rank of its sender */
int adcgs_ranks_take(const adcgs_ranks *ranks, int *from, void *message, int bytes);
/**
 * Begin to send and receive parts; their ranks are counted from `first`. Both sides must agree on the sizes, and on the order of
 * parts between each two ranks. The data must not be touched until adcgs_ranks_swapped() returns true. A process runs one swap at
 * a time.
 */
adcgs_status adcgs_ranks_swap(const adcgs_ranks *ranks, int first, const adcgs_ranks_part *out, int n_out,
                              const adcgs_ranks_part *in, int n_in, adcgs_error *error);
/** \return whether the swap is complete; if not, *missing is one of the ranks waited for, counted from 0 */
int adcgs_ranks_swapped(const adcgs_ranks *ranks, int *missing);

#endif
