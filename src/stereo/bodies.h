/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rigid bodies among what moves, one after the other: what hangs together at a moment is followed as if it were rigid, what
 * goes along is taken out, and the rest is looked at again (in the manner of Fischler and Bolles 1981, Random sample consensus,
 * CACM 24, with parts in space in place of random samples). A body that explains too little is dropped: none is better than a
 * wrong one.
 */
#ifndef ADCGS_STEREO_BODIES_H
#define ADCGS_STEREO_BODIES_H

#include "stereo/rig.h"

/** Find `most` bodies among what moves of out, mark their points, and set out->n_bodies and out->body. The rig is softened. */
adcgs_status adcgs_stereo_find_bodies(adcgs_stereo *out, adcgs_stereo_rig *rig, uint32_t most, adcgs_pool *pool,
                                      adcgs_error *error);

#endif
