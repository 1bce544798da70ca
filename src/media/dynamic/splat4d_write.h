/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writes .splat4d, version 1 (media/dynamic/splat4d.h), from splats that are sampled at the frames of a clip. */
#ifndef ADCGS_MEDIA_DYNAMIC_SPLAT4D_WRITE_H
#define ADCGS_MEDIA_DYNAMIC_SPLAT4D_WRITE_H

#include "media/dynamic/splat_clip.h"

/* Steps of the written bins. Origin: chosen by hand, not measured. */
#define ADCGS_SPLAT4D_STEP_LEVEL 1.0          /**< colours and opacities, 0 to 255 */
#define ADCGS_SPLAT4D_STEP_ROTATION 0.25      /**< components of quaternions times 128 */
#define ADCGS_SPLAT4D_STEP_SCALE (1.0 / 64.0) /**< natural logarithms of scales */

/**
 * Write a clip, without its offset. A value that changes is off by half a step at most. An attribute of a splat is static if
 * it stays within half a step of the first frame; it is off by a step at most, and a static rotation by 0.009 in a component.
 * Rows are sorted by the attributes that change, then along a Morton curve. Atomic. ADCGS_ERR_USAGE for frames of unequal
 * size, or a rate or a group out of range, ADCGS_ERR_UNSUPPORTED for zero splats or frames, positions beyond 2^29 steps, more
 * than ADCGS_PLANES_MAX bytes in a group, and in a build without zstd.
 */
adcgs_status adcgs_splat4d_write(const adcgs_splat_clip *clip, const char *path, adcgs_error *error);

#endif
