/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The module that holds libcurl: its table. It asks, waits, and tells what the answer says of itself; what to ask for, and
 * whether an answer is one to use, is the front's business (http.c).
 */
#ifndef ADCGS_IO_HTTP_CURL_H
#define ADCGS_IO_HTTP_CURL_H

#include "io/http_head.h"
#include "io/module.h"

/** A connection, and at most one answer that is being read. */
typedef struct adcgs_transfer adcgs_transfer;

typedef struct adcgs_curl {
    const char *version; /**< of the programs that the module belongs to */
    /** url outlives the transfer. */
    adcgs_status (*open)(adcgs_transfer **out, const char *url, int (*interrupted)(void), adcgs_error *error);
    void (*close)(adcgs_transfer **transfer);
    /**
     * Ask, and wait for the answer's head; an answer that is not read to its end is given up. range: "0-65535", NULL: all.
     * same: an ETag or a date: all, if it has become another; NULL: the range in any case.
     */
    adcgs_status (*ask)(adcgs_transfer *transfer, const char *range, const char *same, adcgs_http_head *head,
                        adcgs_error *error);
    /** Wait for some bytes of its body: *got of them, at most `bytes`; 0 at its end. */
    adcgs_status (*read)(adcgs_transfer *transfer, void *buffer, size_t bytes, size_t *got, adcgs_error *error);
    /** As read, but *got is also 0 if nothing comes for a moment, and *ended tells whether that is the end. */
    adcgs_status (*take)(adcgs_transfer *transfer, void *buffer, size_t bytes, size_t *got, int *ended, adcgs_error *error);
} adcgs_curl;

/** The one thing that the module exports. */
ADCGS_MODULE_EXPORT extern const adcgs_curl adcgs_curl_table;

#endif
