/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats that are sampled at the frames of a clip, for writers. */
#ifndef ADCGS_MEDIA_DYNAMIC_SPLAT_CLIP_H
#define ADCGS_MEDIA_DYNAMIC_SPLAT_CLIP_H

#include "media/splats/splats.h"

#define ADCGS_CLIP_GROUP_MAX 64u /**< frames of a group; chosen by hand, not measured */
#define ADCGS_CLIP_STEPS 16.0    /**< steps of positions in the geometric mean of all scales; chosen by hand, not measured */
#define ADCGS_CLIP_BIN_MAX 536870912.0 /**< of a bin: 2^29, so that differences fit into 32 bits; arithmetic */

/** A clip: splats with the same rows in each frame. Opacity 0 hides a row. */
typedef struct adcgs_splat_clip {
    const adcgs_splats *frames; /**< [n_frames], of the same number of rows; harmonics and axes are not written */
    uint32_t n_frames;
    double fps;
    uint32_t group;   /**< frames of a group, which are decoded together, up to 64; 0: 10 */
    double step_mean; /**< of positions, in their unit; 0: chosen from the scales */
} adcgs_splat_clip;

/**
 * Check a clip, and set the step of its positions and their bounds. ADCGS_ERR_USAGE for frames of unequal size or offset, or a
 * rate or a group out of range, ADCGS_ERR_UNSUPPORTED for zero splats or frames, and positions beyond 2^29 steps.
 */
adcgs_status adcgs_splat_clip_check(const adcgs_splat_clip *clip, double *step, double low[3], double high[3], const char *path,
                                    adcgs_error *error);

#endif
