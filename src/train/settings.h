/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The settings of a run. One table is the source of presets, --set and its list, the man page, and the comparison in checkpoints.
 * A configuration starts as a preset, is changed by name, and is always checked as a whole by adcgs_train_check().
 */
#ifndef ADCGS_TRAIN_SETTINGS_H
#define ADCGS_TRAIN_SETTINGS_H

#include "bits/bytes.h"
#include "train/train_config.h"

#include <stdio.h>

#define ADCGS_PRESETS 5 /* number of presets; definition */

typedef enum adcgs_setting_kind {
    ADCGS_SETTING_REAL, /**< float */
    ADCGS_SETTING_INT,
    ADCGS_SETTING_UINT32,
    ADCGS_SETTING_UINT64,
    ADCGS_SETTING_UINT16,
    ADCGS_SETTING_UINT8,
} adcgs_setting_kind;

typedef enum adcgs_setting_group {
    ADCGS_SETTING_RUN,
    ADCGS_SETTING_LOSS,
    ADCGS_SETTING_MODEL,
    ADCGS_SETTING_NETWORKS,
    ADCGS_SETTING_STEPS,
    ADCGS_SETTING_ANCHORS,
    ADCGS_SETTING_TIMES,
    ADCGS_SETTING_SWITCHES, /**< changed by their own options, not by name */
} adcgs_setting_group;

/** The effects of a setting, as bits; definition. */
enum { ADCGS_AFFECTS_SPEED = 1, ADCGS_AFFECTS_BYTES = 2, ADCGS_AFFECTS_QUALITY = 4, ADCGS_AFFECTS_MEMORY = 8 };

/** Users change common settings, at most 20. Research settings are for experiments on the method. */
typedef enum adcgs_setting_class { ADCGS_SETTING_RESEARCH, ADCGS_SETTING_COMMON } adcgs_setting_class;

/** From when a setting binds a run. Before, a run may continue from a checkpoint with another value. */
typedef enum adcgs_setting_fixed { ADCGS_FIXED_ALWAYS, ADCGS_FIXED_WITH_LAMBDA, ADCGS_FIXED_WITH_ROUNDING } adcgs_setting_fixed;

typedef struct adcgs_setting {
    const char *name;
    adcgs_setting_kind kind; /**< of the field */
    size_t offset;           /**< of the field in the configuration */
    adcgs_setting_class class;
    adcgs_setting_group group;
    adcgs_setting_fixed fixed;
    int affects;
    double min, max;              /**< range */
    double preset[ADCGS_PRESETS]; /**< in the order of adcgs_train_presets */
    const char *help;             /**< one line without full stop */
} adcgs_setting;

/** The table, terminated by a name of NULL. */
extern const adcgs_setting adcgs_settings[];
/** A former name of a setting. --set understands it for one release. */
typedef struct adcgs_setting_former {
    const char *name, *now;
} adcgs_setting_former;
/** Former names, terminated by a name of NULL. */
extern const adcgs_setting_former adcgs_settings_former[];
/** Names of the presets, NULL-terminated, the fastest first. */
extern const char *const adcgs_train_presets[];

/** Maximum number of settings with names; definition, above the rows of the table. */
#define ADCGS_SETTING_NAMES ADCGS_SETTINGS_MAX
/** The names that adcgs_train_set() accepts, NULL-terminated. */
void adcgs_setting_names(const char *names[ADCGS_SETTING_NAMES + 1]);
/** Finds the row of a name, or of a former name; NULL if there is none. Names used by the program itself always exist. */
const adcgs_setting *adcgs_setting_find(const char *name);
/** Finds the next former name in a list for adcgs_train_set(), and moves *list behind its entry; NULL if there is none. */
const adcgs_setting_former *adcgs_setting_next_former(const char **list);
double adcgs_setting_get(const adcgs_setting *setting, const adcgs_train_config *config);
/** Sets a value, which must be valid, without recording its origin. */
void adcgs_setting_put(const adcgs_setting *setting, adcgs_train_config *config, double value);
/** True if the user gave the setting of this name. */
int adcgs_setting_is_given(const adcgs_train_config *config, const char *name);
/** True if the user gave any setting of the group. */
int adcgs_setting_group_is_given(const adcgs_train_config *config, adcgs_setting_group group);
/** True if a value is in range. The bounds are included, as decimals and as binary32. */
int adcgs_setting_may_be(const adcgs_setting *setting, double value);
/** True if the value equals the one of the configuration's preset. */
int adcgs_setting_is_preset(const adcgs_setting *setting, const adcgs_train_config *config);

#define ADCGS_SETTING_TEXT 32 /* bytes of a printed value; arithmetic: nine digits, sign and exponent fit */
/** Prints a value as its field holds it, with the fewest digits that restore it. */
const char *adcgs_setting_print(const adcgs_setting *setting, double value, char text[ADCGS_SETTING_TEXT]);

/** Fills in a preset; ADCGS_ERR_USAGE for an unknown name. */
adcgs_status adcgs_train_preset(adcgs_train_config *config, const char *name, adcgs_error *error);
/** Changes settings: "name=value,name=value". ADCGS_ERR_USAGE names a setting that is unknown or out of range. */
adcgs_status adcgs_train_set(adcgs_train_config *config, const char *text, adcgs_error *error);
/**
 * Changes one setting. Programs use it for their options (--lambda, --k, --max-anchors), which so mean the same as the settings.
 * A max_anchors below the preset's start_anchors lowers that too.
 */
adcgs_status adcgs_train_set_value(adcgs_train_config *config, const char *name, double value, adcgs_error *error);
/**
 * Leaves parts of the method out: names separated by commas (coarse, fine, deformation (coarse and fine), rate, densification,
 * anchors, removal, weight_steps, none). ADCGS_ERR_USAGE names an unknown part. Call it after all other settings, because
 * - without densification all max_anchors exist from the start: the initial cloud is dense, as in the paper's ablation;
 * - without anchors every primitive is an anchor with its own embedding and deformation (as in E-D3DGS): K anchors of one
 * primitive without f_g replace each anchor;
 * - without removal everything that has grown stays: every anchor with all its primitives and its motion, every hidden unit;
 * - without weight steps the weights of the rendering networks are stored as binary32, as in the paper.
 */
adcgs_status adcgs_train_leave_out(adcgs_train_config *config, const char *parts, adcgs_error *error);

/**
 * Checks the range of every setting and the relations between settings. ADCGS_ERR_USAGE names setting, value and range. A trainer
 * accepts only configurations that pass.
 */
adcgs_status adcgs_train_check(const adcgs_train_config *config, adcgs_error *error);

/**
 * Lists the settings that differ from the preset, except lambda, iterations and seed, as adcgs_train_set() accepts them; switches
 * too.
 */
adcgs_status adcgs_train_changes(const adcgs_train_config *config, adcgs_buffer *text, adcgs_error *error);
/** Writes a table of all settings with names: value, range, effects, meaning. Common settings are first. */
void adcgs_train_list(const adcgs_train_config *config, FILE *file);
/** Finds the value of a setting in a list for adcgs_train_set() or in a stream's metadata; NULL if it is missing. */
const char *adcgs_setting_in_list(const char *list, const char *name);

#endif
