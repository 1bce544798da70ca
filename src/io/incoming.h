/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Bytes that come in order, from a pipe or by http: who reads them waits a moment at most, and can look round meanwhile.
 */
#ifndef ADCGS_IO_INCOMING_H
#define ADCGS_IO_INCOMING_H

#include "io/http.h"
#include "io/pipe.h"

typedef struct adcgs_incoming {
    const char *name;  /**< for messages: "standard input", the path, or the URL */
    int ended;         /**< no more bytes will come */
    adcgs_pipe pipe;
    adcgs_http *http;  /**< NULL: it is the pipe */
} adcgs_incoming;

/**
 * path outlives it. A server is waited for, unless interrupted() says not to (see http.h); a pipe is not. Errors as of
 * adcgs_http_open() and adcgs_pipe_open().
 */
adcgs_status adcgs_incoming_open(adcgs_incoming *in, const char *path, int (*interrupted)(void), adcgs_error *error);
/** Harmless where opening failed. */
void adcgs_incoming_close(adcgs_incoming *in);
/**
 * Take up to `bytes` bytes as soon as there are some. After a moment without any *got is 0, as it is at the end, which sets
 * ended. ADCGS_ERR_IO if reading fails.
 */
adcgs_status adcgs_incoming_read(adcgs_incoming *in, void *buffer, size_t bytes, size_t *got, adcgs_error *error);

#endif
