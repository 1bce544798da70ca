/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * MPI, in a module of its own. A failed call ends all ranks with a message,
 * which is MPI's default: no rank can continue without the others.
 */
#include "config.h"

#include "net/ranks_mpi.h"

#include <mpi.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
enum { TAG_MESSAGE = 1, TAG_PART = 2 }; /* tags of MPI */
#define PIECE ((size_t)1 << 30)         /* bytes per piece of a part: MPI counts in int */

/* Threads take turns, since MPI is only asked for MPI_THREAD_SERIALIZED. */
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;

/* The current swap. */
static struct {
    int n;                 /* number of requests, those that receive first; 0: no swap */
    MPI_Request *requests; /* MPI_REQUEST_NULL when done */
    int *ranks;            /* the other rank of each request */
    int *done;             /* output of MPI_Testsome() */
} swap;

static adcgs_status mpi_open(adcgs_ranks *r, adcgs_error *error)
{
    char host[MPI_MAX_PROCESSOR_NAME + 1] = "";
    int level, length;
    MPI_Comm here;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &level) != MPI_SUCCESS || level < MPI_THREAD_SERIALIZED)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "MPI does not start with support for threads");
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
    pthread_mutex_lock(&turn);
    MPI_Send(message, bytes, MPI_BYTE, to, TAG_MESSAGE, MPI_COMM_WORLD);
    pthread_mutex_unlock(&turn);
}

static int receive_message(int *from, void *message, int bytes)
{
    MPI_Status status;
    int is_there = 0, length = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, TAG_MESSAGE, MPI_COMM_WORLD, &is_there, &status);
    if (!is_there)
        return 0;
    MPI_Get_count(&status, MPI_BYTE, &length);
    if (length != bytes) /* from another program: MPI itself aborts if a message does not fit */
        MPI_Abort(MPI_COMM_WORLD, 1);
    MPI_Recv(message, bytes, MPI_BYTE, status.MPI_SOURCE, TAG_MESSAGE, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    *from = status.MPI_SOURCE;
    return 1;
}

static int mpi_take(int *from, void *message, int bytes)
{
    pthread_mutex_lock(&turn);
    const int taken = receive_message(from, message, bytes);
    pthread_mutex_unlock(&turn);
    return taken;
}

/* ---- Swaps ---- */

static int pieces_of(const adcgs_ranks_part *parts, int n)
{
    int pieces = 0;
    for (int i = 0; i < n; i++)
        pieces += (int)((parts[i].bytes + PIECE - 1) / PIECE);
    return pieces;
}

static void begin_part(const adcgs_ranks_part *part, int rank, int receives)
{
    for (size_t at = 0; at < part->bytes; at += PIECE) {
        char *const data = (char *)part->data + at;
        const int bytes = (int)ADCGS_MIN(part->bytes - at, PIECE);
        if (receives)
            MPI_Irecv(data, bytes, MPI_BYTE, rank, TAG_PART, MPI_COMM_WORLD, &swap.requests[swap.n]);
        else
            MPI_Isend(data, bytes, MPI_BYTE, rank, TAG_PART, MPI_COMM_WORLD, &swap.requests[swap.n]);
        swap.ranks[swap.n++] = rank;
    }
}

static void end_swap(void)
{
    free(swap.requests);
    free(swap.ranks);
    free(swap.done);
    swap.requests = NULL;
    swap.ranks = swap.done = NULL;
    swap.n = 0;
}

static adcgs_status mpi_swap(int first, const adcgs_ranks_part *out, int n_out, const adcgs_ranks_part *in, int n_in,
                             adcgs_error *error)
{
    const size_t n = (size_t)(pieces_of(out, n_out) + pieces_of(in, n_in)) + 1;
    swap.requests = calloc(n, sizeof(MPI_Request));
    swap.ranks = calloc(n, sizeof *swap.ranks);
    swap.done = calloc(n, sizeof *swap.done);
    if (!swap.requests || !swap.ranks || !swap.done) {
        end_swap();
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for messages between ranks");
    }
    pthread_mutex_lock(&turn);
    for (int i = 0; i < n_in; i++)
        begin_part(&in[i], first + in[i].rank, 1);
    for (int i = 0; i < n_out; i++)
        begin_part(&out[i], first + out[i].rank, 0);
    pthread_mutex_unlock(&turn);
    return ADCGS_OK;
}

static int mpi_swapped(int *missing)
{
    int n, left = 0;
    pthread_mutex_lock(&turn);
    MPI_Testsome(swap.n, swap.requests, &n, swap.done, MPI_STATUSES_IGNORE);
    pthread_mutex_unlock(&turn);
    for (int i = swap.n - 1; i >= 0; i--)
        if (swap.requests[i] != MPI_REQUEST_NULL) {
            *missing = swap.ranks[i];
            left++;
        }
    if (!left)
        end_swap();
    return !left;
}

const adcgs_mpi adcgs_mpi_table = {
    .version = PACKAGE_VERSION,
    .open = mpi_open,
    .close = mpi_close,
    .abort = mpi_abort,
    .send = mpi_send,
    .take = mpi_take,
    .swap = mpi_swap,
    .swapped = mpi_swapped,
};
