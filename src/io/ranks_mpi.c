/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * MPI, in a module of its own. What fails in it ends all ranks by itself, with a message: so MPI has it unless told otherwise,
 * and there is nothing to be done without the others.
 */
#include "config.h"

#include "io/ranks_mpi.h"

#include <mpi.h>
#include <stdio.h>

enum { TAG = 1 };

static adcgs_status mpi_open(adcgs_ranks *r, adcgs_error *error)
{
    char host[MPI_MAX_PROCESSOR_NAME + 1] = "";
    int level, length;
    MPI_Comm here;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &level) != MPI_SUCCESS || level < MPI_THREAD_FUNNELED)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "MPI does not start with threads beside it");
    MPI_Comm_rank(MPI_COMM_WORLD, &r->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &r->size);
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &r->local_size);
    MPI_Comm_free(&here);
    MPI_Get_processor_name(host, &length);
    snprintf(r->host, sizeof r->host, "%.*s", (int)sizeof r->host - 1, host);
    return ADCGS_OK;
}

static void mpi_close(void)
{
    MPI_Finalize();
}

static void mpi_abort(int code)
{
    MPI_Abort(MPI_COMM_WORLD, code);
}

static void mpi_send(int to, const void *message, int bytes)
{
    MPI_Send(message, bytes, MPI_BYTE, to, TAG, MPI_COMM_WORLD);
}

static int mpi_take(int *from, void *message, int bytes)
{
    MPI_Status status;
    int is_there = 0, length = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, TAG, MPI_COMM_WORLD, &is_there, &status);
    if (!is_there)
        return 0;
    MPI_Get_count(&status, MPI_BYTE, &length);
    if (length != bytes) /* another program's: MPI ends all by itself where it does not fit */
        MPI_Abort(MPI_COMM_WORLD, 1);
    MPI_Recv(message, bytes, MPI_BYTE, status.MPI_SOURCE, TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    *from = status.MPI_SOURCE;
    return 1;
}

const adcgs_mpi adcgs_mpi_table = {
    .version = PACKAGE_VERSION,
    .open = mpi_open,
    .close = mpi_close,
    .abort = mpi_abort,
    .send = mpi_send,
    .take = mpi_take,
};
