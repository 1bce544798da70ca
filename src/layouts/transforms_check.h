/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Times, names and repeated frames of all views of transforms files. */
#ifndef ADCGS_LAYOUTS_TRANSFORMS_CHECK_H
#define ADCGS_LAYOUTS_TRANSFORMS_CHECK_H

#include "layouts/transforms.h"

/**
 * Of views whose times are still those of the files:
 * - times that go beyond [0,1] are taken for seconds, numbers of frames or other units: the first becomes 0, the last 1;
 * - frames without times that look as if they should have some are remarked;
 * - names that views of one split share become those of their folders and files, front_00 for front/00.png;
 * - a frame for training and for testing is ADCGS_ERR_DATA; other frames that come twice are remarked.
 * facts: of the views for training; is_single: one file has all splits. path: for messages.
 */
adcgs_status adcgs_transforms_check(adcgs_scene *scene, const adcgs_transforms *facts, int is_single, const char *path,
                                    adcgs_error *error);

#endif
