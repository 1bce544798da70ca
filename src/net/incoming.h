/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Bytes that arrive in order, from a pipe or by http. A read waits only a short
 * time, so the caller can do other work in between.
 */
#ifndef ADCGS_NET_INCOMING_H
#define ADCGS_NET_INCOMING_H

#include "net/http.h"
#include "system/pipe.h"

typedef struct adcgs_incoming {
    const char *name; /**< for messages: "standard input", the path, or the URL */
    int ended;        /**< no more bytes will come */
    adcgs_pipe pipe;
    adcgs_http *http; /**< NULL: the source is the pipe */
} adcgs_incoming;

/**
 * path must outlive *in. Waits for a server until interrupted() returns true (see http.h); does not wait for a pipe. Errors as of
 * adcgs_http_open() and adcgs_pipe_open().
 */
adcgs_status adcgs_incoming_open(adcgs_incoming *in, const char *path, int (*interrupted)(void), adcgs_error *error);
/** Harmless if opening failed. */
void adcgs_incoming_close(adcgs_incoming *in);
/**
 * Read up to `bytes` bytes as soon as some are available. *got is 0 after a short time without any, and at the end, which sets
 * ended. ADCGS_ERR_IO if reading fails.
 */
adcgs_status adcgs_incoming_read(adcgs_incoming *in, void *buffer, size_t bytes, size_t *got, adcgs_error *error);

#endif
