/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The source of a stream that an operand names: a file, standard input ("-"), a
 * URL, or a page of adcgs-share, whose stream is read as if it were a file.
 */
#ifndef ADCGS_MEDIA_OPERAND_H
#define ADCGS_MEDIA_OPERAND_H

#include "media/page_stream.h"
#include "net/http.h"

#include <adcgs/decoder.h>

#include <stdio.h>

/** One of the members is not NULL while it is open. */
typedef struct adcgs_operand {
    const char *name; /**< for messages */
    FILE *file;
    adcgs_http *http;
    adcgs_page_stream *page;
} adcgs_operand;

/** Refuses a file of another kind than a stream (media/kind.h). path must outlive *out; http is for URLs. */
adcgs_status adcgs_operand_open(adcgs_operand *out, const char *path, const adcgs_http_config *http, adcgs_error *error);
/** Harmless if opening failed, and for {0}. */
void adcgs_operand_close(adcgs_operand *operand);
/** Size if any bytes can be read; 0 if they can only be read in order. */
uint64_t adcgs_operand_size(const adcgs_operand *operand);
/** An adcgs_read_fn; user is an adcgs_operand. */
int64_t adcgs_operand_read(void *user, void *buffer, size_t bytes);
/** An adcgs_read_at_fn; user is an adcgs_operand. */
int64_t adcgs_operand_read_at(void *user, uint64_t offset, void *buffer, size_t bytes);
/** If reading a URL failed: status becomes that failure's, and *error its message instead of the reader's. */
adcgs_status adcgs_operand_explain(const adcgs_operand *operand, adcgs_status status, adcgs_error *error);

/**
 * Opens a decoder of the stream at a path, no URL: as adcgs_open_file(), also for a page. Close *source after the decoder, also
 * after a failure.
 */
adcgs_status adcgs_operand_decode(adcgs_decoder **decoder, adcgs_operand *source, const char *path, const adcgs_config *config,
                                  adcgs_error *error);
/**
 * Loads the stream at a path, no URL, of at most limit bytes. The caller free()s *data. name, unless NULL, receives the name of
 * the stream's file, which the caller free()s.
 */
adcgs_status adcgs_operand_load(uint8_t **data, size_t *bytes, char **name, const char *path, uint64_t limit, adcgs_error *error);

#endif
