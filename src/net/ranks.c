/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Processes that were started together: the front of the module with MPI. */
#include "config.h"

#include "net/ranks.h"

#include "net/ranks_mpi.h"

#include <stdlib.h>

#ifdef HAVE_MPI

static ADCGS_MODULE_GET(get_mpi, adcgs_mpi, adcgs_mpi_table, "adcgs_mpi.so", "ranks need MPI")

#else

static adcgs_status get_mpi(const adcgs_mpi **mpi, const char *path, adcgs_error *error)
{
    *mpi = NULL;
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                      "%s: ranks need MPI, which this build lacks: install libopenmpi-dev, "
                      "configure and build again",
                      path);
}

#endif

    static int number_of(const char *name)
{
    const char *const text = getenv(name);
    return text ? atoi(text) : 0;
}

int adcgs_ranks_expected(void)
{
    const int by_mpirun = number_of("OMPI_COMM_WORLD_SIZE");
    const int by_srun = getenv("PMIX_RANK") ? number_of("SLURM_STEP_NUM_TASKS") : 0;
    return ADCGS_MAX(by_mpirun ? by_mpirun : by_srun, 1);
}

adcgs_status adcgs_ranks_open(adcgs_ranks *r, adcgs_error *error)
{
    *r = (adcgs_ranks){.size = 0};
    ADCGS_TRY(get_mpi(&r->mpi, "mpirun", error));
    return r->mpi->open(r, error);
}

void adcgs_ranks_close(adcgs_ranks *r)
{
    if (r->size)
        r->mpi->close();
    r->size = 0;
}

void adcgs_ranks_abort(const adcgs_ranks *r, int code)
{
    if (r->size)
        r->mpi->abort(code);
    exit(code);
}

void adcgs_ranks_send(const adcgs_ranks *r, int to, const void *message, int bytes)
{
    r->mpi->send(to, message, bytes);
}

int adcgs_ranks_take(const adcgs_ranks *r, int *from, void *message, int bytes)
{
    return r->mpi->take(from, message, bytes);
}

adcgs_status adcgs_ranks_swap(const adcgs_ranks *r, int first, const adcgs_ranks_part *out, int n_out, const adcgs_ranks_part *in,
                              int n_in, adcgs_error *error)
{
    return r->mpi->swap(first, out, n_out, in, n_in, error);
}

int adcgs_ranks_swapped(const adcgs_ranks *r, int *missing)
{
    return r->mpi->swapped(missing);
}
