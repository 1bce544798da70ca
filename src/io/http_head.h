/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What a web server's answer says of itself before its body. */
#ifndef ADCGS_IO_HTTP_HEAD_H
#define ADCGS_IO_HTTP_HEAD_H

#include "base/base.h"

#define ADCGS_HTTP_UNKNOWN UINT64_MAX

/** What an answer says of itself before its body. */
typedef struct adcgs_http_head {
    int status;           /**< 200: all of it follows; 206: a range; 404, ... */
    uint64_t length;      /**< bytes of the body; ADCGS_HTTP_UNKNOWN: it does not say */
    uint64_t first, last; /**< the range; first is ADCGS_HTTP_UNKNOWN if none is named */
    uint64_t size;        /**< of all of it; ADCGS_HTTP_UNKNOWN: it does not say */
    char tag[128];        /**< ETag with its quotes; "": none, or one that is too long */
    char modified[64];    /**< Last-Modified; "": none */
} adcgs_http_head;

/** Take what a line says, white space and all; the first of an answer forgets what was said before. */
void adcgs_http_head_line(adcgs_http_head *head, const char *data, size_t n);

#endif
