/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writes .4dgs, version 1 draft (media/dynamic/fourdgs.h), of the model keyframe-delta. */
#ifndef ADCGS_MEDIA_DYNAMIC_FOURDGS_WRITE_H
#define ADCGS_MEDIA_DYNAMIC_FOURDGS_WRITE_H

#include "media/dynamic/splat_clip.h"

/* Steps of the written bins. Origin: chosen by hand, not measured. */
#define ADCGS_FOURDGS_STEP_LEVEL (1.0 / 255.0)    /**< colours and opacities */
#define ADCGS_FOURDGS_STEP_ROTATION (1.0 / 512.0) /**< the three smaller components of quaternions */
#define ADCGS_FOURDGS_STEP_SCALE (1.0 / 64.0)     /**< natural logarithms of scales */

/**
 * Write a clip: a keyframe at the beginning of each group, and changes to the frame before in each other one. Row i gets the id
 * i; a hidden row keeps its id, with opacity 0. A frame is shown until the next one, the last for as long. All values are off
 * by half a step at most. Positions are relative to the offset, which the file stores. Atomic. Errors of
 * adcgs_splat_clip_check(), and ADCGS_ERR_UNSUPPORTED in a build without zlib.
 */
adcgs_status adcgs_fourdgs_write(const adcgs_splat_clip *clip, const char *path, adcgs_error *error);

#endif
