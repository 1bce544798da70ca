/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Mechanisms that follow from the scene, each with the setting that turns it off: the subject of trials (trial.h). */
#ifndef ADCGS_TRAIN_TRIAL_MECHANISMS_H
#define ADCGS_TRAIN_TRIAL_MECHANISMS_H

typedef enum adcgs_mechanism {
    ADCGS_MECHANISM_NONE = -1,
    ADCGS_MATCHING = 0,
    ADCGS_GAINS,
    ADCGS_BLACK_LEVELS,
    ADCGS_LIFETIMES,
    ADCGS_BODIES,
    ADCGS_SQUARES,
    ADCGS_SCALE_PRICE,
    ADCGS_RETIMING,
    ADCGS_RESIDUALS,
    ADCGS_FLOATERS,
    ADCGS_STATIC_ANCHORS,
    ADCGS_MECHANISMS
} adcgs_mechanism;

/** As in "without NAME". */
extern const char *const adcgs_mechanism_names[ADCGS_MECHANISMS];
/** The setting of each mechanism; 0 turns it off. */
extern const char *const adcgs_mechanism_settings[ADCGS_MECHANISMS];

/** True if a mechanism was dropped, by the text of adcgs_trials_format() (" dropped=NAME,NAME"). */
int adcgs_mechanism_is_dropped(int mechanism, const char *trials);

#endif
