/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The table of stages. */
#include "config.h"

#include "train/stage_table.h"

#include <math.h>
#include <stddef.h>

typedef struct row {
    const char *name, *settings;
    size_t begin, end; /* offsets of fractions in the configuration, or AT_START, AT_END */
    size_t after;      /* offset of another fraction, before which it does not begin; AT_START: none */
    size_t without;    /* offset of the switch that leaves it out; AT_START: none */
    size_t empties;    /* offset of the switch without whose part it does nothing; AT_START: none */
    int is_step;
} row;

/* No member that a row names is the first one of the configuration; definition. */
#define AT_START ((size_t)0)
#define AT_END SIZE_MAX
#define OF(member) offsetof(adcgs_train_config, member)

/* clang-format off */
#define LASTS(title, text, from, to) .name = title, .settings = text, .begin = from, .end = to
#define STEP(title, text, at) .name = title, .settings = text, .begin = at, .is_step = 1

static const row table[ADCGS_STAGES] = {
    [ADCGS_STAGE_QUARTER_SIZE] = {LASTS("images 1/4", "quarter_size_until", AT_START, OF(quarter_size_until))},
    [ADCGS_STAGE_HALF_SIZE] = {LASTS("images 1/2", "half_size_until", OF(quarter_size_until), OF(half_size_until))},
    [ADCGS_STAGE_CURRICULUM] = {LASTS("curriculum", "curriculum_until, curriculum_begin", AT_START, OF(curriculum_until))},
    [ADCGS_STAGE_COARSE] = {LASTS("coarse deformation", "deform_start", OF(deform_start), AT_END), .empties = OF(without_coarse)},
    [ADCGS_STAGE_DENSIFY] = {LASTS("densification", "densify_start, densify_until", OF(densify_start), OF(densify_until)),
                             .without = OF(without_densification)},
    [ADCGS_STAGE_NOISE] = {LASTS("quantisation noise", "quant_noise_start", OF(quant_noise_start), OF(quant_round_start)),
                           .without = OF(without_rate)},
    [ADCGS_STAGE_RATE] = {LASTS("rate in the loss", "rate_start, lambda", OF(rate_start), OF(freeze_start)),
                          .without = OF(without_rate)},
    [ADCGS_STAGE_SCALE_REG] = {LASTS("scale regulariser", "scale_reg_start", OF(scale_reg_start), AT_END)},
    [ADCGS_STAGE_STATIC_ANCHORS] = {STEP("static anchors", "rate_start, static_threshold", OF(rate_start)),
                                    .without = OF(without_densification)},
    [ADCGS_STAGE_FINE] = {LASTS("fine deformation", "fine_start", OF(fine_start), AT_END), .empties = OF(without_fine)},
    [ADCGS_STAGE_MOTION_TEST] = {STEP("test of motion", "prune_at", OF(prune_at)), .without = OF(without_rate)},
    [ADCGS_STAGE_PRUNE] = {STEP("pruning", "prune_at, min_mean_opacity", OF(prune_at)), .without = OF(without_densification)},
    [ADCGS_STAGE_PRUNE_UNITS] = {STEP("pruning of units", "prune_units_at", OF(prune_units_at)), .without = OF(without_rate)},
    [ADCGS_STAGE_TIERS] = {STEP("tiers", "tiers_start, tiers", OF(tiers_start)), .after = OF(prune_at)},
    [ADCGS_STAGE_PRUNE_UNITS_AGAIN] = {STEP("pruning of units", "prune_units_again", OF(prune_units_again)),
                                       .after = OF(prune_units_at), .without = OF(without_rate)},
    [ADCGS_STAGE_ROUND] = {LASTS("rounding", "quant_round_start", OF(quant_round_start), AT_END),
                           .without = OF(without_rounding)},
    [ADCGS_STAGE_FREEZE] = {LASTS("values frozen", "freeze_start", OF(freeze_start), AT_END),
                            .after = OF(quant_round_start), .without = OF(without_rounding)},
};
/* clang-format on */

static double fraction(const adcgs_train_config *c, size_t at)
{
    float value;
    if (at == AT_START || at == AT_END)
        return at == AT_END;
    memcpy(&value, (const char *)c + at, sizeof value);
    return (double)value;
}

static int is_left_out(const adcgs_train_config *c, size_t at)
{
    return at != AT_START && ((const uint8_t *)c)[at];
}

double adcgs_stage_begin(const adcgs_train_config *c, adcgs_stage stage)
{
    const row *const r = &table[stage];
    return is_left_out(c, r->without) ? ADCGS_STAGE_NEVER : fmax(fraction(c, r->begin), fraction(c, r->after));
}

double adcgs_stage_end(const adcgs_train_config *c, adcgs_stage stage)
{
    const row *const r = &table[stage];
    return r->is_step ? adcgs_stage_begin(c, stage) : fraction(c, r->end);
}

int adcgs_stage_has_begun(const adcgs_train_config *c, adcgs_stage stage, double progress)
{
    return progress >= adcgs_stage_begin(c, stage);
}

int adcgs_stage_lasts(const adcgs_train_config *c, adcgs_stage stage, double progress)
{
    return adcgs_stage_has_begun(c, stage, progress) && progress < adcgs_stage_end(c, stage);
}

void adcgs_stage_list(const adcgs_train_config *c, FILE *file)
{
    const double n = c->iterations;
    fprintf(file, "%-20s %9s  %-15s  %s\n", "stage", "of run, %", "iterations", "settings");
    for (int i = 0; i < ADCGS_STAGES; i++) {
        const row *const r = &table[i];
        const double begin = adcgs_stage_begin(c, (adcgs_stage)i), end = fmin(adcgs_stage_end(c, (adcgs_stage)i), 1);
        char percent[32] = "-", iterations[32] = "-";
        const int is_empty = is_left_out(c, r->empties);
        if (begin < 1 && r->is_step) {
            snprintf(percent, sizeof percent, "%g", 100 * begin);
            snprintf(iterations, sizeof iterations, "%.0f", ceil(begin * n));
        } else if (begin < end && !is_empty) {
            snprintf(percent, sizeof percent, "%g-%g", 100 * begin, 100 * end);
            snprintf(iterations, sizeof iterations, "%.0f-%.0f", ceil(begin * n), ceil(end * n));
        }
        fprintf(file, "%-20s %9s  %-15s  %s\n", r->name, percent, iterations, r->settings);
    }
}
