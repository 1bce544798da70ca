/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Detection of rigid bodies among the dynamic points, one after the other. A connected part of one frame is tracked as if it were
 * rigid. Points that follow the motion are removed, and the search continues with the rest (in the manner of Fischler and Bolles
 * 1981, Random sample consensus, CACM 24, with spatial parts in place of random samples). A body that explains too few points is
 * dropped: no body is better than a wrong one.
 */
#ifndef ADCGS_INIT_RIGID_BODY_SEARCH_H
#define ADCGS_INIT_RIGID_BODY_SEARCH_H

#include "init/rig.h"

/**
 * Finds at most `most` bodies among the moving points of out, marks their points, and sets out->n_bodies and out->body. Softens
 * the rig's images.
 */
adcgs_status adcgs_stereo_find_bodies(adcgs_stereo *out, adcgs_stereo_rig *rig, uint32_t most, adcgs_pool *pool,
                                      adcgs_error *error);

#endif
