/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Output of a live stream: a growing file, or a pipe. At the end of its stream, HEAD of a file is rewritten with the duration. A
 * further stream gets a file of its own, name.2.adcgs and so on; in a pipe the streams follow each other.
 */
#ifndef ADCGS_SESSION_ENC_LIVE_FILE_H
#define ADCGS_SESSION_ENC_LIVE_FILE_H

#include "bits/bytes.h"
#include "system/growing.h"

typedef struct adcgs_enc_live_file {
    const char *name; /**< as given */
    char *path;       /**< of the current stream; NULL: not open */
    uint32_t number;  /**< streams so far */
    adcgs_growing growing;
} adcgs_enc_live_file;

/**
 * name: a file, or "-" for standard output. past: the stream to continue, or NULL. It has this name or that of a further stream,
 * else ADCGS_ERR_USAGE. Its file stays unchanged until file->growing.is_hidden is reset.
 */
adcgs_status adcgs_enc_live_file_open(adcgs_enc_live_file *file, const char *name, const char *past, adcgs_error *error);
adcgs_status adcgs_enc_live_file_append(adcgs_enc_live_file *file, const void *data, size_t bytes, adcgs_error *error);
/**
 * Completes the stream. head: the payload of its HEAD, now that its end is known. A file whose HEAD cannot be rewritten stays.
 */
adcgs_status adcgs_enc_live_file_end(adcgs_enc_live_file *file, const adcgs_buffer *head, adcgs_error *error);
/** Continues with another stream. */
adcgs_status adcgs_enc_live_file_next(adcgs_enc_live_file *file, adcgs_error *error);
void adcgs_enc_live_file_close(adcgs_enc_live_file *file);

#endif
