/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Training views held out from a trial, for its evaluation. */
#ifndef ADCGS_TRAIN_TRIAL_TRIAL_SCENE_H
#define ADCGS_TRAIN_TRIAL_TRIAL_SCENE_H

#include "scene/scene.h"

/** Maximum number of held-out views, and of training views of a trial; chosen by hand, not measured. */
enum { ADCGS_TRIAL_JUDGES = 16, ADCGS_TRIAL_VIEWS = 512 };

/**
 * A scene of training views only: scene.views[TRAIN] are trained on, scene.views[VAL] are held out. It shares everything else
 * with its source scene, which must outlive it. Zero-initialise before use.
 */
typedef struct adcgs_trial_scene {
    adcgs_scene scene;
} adcgs_trial_scene;

/**
 * Holds views out. With at least five cameras and four images per camera on average, one camera in eight is held out with all its
 * images: a wrong gain or a floater of a camera shows only in that camera's images. Otherwise one image in eight is held out. A
 * scene with more than ADCGS_TRIAL_VIEWS training views is cut to an interval in the middle of its time. Views for validation and
 * testing are never used. A scene with fewer than 12 training views is too small for a trial: the result has no views.
 */
adcgs_status adcgs_trial_scene_make(adcgs_trial_scene *out, const adcgs_scene *scene, adcgs_error *error);
void adcgs_trial_scene_clear(adcgs_trial_scene *trial);

#endif
