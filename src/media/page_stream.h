/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The stream in a page of adcgs-share: base 64 in the element
 * `<script id="scene">` of an HTML file. Opening reads the file once and checks
 * every letter. Any bytes of the stream can then be read, in constant memory.
 */
#ifndef ADCGS_MEDIA_PAGE_STREAM_H
#define ADCGS_MEDIA_PAGE_STREAM_H

#include "base/base.h"

typedef struct adcgs_page_stream adcgs_page_stream;

/** ADCGS_ERR_DATA if the page has no stream, or a damaged one; the message names the line. */
adcgs_status adcgs_page_stream_open(adcgs_page_stream **out, const char *path, adcgs_error *error);
/** *page may be NULL. */
void adcgs_page_stream_close(adcgs_page_stream **page);
/** Bytes of the stream, more than 0. */
uint64_t adcgs_page_stream_size(const adcgs_page_stream *page);
/** Name of the stream's file as the page stores it, without a folder; "" if it stores none. */
const char *adcgs_page_stream_name(const adcgs_page_stream *page);
/** An adcgs_read_fn; user is an adcgs_page_stream. */
int64_t adcgs_page_stream_read(void *user, void *buffer, size_t bytes);
/** An adcgs_read_at_fn; user is an adcgs_page_stream. */
int64_t adcgs_page_stream_read_at(void *user, uint64_t offset, void *buffer, size_t bytes);

#endif
