/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Table of the module with libcurl. The module sends requests, waits, and
 * reports the head of a response. The front (http.c) decides on requests and on
 * the use of responses.
 */
#ifndef ADCGS_NET_HTTP_CURL_H
#define ADCGS_NET_HTTP_CURL_H

#include "net/http_head.h"
#include "system/module.h"

/** A connection with at most one response being read. */
typedef struct adcgs_transfer adcgs_transfer;

typedef struct adcgs_curl {
    const char *version; /**< version of the programs that the module belongs to */
    /** url must outlive the transfer. */
    adcgs_status (*open)(adcgs_transfer **out, const char *url, int (*interrupted)(void), adcgs_error *error);
    void (*close)(adcgs_transfer **transfer);
    /**
     * Send a request and wait for the response's head; drops a response that has not been read to its end. range: "0-65535",
     * NULL: the whole resource. same: an ETag or a date; if the resource has changed, the whole is sent. NULL: the range in any
     * case.
     */
    adcgs_status (*ask)(adcgs_transfer *transfer, const char *range, const char *same, adcgs_http_head *head, adcgs_error *error);
    /** Wait for bytes of the body: *got of them, at most `bytes`; 0 at its end. */
    adcgs_status (*read)(adcgs_transfer *transfer, void *buffer, size_t bytes, size_t *got, adcgs_error *error);
    /** As read, but *got is also 0 if no byte comes for a short time; *ended is true at the end. */
    adcgs_status (*take)(adcgs_transfer *transfer, void *buffer, size_t bytes, size_t *got, int *ended, adcgs_error *error);
} adcgs_curl;

/** The module's only exported symbol. */
ADCGS_MODULE_EXPORT extern const adcgs_curl adcgs_curl_table;

#endif
