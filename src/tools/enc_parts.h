/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What a run of several segments leaves on the disk while it lasts: of segment N, from 1, first its checkpoint, BASE.N, and in
 * its place, once it is learnt, a stream of this segment alone, BASE.N.adcgs, which plays like any other. The file that was
 * asked for is put together from these.
 */
#ifndef ADCGS_TOOLS_ENC_PARTS_H
#define ADCGS_TOOLS_ENC_PARTS_H

#include "encode/encode.h"

/** Name of segment part's (from 0) checkpoint, or of its stream. The caller frees it with free(). */
adcgs_status adcgs_enc_part_name(char **name, const char *base, uint32_t part, int is_stream, adcgs_error *error);

/** Name of the file that says that a run has what is learnt by the name of `state`. */
adcgs_status adcgs_enc_claim_name(char **name, const char *state, adcgs_error *error);

/** Read a stream of one part, initialised by the caller; *found: 0 if there is no such file. Messages name it. */
adcgs_status adcgs_enc_part_load(adcgs_stream *stream, const char *name, adcgs_cpu_level cpu, adcgs_pool *pool, int *found,
                                 adcgs_error *error);

/** Write a part's stream and remove its checkpoint. */
adcgs_status adcgs_enc_part_save(const char *base, const adcgs_cuts *cuts, uint32_t part, const adcgs_trainer *trainer,
                                 const adcgs_encode_note *notes, uint32_t n_notes, adcgs_pool *pool, adcgs_error *error);

/**
 * Whether a part's stream is there, *found, and is one of this run: its place and time, and all its notes but lambda are as they
 * would be now. ADCGS_ERR_DATA, naming the file, if it is another's.
 */
adcgs_status adcgs_enc_part_check(const char *base, const adcgs_scene *scene, const adcgs_cuts *cuts, uint32_t part,
                                  const adcgs_encode_note *notes, uint32_t n_notes, adcgs_cpu_level cpu, adcgs_pool *pool,
                                  int *found, adcgs_error *error);

/**
 * Wait until a part's stream that another machine has written is seen here: a shared file system may be a minute late with what
 * it said was not there.
 */
void adcgs_enc_part_await(const char *base, uint32_t part);

/** The model of a part's stream, which adcgs_model_clear() frees. */
adcgs_status adcgs_enc_part_model(adcgs_model *model, const char *base, uint32_t part, adcgs_cpu_level cpu, adcgs_pool *pool,
                                  adcgs_error *error);

/**
 * Put the parts' streams together, in stream, cleared by the caller, also on failure; notes are those of the last part.
 * follows: [parts] 1 for those that were learnt from the one before, which become predicted segments.
 */
adcgs_status adcgs_enc_parts_join(adcgs_stream *stream, const char *base, const adcgs_scene *scene, const adcgs_cuts *cuts,
                                  const uint8_t *follows, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);

/** Remove a part's stream, or its checkpoint, if it is there. */
void adcgs_enc_part_remove(const char *base, uint32_t part, int is_stream);
/** Remove the parts' streams. */
void adcgs_enc_parts_remove(const char *base, uint32_t n);

#endif
