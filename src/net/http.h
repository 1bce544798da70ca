/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reading from a web server, whole or by ranges, through libcurl in a module of
 * its own.
 *
 * Each range is a request of its own over a kept connection. A range has at
 * least 64 KiB, so that the headers of chunks, a few bytes each, do not cost a
 * request each. When reading continues behind a range, the next range is twice
 * as long, up to 1 MiB. So each jump reads at most 64 KiB in vain, and
 * sequential reading at most as much as was used. The last two ranges are
 * cached.
 *
 * Servers may be hostile. Only http and https are accepted; at most five
 * redirects are followed, and none from https to http. A request fails after 15
 * seconds without a connection, and when 30 seconds bring less than 1 KiB.
 * Response headers are limited to 64 KiB. A resource may have at most 64 GiB,
 * the size of the longest stream, and the total read of it has the same limit.
 * The cache takes at most 2 MiB, in addition to libcurl's memory. Loading a
 * whole resource allocates memory as bytes arrive.
 */
#ifndef ADCGS_NET_HTTP_H
#define ADCGS_NET_HTTP_H

#include "base/base.h"

typedef struct adcgs_http adcgs_http;

typedef struct adcgs_http_config {
    uint64_t limit;           /**< read at most this many bytes, from the first on; 0: all */
    int any_order;            /**< bytes at any position will be read; else each once, in order */
    int (*interrupted)(void); /**< true to give up; NULL: never */
} adcgs_http_config;

/** True if a name begins with http:// or https://. A file of such a name can be given as ./http: and so on. */
int adcgs_is_url(const char *name);

/**
 * Request a URL and wait for the first bytes. ADCGS_ERR_UNSUPPORTED without libcurl. ADCGS_ERR_IO without a server or a resource,
 * or for an unusable response. Messages begin with the URL.
 */
adcgs_status adcgs_http_open(adcgs_http **out, const char *url, const adcgs_http_config *config, adcgs_error *error);
/** *http may be NULL. */
void adcgs_http_close(adcgs_http **http);

/** Size, if adcgs_http_read_at() can read any of its bytes; 0 if only adcgs_http_read() works, in order. */
uint64_t adcgs_http_size(const adcgs_http *http);
/** An adcgs_read_fn; user is an adcgs_http. */
int64_t adcgs_http_read(void *user, void *buffer, size_t bytes);
/**
 * As adcgs_http_read(), but waits only a short time: *got is 0 if no byte came, and at the end, which sets *ended. ADCGS_ERR_IO
 * if reading fails.
 */
adcgs_status adcgs_http_take(adcgs_http *http, void *buffer, size_t bytes, size_t *got, int *ended, adcgs_error *error);
/** An adcgs_read_at_fn; user is an adcgs_http. Fails if the resource changes between two ranges. */
int64_t adcgs_http_read_at(void *user, uint64_t offset, void *buffer, size_t bytes);
/** If one of these functions failed: status becomes that failure's, and *error its message instead of the reader's. */
adcgs_status adcgs_http_explain(const adcgs_http *http, adcgs_status status, adcgs_error *error);

/** Maximum number of bytes that adcgs_http_load() loads; chosen by hand, not measured. */
#define ADCGS_HTTP_LOAD_MAX (UINT64_C(1) << 30)
/** The number of useful bytes, from the first on, of a file that begins with these bytes. */
typedef uint64_t (*adcgs_http_useful_fn)(const uint8_t *data, size_t bytes);
/**
 * Load all useful bytes. The caller free()s *data, which is not NULL. Reading ends behind the useful bytes. ADCGS_ERR_LIMIT for
 * more than ADCGS_HTTP_LOAD_MAX bytes.
 */
adcgs_status adcgs_http_load(uint8_t **data, size_t *bytes, const char *url, adcgs_http_useful_fn useful,
                             int (*interrupted)(void), adcgs_error *error);

#endif
