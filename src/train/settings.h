/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The settings of a run: one table, from which presets, --set, its list, the man page and what a checkpoint compares are
 * made. A configuration begins as a preset, is changed by name, and is checked as a whole, always by adcgs_train_check().
 */
#ifndef ADCGS_TRAIN_SETTINGS_H
#define ADCGS_TRAIN_SETTINGS_H

#include "bits/bytes.h"
#include "train/config.h"

#include <stdio.h>

#define ADCGS_PRESETS 5

typedef enum adcgs_setting_kind {
    ADCGS_SETTING_REAL,   /**< float */
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
    ADCGS_SETTING_MOMENTS,
    ADCGS_SETTING_SWITCHES, /**< changed by options of their own, not by name */
} adcgs_setting_group;

/** What a setting trades against each other. */
enum { ADCGS_TRADES_SPEED = 1, ADCGS_TRADES_BYTES = 2, ADCGS_TRADES_QUALITY = 4, ADCGS_TRADES_MEMORY = 8 };

/** From when on a run is bound to a setting: before, it may go on from a checkpoint with another value. */
typedef enum adcgs_setting_binds { ADCGS_BINDS_ALWAYS, ADCGS_BINDS_WITH_LAMBDA, ADCGS_BINDS_WITH_ROUNDING } adcgs_setting_binds;

typedef struct adcgs_setting {
    const char *name;
    adcgs_setting_kind kind;       /**< of the field */
    size_t offset;                 /**< of the field in the configuration */
    size_t own;                    /**< of the field, a byte, that says that it was chosen by hand; 0: none */
    adcgs_setting_group group;
    adcgs_setting_binds binds;
    int trades;
    double min, max;               /**< what it may be */
    double preset[ADCGS_PRESETS];  /**< in the order of adcgs_train_presets */
    const char *help;              /**< one line without full stop */
} adcgs_setting;

/** The table, ended by a name of NULL. */
extern const adcgs_setting adcgs_settings[];
/** Names of the presets, NULL-terminated, quickest first. */
extern const char *const adcgs_train_presets[];

/** Most settings that have names. */
#define ADCGS_SETTING_NAMES 120
/** The names of all that adcgs_train_set() changes, ended by NULL. */
void adcgs_setting_names(const char *names[ADCGS_SETTING_NAMES + 1]);
/** The row of that name; NULL if there is none. Names of the program itself are always there. */
const adcgs_setting *adcgs_setting_find(const char *name);
double adcgs_setting_get(const adcgs_setting *setting, const adcgs_train_config *config);
/** The value is one that it may have; nothing says that it was chosen by hand. */
void adcgs_setting_put(const adcgs_setting *setting, adcgs_train_config *config, double value);
/** Whether a value is in its range: the bounds themselves are, as decimals and as binary32. */
int adcgs_setting_may_be(const adcgs_setting *setting, double value);
/** Whether it is what the configuration's preset says. */
int adcgs_setting_is_preset(const adcgs_setting *setting, const adcgs_train_config *config);

#define ADCGS_SETTING_TEXT 32
/** A value as its field holds it, in the fewest digits that give it again. */
const char *adcgs_setting_print(const adcgs_setting *setting, double value, char text[ADCGS_SETTING_TEXT]);

/** Fill in a preset; ADCGS_ERR_USAGE for an unknown name. */
adcgs_status adcgs_train_preset(adcgs_train_config *config, const char *name, adcgs_error *error);
/** Change settings: "name=value,name=value"; ADCGS_ERR_USAGE names what is unknown or out of range. */
adcgs_status adcgs_train_set(adcgs_train_config *config, const char *text, adcgs_error *error);
/**
 * Change one: what programs' options of their own (--lambda, --k, --max-anchors) do, so that they mean what the setting means.
 * A budget of anchors below the preset's start lowers this too.
 */
adcgs_status adcgs_train_set_value(adcgs_train_config *config, const char *name, double value, adcgs_error *error);
/**
 * Leave parts of the method out: names separated by commas (coarse, fine, deformation: both of these, rate, densification,
 * anchors, removal, weight_steps, none); ADCGS_ERR_USAGE names what is unknown. To be called when all else is set, because
 * - without densification all max_anchors are there from the start: the initial cloud is dense, as in the paper's ablation;
 * - without anchors every primitive is one of its own, with its own embedding, deformed by itself (as in E-D3DGS): K anchors of
 *   one primitive without f_g take the place of each anchor;
 * - without removal all that has grown stays: every anchor with all its primitives and its motion, every hidden unit;
 * - without weight steps the weights of the networks that draw are stored as binary32, as the paper does.
 */
adcgs_status adcgs_train_leave_out(adcgs_train_config *config, const char *parts, adcgs_error *error);

/**
 * All that must hold: every setting in its range, and what they owe each other. ADCGS_ERR_USAGE names setting, value and range.
 * A trainer is created of what passes only.
 */
adcgs_status adcgs_train_check(const adcgs_train_config *config, adcgs_error *error);

/** What is not as in the preset, as adcgs_train_set() takes it, switches too, but for lambda, iterations and seed. */
adcgs_status adcgs_train_changes(const adcgs_train_config *config, adcgs_buffer *text, adcgs_error *error);
/** Write a table of all settings that have names: value, range, what they trade, what they are. */
void adcgs_train_list(const adcgs_train_config *config, FILE *file);
/** The value of a setting as a list has it that adcgs_train_set() takes, or a stream among its notes; NULL: it is not there. */
const char *adcgs_setting_in_list(const char *list, const char *name);

#endif
