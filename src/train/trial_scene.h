/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Training views held back from a trial, by which the trial is judged. */
#ifndef ADCGS_TRAIN_TRIAL_SCENE_H
#define ADCGS_TRAIN_TRIAL_SCENE_H

#include "data/scene.h"

/** Views that judge a trial, at most; and training views that a trial has, at most. */
enum { ADCGS_TRIAL_JUDGES = 16, ADCGS_TRIAL_VIEWS = 512 };

/**
 * A scene of training views alone: scene.views[TRAIN] are trained on, scene.views[VAL] judge. Shares all else with the scene that
 * it was made of, which must outlive it. Zero-initialise before use.
 */
typedef struct adcgs_trial_scene {
    adcgs_scene scene;
} adcgs_trial_scene;

/**
 * Hold views back. Where at least five cameras have four images or more in the mean, one camera in eight is held back with all
 * of its images: a gain or a floater of a camera shows in that camera's own images alone. Else one image in eight is. A scene
 * with more than ADCGS_TRIAL_VIEWS training views gives a stretch in the middle of its time. Views for validation and testing
 * are never looked at. A scene of fewer than 12 training views is too small for a trial: the result has no views.
 */
adcgs_status adcgs_trial_scene_make(adcgs_trial_scene *out, const adcgs_scene *scene, adcgs_error *error);
void adcgs_trial_scene_clear(adcgs_trial_scene *trial);

#endif
