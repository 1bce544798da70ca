/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Times, names and repeated frames of all views of transforms files. */
#ifndef ADCGS_SCENE_LAYOUTS_TRANSFORMS_CHECK_H
#define ADCGS_SCENE_LAYOUTS_TRANSFORMS_CHECK_H

#include "scene/layouts/transforms.h"

/**
 * Checks all views, whose times are still as in the files:
 * - Times outside [0,1] are taken for seconds, frame numbers or other units: the first becomes 0, the last 1.
 * - Frames without times that seem to need some produce a remark.
 * - Names shared by views of one split are replaced by folder and file, front_00 for front/00.png.
 * - A frame for both training and testing is ADCGS_ERR_DATA; other repeated frames produce a remark.
 * facts: of the training views; is_single: one file has all splits. path: for messages.
 */
adcgs_status adcgs_transforms_check(adcgs_scene *scene, const adcgs_transforms *facts, int is_single, const char *path,
                                    adcgs_error *error);

#endif
