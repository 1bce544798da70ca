/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Random valid models and streams for tests: any parameters, small networks inside their bounds, random anchors, values quantised
 * along the walk of the latents. The seed determines everything.
 */
#ifndef ADCGS_TESTS_RANDOM_MODEL_H
#define ADCGS_TESTS_RANDOM_MODEL_H

#include "model/inter.h"
#include "stream/stream.h"

/** Counter-based random numbers (SplitMix64). */
uint64_t adcgs_random_next(uint64_t *state);
/** Uniform in [lo, hi]. */
int64_t adcgs_random_range(uint64_t *state, int64_t lo, int64_t hi);

/** Any valid parameters; moving: with a time table. */
void adcgs_random_params(adcgs_params *params, int moving, uint64_t *state);
/** The same for small streams with motion: two primitives, three channels of f_v, n_fg of f_g in two chunks. */
void adcgs_random_small_params(adcgs_params *params, int n_fg, uint64_t *state);
/** A valid model of n anchors in a cube of depth bits per axis (n <= 2^(3 depth)), times 0..1 s. Allocated without a memory. */
adcgs_status adcgs_random_model(adcgs_model *model, const adcgs_params *params, uint32_t n, int depth, uint64_t *state,
                                adcgs_error *error);
/** Puts all anchors into one tier, for tests of something else. */
void adcgs_random_one_tier(adcgs_model *model);
/**
 * A valid model that can be predicted from another: its anchors are some of the other's, unchanged or with differences, and at
 * most n new ones. Most of its networks are the other's.
 */
adcgs_status adcgs_random_follower(adcgs_model *model, const adcgs_model *before, uint32_t n, uint64_t *state,
                                   adcgs_error *error);
/** A stream of such models, some of them predicted, some with the networks of the model before; cameras and metadata. */
adcgs_status adcgs_random_stream(adcgs_stream *stream, const adcgs_params *params, uint32_t segments, uint32_t n, int depth,
                                 uint64_t *state, adcgs_error *error);
/** Stores one camera in front of the scene, without a time. */
adcgs_status adcgs_random_front(adcgs_stream *stream, adcgs_error *error);
/**
 * The segments of a stream whose parameters are set: every third a key of n anchors, the others predicted, each with at most
 * `added` new anchors; consecutive in time.
 */
adcgs_status adcgs_random_turns(adcgs_stream *stream, uint32_t segments, uint32_t n, int depth, uint32_t added, uint64_t *state,
                                adcgs_error *error);
/** Chooses all values of a model again along the walk, for its networks, flags and masks. */
adcgs_status adcgs_random_values(adcgs_model *model, uint64_t *state, adcgs_error *error);

/* Parts of a predicted model. */

/** A model without anchors and networks, predicted from another, with which it shares everything else. */
adcgs_model adcgs_random_frame(const adcgs_model *before);
/** Moves new anchors whose voxels are taken, by each other or by predicted anchors, to free ones; sorts them all. */
adcgs_status adcgs_random_settle(adcgs_model *added, const adcgs_inter *kept, const adcgs_model *before, adcgs_error *error);
/** Joins the predicted anchors of the model before with the new anchors that a model holds, in this model. */
adcgs_status adcgs_random_join(const adcgs_inter *kept, const adcgs_model *before, adcgs_model *model, adcgs_error *error);

#endif
