/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Table of the module with MPI. Callers define the meaning of messages. */
#ifndef ADCGS_NET_RANKS_MPI_H
#define ADCGS_NET_RANKS_MPI_H

#include "net/ranks.h"
#include "system/module.h"

typedef struct adcgs_mpi {
    const char *version; /**< version of the programs that the module belongs to */
    adcgs_status (*open)(adcgs_ranks *ranks, adcgs_error *error);
    void (*close)(void);
    void (*abort)(int code);
    void (*send)(int to, const void *message, int bytes);
    int (*take)(int *from, void *message, int bytes); /**< \return whether there was a message of this size */
    adcgs_status (*swap)(int first, const adcgs_ranks_part *out, int n_out, const adcgs_ranks_part *in, int n_in,
                         adcgs_error *error);
    int (*swapped)(int *missing);
} adcgs_mpi;

/** The module's only exported symbol. */
ADCGS_MODULE_EXPORT extern const adcgs_mpi adcgs_mpi_table;

#endif
