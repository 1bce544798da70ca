/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Input that arrives at any time: from standard input, a pipe, a device. A read
 * waits only a short time, so that the caller can do other work in between.
 */
#ifndef ADCGS_SYSTEM_PIPE_H
#define ADCGS_SYSTEM_PIPE_H

#include "base/base.h"

typedef struct adcgs_pipe {
    const char *name; /**< for messages */
    int fd;
    int own;   /**< fd must be closed */
    int ended; /**< no more bytes will come */
} adcgs_pipe;

/**
 * True for an input that can only be read in order and has no known size: "-", or a path that exists and is not a regular file or
 * a folder.
 */
int adcgs_pipe_is(const char *path);
/** path: as the user gave it, "-" for standard input; must outlive the pipe. Succeeds without a writer. */
adcgs_status adcgs_pipe_open(adcgs_pipe *pipe, const char *path, adcgs_error *error);
/** Harmless if opening failed. */
void adcgs_pipe_close(adcgs_pipe *pipe);
/**
 * Read up to `bytes` bytes as soon as some are available. *got is 0 after a tenth of a second without any, after a signal, and at
 * the end, which sets ended. ADCGS_ERR_IO if reading fails.
 */
adcgs_status adcgs_pipe_read(adcgs_pipe *pipe, void *buffer, size_t bytes, size_t *got, adcgs_error *error);

#endif
