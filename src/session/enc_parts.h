/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Temporary files of a run of several segments. Segment N, from 1, first has a checkpoint, BASE.N. When it is trained, a stream
 * of this segment alone replaces the checkpoint, BASE.N.adcgs, and plays like any other. The run joins these streams to its
 * output.
 */
#ifndef ADCGS_SESSION_ENC_PARTS_H
#define ADCGS_SESSION_ENC_PARTS_H

#include "encode/encode.h"

/** Returns the name of a segment's checkpoint, or of its stream; part counts from 0. The caller frees it with free(). */
adcgs_status adcgs_enc_part_name(char **name, const char *base, uint32_t part, int is_stream, adcgs_error *error);

/** Returns the name of the file by which a run claims the state `state`. */
adcgs_status adcgs_enc_claim_name(char **name, const char *state, adcgs_error *error);

/** Reads a stream of one part, initialised by the caller. *found: 0 if there is no such file. Messages name the file. */
adcgs_status adcgs_enc_part_load(adcgs_stream *stream, const char *name, adcgs_cpu_level cpu, adcgs_pool *pool, int *found,
                                 adcgs_error *error);

/** Writes a part's stream and removes its checkpoint. */
adcgs_status adcgs_enc_part_save(const char *base, const adcgs_cuts *cuts, uint32_t part, const adcgs_trainer *trainer,
                                 const adcgs_encode_note *notes, uint32_t n_notes, adcgs_pool *pool, adcgs_error *error);

/**
 * Checks whether a part's stream is present, *found, and belongs to this run: its place and time, and all its notes except lambda
 * have to match. ADCGS_ERR_DATA, naming the file, if it belongs to another run.
 */
adcgs_status adcgs_enc_part_check(const char *base, const adcgs_scene *scene, const adcgs_cuts *cuts, uint32_t part,
                                  const adcgs_encode_note *notes, uint32_t n_notes, adcgs_cpu_level cpu, adcgs_pool *pool,
                                  int *found, adcgs_error *error);

/**
 * Waits until a part's stream, written by another machine, is visible here. A shared file system may show a file a minute late if
 * it was asked for it before.
 */
void adcgs_enc_part_await(const char *base, uint32_t part);

/** Returns the model of a part's stream, which adcgs_model_clear() frees. */
adcgs_status adcgs_enc_part_model(adcgs_model *model, const char *base, uint32_t part, adcgs_cpu_level cpu, adcgs_pool *pool,
                                  adcgs_error *error);

/**
 * Joins the parts' streams in stream, which the caller clears, also on failure. Its notes are those of the last part. follows:
 * [parts] 1 for parts trained from the previous one, which become predicted segments.
 */
adcgs_status adcgs_enc_parts_join(adcgs_stream *stream, const char *base, const adcgs_scene *scene, const adcgs_cuts *cuts,
                                  const uint8_t *follows, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);

/** Removes a part's stream, or its checkpoint, if present. */
void adcgs_enc_part_remove(const char *base, uint32_t part, int is_stream);
/** Removes the parts' streams. */
void adcgs_enc_parts_remove(const char *base, uint32_t n);

#endif
