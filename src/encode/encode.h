/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From a finished training run to a stream, proven before anybody sees it: the
 * bytes are decoded again and the model compared.
 */
#ifndef ADCGS_ENCODE_ENCODE_H
#define ADCGS_ENCODE_ENCODE_H

#include "model/stream.h"
#include "train/trainer.h"

#define ADCGS_ENCODE_CAMERAS_MAX 8

/** A line of the stream's metadata. */
typedef struct adcgs_encode_note {
    const char *key, *value;
} adcgs_encode_note;

/**
 * Fill stream (cleared by the caller, also on failure) from the run. At most ADCGS_ENCODE_CAMERAS_MAX training cameras
 * are stored.
 */
adcgs_status adcgs_encode_stream(adcgs_stream *stream, const adcgs_trainer *trainer, const adcgs_encode_note *notes,
                                 uint32_t n_notes, adcgs_error *error);

/** Serialise into out, decode that again and require the same model, byte for byte. */
adcgs_status adcgs_encode_verified(adcgs_stream *stream, adcgs_buffer *out, adcgs_cpu_level cpu, adcgs_pool *pool,
                                   adcgs_error *error);

/** The hook that gives a trainer exact quantisation; user: the trainer's resolved CPU level, adcgs_cpu_level *. */
adcgs_status adcgs_encode_quantise_hook(void *user, const adcgs_fmodel *f, float *const mu[ADCGS_P_ANCHOR],
                                        float *const value[ADCGS_P_ANCHOR], adcgs_error *error);

#endif
