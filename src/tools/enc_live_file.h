/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Where a live stream goes: a file that grows, or a pipe. A file is put in order when its stream ends: HEAD then says how long it
 * is. A further stream goes to a file of its own, name.2.adcgs and so on; in a pipe they follow each other.
 */
#ifndef ADCGS_TOOLS_ENC_LIVE_FILE_H
#define ADCGS_TOOLS_ENC_LIVE_FILE_H

#include "bits/bytes.h"
#include "io/growing.h"

typedef struct adcgs_enc_live_file {
    const char *name;  /**< as it was given */
    char *path;        /**< of the stream at hand; NULL: not open */
    uint32_t number;   /**< of streams so far */
    adcgs_growing growing;
} adcgs_enc_live_file;

/**
 * name: a file, or "-" for standard output. past: the stream to go on with, which has this name or that of a further one
 * (ADCGS_ERR_USAGE if not), and stays as it is until file->growing.is_hidden is taken back; or NULL.
 */
adcgs_status adcgs_enc_live_file_open(adcgs_enc_live_file *file, const char *name, const char *past, adcgs_error *error);
adcgs_status adcgs_enc_live_file_append(adcgs_enc_live_file *file, const void *data, size_t bytes, adcgs_error *error);
/** The stream is complete; head: the payload of its HEAD, now that its end is known. A file that cannot be put in order stays. */
adcgs_status adcgs_enc_live_file_end(adcgs_enc_live_file *file, const adcgs_buffer *head, adcgs_error *error);
/** Go on with another stream. */
adcgs_status adcgs_enc_live_file_next(adcgs_enc_live_file *file, adcgs_error *error);
void adcgs_enc_live_file_close(adcgs_enc_live_file *file);

#endif
