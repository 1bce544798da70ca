/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Heads of a web server's responses. */
#ifndef ADCGS_NET_HTTP_HEAD_H
#define ADCGS_NET_HTTP_HEAD_H

#include "base/base.h"

#define ADCGS_HTTP_UNKNOWN UINT64_MAX

/** The head of a response. */
typedef struct adcgs_http_head {
    int status;           /**< 200: the whole resource follows; 206: a range; 404, ... */
    uint64_t length;      /**< bytes of the body; ADCGS_HTTP_UNKNOWN: not given */
    uint64_t first, last; /**< the range; first is ADCGS_HTTP_UNKNOWN without one */
    uint64_t size;        /**< of the whole resource; ADCGS_HTTP_UNKNOWN: not given */
    char tag[128];        /**< ETag with its quotes; "": none, or one that is too long */
    char modified[64];    /**< Last-Modified; "": none */
} adcgs_http_head;

/** Parse a header line, trailing white space included. A response's first line resets *head. */
void adcgs_http_head_line(adcgs_http_head *head, const char *data, size_t n);

#endif
