/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From a finished training run to a stream, proven before anybody sees it: the
 * bytes are decoded again and the model compared.
 */
#ifndef ADCGS_ENCODE_ENCODE_H
#define ADCGS_ENCODE_ENCODE_H

#include "data/part.h"
#include "stream/stream.h"
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

/**
 * The same for a scene of several parts, segment by segment: a stream with all but the segments, with room for one of each part;
 * the next of them, from a run on that part of the scene; or as a model that it takes over, as of a run that ended before.
 */
adcgs_status adcgs_encode_begin(adcgs_stream *stream, const adcgs_scene *scene, const adcgs_cuts *cuts,
                                const adcgs_encode_note *notes, uint32_t n_notes, adcgs_error *error);
adcgs_status adcgs_encode_segment(adcgs_stream *stream, const adcgs_trainer *trainer, const adcgs_cuts *cuts, uint32_t part,
                                  adcgs_error *error);
/** The model of a run on a stretch of a scene, for a stream that has the scene's time. The caller clears it. */
adcgs_status adcgs_encode_model(adcgs_model *model, const adcgs_stream *stream, const adcgs_trainer *trainer, double begin,
                                double end, adcgs_error *error);
/** Have a segment that was learnt from the one before be coded by what it shares with it, if it can be. */
adcgs_status adcgs_encode_predict(adcgs_model *model, const adcgs_model *before, adcgs_error *error);
void adcgs_encode_place(adcgs_stream *stream, const adcgs_cuts *cuts, uint32_t part, adcgs_model *model);

/** Serialise into out, decode that again and require the same model, byte for byte. */
adcgs_status adcgs_encode_verified(adcgs_stream *stream, adcgs_buffer *out, adcgs_cpu_level cpu, adcgs_pool *pool,
                                   adcgs_error *error);

/** The hook that gives a trainer exact quantisation (adcgs_train_quantise). */
adcgs_status adcgs_encode_quantise_hook(const adcgs_fmodel *f, const adcgs_quantise_options *options, adcgs_error *error);

/**
 * Bytes of the stream that adcgs_encode_stream() and adcgs_stream_write() would make, with the same notes, if the frozen values
 * were decided anew by adcgs_level_choose() with this strength: exact, from the coder itself; nothing is changed or written.
 * Takes about as long as quantising and coding once, tens of milliseconds for a few thousand anchors. More strength gives
 * fewer bytes, but not strictly: choices are greedy, so equal or slightly more is possible from one strength to the next; who
 * bisects compares with the bytes, not with an order. ADCGS_ERR_USAGE before the trainer is frozen. A negative strength, at any
 * time: with the values as they stand.
 */
adcgs_status adcgs_encode_bytes(adcgs_bytes *bytes, const adcgs_trainer *trainer, double strength, const adcgs_encode_note *notes,
                                uint32_t n_notes, adcgs_error *error);

#endif
