/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reading what a web server has, whole or by ranges, through libcurl in a module of its own.
 *
 * A range is read by a request of its own over a connection that is kept. It is of at least 64 KiB, so that the headers of
 * chunks, which are a few bytes each, do not cost a request each; where reading goes on behind it, each is twice as long as the
 * one before, up to 1 MiB. So what is read without need is 64 KiB for each place that is jumped to, and else no more than what
 * was of use. The last range and one before it stay at hand.
 *
 * Servers may be hostile. http and https are all that is spoken, redirects are followed five times, and never from https to
 * http. Waiting ends 15 s without a connection, and where 30 s bring less than 1 KiB. Heads of answers end at 64 KiB. Nothing
 * is longer than the 64 GiB that the longest stream has, and no more is read of it in all, however it is asked for. What is
 * at hand takes 2 MiB at most, besides libcurl's own; what is loaded whole takes memory as bytes arrive.
 */
#ifndef ADCGS_IO_HTTP_H
#define ADCGS_IO_HTTP_H

#include "base/base.h"

typedef struct adcgs_http adcgs_http;

typedef struct adcgs_http_config {
    uint64_t limit;           /**< read no more than so many bytes, from the first on; 0: all */
    int any_order;            /**< bytes at any place will be asked for; else they are asked for once, in order */
    int (*interrupted)(void); /**< whether to give up; NULL: never */
} adcgs_http_config;

/** Does a name begin with http:// or https://? A file that is called so is ./http: and so on. */
int adcgs_is_url(const char *name);

/**
 * Ask for what the URL names and wait for the first bytes. ADCGS_ERR_UNSUPPORTED without libcurl; ADCGS_ERR_IO where there is no
 * server, no such thing, or an answer that cannot be used. Messages begin with the URL.
 */
adcgs_status adcgs_http_open(adcgs_http **out, const char *url, const adcgs_http_config *config, adcgs_error *error);
/** Accepts what is NULL. */
void adcgs_http_close(adcgs_http **http);

/** Bytes there are, all of which adcgs_http_read_at() gives; 0 if they come in order only, by adcgs_http_read(). */
uint64_t adcgs_http_size(const adcgs_http *http);
/** An adcgs_read_fn; user is an adcgs_http. */
int64_t adcgs_http_read(void *user, void *buffer, size_t bytes);
/**
 * As adcgs_http_read(), but waits a moment at most: *got is 0 if nothing came meanwhile, and at the end, which sets *ended.
 * ADCGS_ERR_IO if reading fails.
 */
adcgs_status adcgs_http_take(adcgs_http *http, void *buffer, size_t bytes, size_t *got, int *ended, adcgs_error *error);
/** An adcgs_read_at_fn; user is an adcgs_http. That what it names changes between two ranges is a failure. */
int64_t adcgs_http_read_at(void *user, uint64_t offset, void *buffer, size_t bytes);
/** Where one of these failed: status becomes that failure's, and error tells it instead of what the reader made of it. */
adcgs_status adcgs_http_explain(const adcgs_http *http, adcgs_status status, adcgs_error *error);

/** Bytes that adcgs_http_load() takes at most. */
#define ADCGS_HTTP_LOAD_MAX (UINT64_C(1) << 30)
/** The number of useful bytes, from the first on, of a file that begins with these. */
typedef uint64_t (*adcgs_http_useful_fn)(const uint8_t *data, size_t bytes);
/**
 * All useful bytes, in memory; the caller free()s *data, which is not NULL. Reading ends behind them. ADCGS_ERR_LIMIT if more
 * than ADCGS_HTTP_LOAD_MAX come.
 */
adcgs_status adcgs_http_load(uint8_t **data, size_t *bytes, const char *url, adcgs_http_useful_fn useful,
                             int (*interrupted)(void), adcgs_error *error);

#endif
