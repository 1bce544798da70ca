/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Bytes that come when they come: from standard input, a pipe, a device. Nothing waits longer than a moment, so that who reads
 * can look round meanwhile.
 */
#ifndef ADCGS_IO_PIPE_H
#define ADCGS_IO_PIPE_H

#include "base/base.h"

typedef struct adcgs_pipe {
    const char *name; /**< for messages */
    int fd;
    int own;          /**< to be closed */
    int ended;        /**< no more bytes will come */
} adcgs_pipe;

/** Whether bytes of this input come in order, and how many is not known: it is "-", or neither a regular file nor missing. */
int adcgs_pipe_is(const char *path);
/** path: as the user has it, "-" for standard input; outlives the pipe. That nobody has opened it to write is no failure. */
adcgs_status adcgs_pipe_open(adcgs_pipe *pipe, const char *path, adcgs_error *error);
/** Harmless where opening failed. */
void adcgs_pipe_close(adcgs_pipe *pipe);
/**
 * Take up to `bytes` bytes as soon as there are some. After a tenth of a second without any, or after a signal, *got is 0, as it
 * is at the end, which sets ended. ADCGS_ERR_IO if reading fails.
 */
adcgs_status adcgs_pipe_read(adcgs_pipe *pipe, void *buffer, size_t bytes, size_t *got, adcgs_error *error);

#endif
