/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Makes a stream of a finished training run. The encoder decodes the bytes again and compares the models before anyone reads
 * them.
 */
#ifndef ADCGS_ENCODE_ENCODE_H
#define ADCGS_ENCODE_ENCODE_H

#include "scene/part.h"
#include "stream/stream.h"
#include "train/trainer.h"

/** A line of the stream's metadata. */
typedef struct adcgs_encode_note {
    const char *key, *value;
} adcgs_encode_note;

/** Fills stream (cleared by the caller, also on failure) from the run. stored_cameras.h chooses the cameras. */
adcgs_status adcgs_encode_stream(adcgs_stream *stream, const adcgs_trainer *trainer, const adcgs_encode_note *notes,
                                 uint32_t n_notes, adcgs_error *error);

/**
 * The same for a scene of several parts, segment by segment. adcgs_encode_begin() makes a stream without segments, with room for
 * one segment of each part. adcgs_encode_segment() adds the next segment, from a run on that part of the scene.
 * adcgs_encode_place() adds a finished model, of an earlier run for example, and takes it over.
 */
adcgs_status adcgs_encode_begin(adcgs_stream *stream, const adcgs_scene *scene, const adcgs_cuts *cuts,
                                const adcgs_encode_note *notes, uint32_t n_notes, adcgs_error *error);
adcgs_status adcgs_encode_segment(adcgs_stream *stream, const adcgs_trainer *trainer, const adcgs_cuts *cuts, uint32_t part,
                                  adcgs_error *error);
/** Makes the model of a run on the time range begin to end of a scene, for a stream with that scene's time. Caller clears it. */
adcgs_status adcgs_encode_model(adcgs_model *model, const adcgs_stream *stream, const adcgs_trainer *trainer, double begin,
                                double end, adcgs_error *error);
/** Predicts a segment that was trained from the previous one from that segment (inter-segment prediction), if possible. */
adcgs_status adcgs_encode_predict(adcgs_model *model, const adcgs_model *before, adcgs_error *error);
void adcgs_encode_place(adcgs_stream *stream, const adcgs_cuts *cuts, uint32_t part, adcgs_model *model);

/** Serialises into out, decodes the bytes again and requires the same model, byte for byte. */
adcgs_status adcgs_encode_verified(adcgs_stream *stream, adcgs_buffer *out, adcgs_cpu_level cpu, adcgs_pool *pool,
                                   adcgs_error *error);

/** The hook that gives a trainer exact quantisation (adcgs_train_quantise). */
adcgs_status adcgs_encode_quantise_hook(const adcgs_fmodel *f, const adcgs_quantise_options *options, adcgs_error *error);

/**
 * Counts the bytes of the stream that adcgs_encode_stream() and adcgs_stream_write() would make with the same notes, if
 * adcgs_level_choose() decided the frozen values again with this strength. The count is exact, since it comes from the coder
 * itself. Nothing is changed or written. A call takes about as long as quantising and coding once, tens of milliseconds for a few
 * thousand anchors.
 *
 * More strength gives fewer bytes, but not strictly: choices are greedy, so equal or slightly more bytes are possible from one
 * strength to the next. A bisection therefore compares the bytes and assumes no order. A negative strength is allowed at any time
 * and counts with the current values. ADCGS_ERR_USAGE before the trainer is frozen.
 */
adcgs_status adcgs_encode_bytes(adcgs_bytes *bytes, const adcgs_trainer *trainer, double strength, const adcgs_encode_note *notes,
                                uint32_t n_notes, adcgs_error *error);

#endif
