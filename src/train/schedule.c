/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Stages and learning rates. */
#include "train/schedule.h"

#include "train/stage_table.h"

#include <math.h>

/** Factor of a group's learning rates from the configuration. */
static float times_of(const adcgs_train_config *c, int group)
{
    switch (group) {
    case ADCGS_P_FV:
    case ADCGS_P_FG:
    case ADCGS_P_SIGMA:
    case ADCGS_P_COLOUR:
    case ADCGS_P_ETA:
        return c->lr_scale_anchors;
    case ADCGS_P_THETA:
        return c->lr_scale_prediction;
    case ADCGS_P_OMEGA:
    case ADCGS_P_VARPI:
    case ADCGS_P_TIME:
        return c->lr_scale_motion;
    default:
        return c->lr_scale_entropy;
    }
}

void adcgs_train_rates(const adcgs_train_config *c, adcgs_fmodel *f)
{
    static const float rates[ADCGS_P_COUNT][2] = {
        [ADCGS_P_FV] = {7.5e-3f, 7.5e-4f},        [ADCGS_P_FG] = {1.0e-2f, 1.0e-3f},
        [ADCGS_P_SIGMA] = {7.0e-3f, 7.0e-4f},     [ADCGS_P_COLOUR] = {5.0e-3f, 5.0e-4f},
        [ADCGS_P_ETA] = {1.0e-2f, 1.0e-3f},       [ADCGS_P_THETA] = {4.0e-3f, 2.0e-4f},
        [ADCGS_P_OMEGA] = {1.5e-3f, 1.0e-4f},     [ADCGS_P_VARPI] = {1.5e-3f, 1.0e-4f},
        [ADCGS_P_TIME] = {5.0e-3f, 3.0e-4f},      [ADCGS_P_STEP] = {5.0e-3f, 1.0e-3f},
        [ADCGS_P_ETA_PRIOR] = {5.0e-3f, 5.0e-4f}, [ADCGS_P_E_FV] = {5.0e-3f, 5.0e-4f},
        [ADCGS_P_E_SIGMA] = {5.0e-3f, 5.0e-4f},   [ADCGS_P_E_COLOUR] = {5.0e-3f, 5.0e-4f},
        [ADCGS_P_E_FG] = {5.0e-3f, 5.0e-4f},      [ADCGS_P_E_FG + 1] = {5.0e-3f, 5.0e-4f},
        [ADCGS_P_E_FG + 2] = {5.0e-3f, 5.0e-4f},  [ADCGS_P_E_FG + 3] = {5.0e-3f, 5.0e-4f},
        [ADCGS_P_E_STEPS] = {5.0e-3f, 5.0e-4f},
    };
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        f->param[i].lr0 = times_of(c, i) * rates[i][0];
        f->param[i].lr1 = times_of(c, i) * rates[i][1];
    }
}

float adcgs_train_rate(const adcgs_train_config *c, float first, float last, double progress)
{
    const double from = (double)c->lr_decay_start;
    if (!(first > 0)) /* frozen group */
        return 0;
    return progress <= from ? first : first * powf(last / first, (float)((progress - from) / (1 - from)));
}

double adcgs_train_lambda_from(const adcgs_train_config *c)
{
    return fmin(adcgs_stage_begin(c, ADCGS_STAGE_RATE), adcgs_stage_begin(c, ADCGS_STAGE_PRUNE_UNITS));
}

int adcgs_train_prunes_units(const adcgs_train_config *c)
{
    const double first = adcgs_stage_begin(c, ADCGS_STAGE_PRUNE_UNITS),
                 again = adcgs_stage_begin(c, ADCGS_STAGE_PRUNE_UNITS_AGAIN);
    return first < 1 && (again < 1 ? again : first) * c->iterations >= ADCGS_UNITS_AFTER;
}

const char *adcgs_train_stage(const adcgs_train_config *c, double progress)
{
    static const struct {
        adcgs_stage stage;
        const char *name;
    } last_first[] = {{ADCGS_STAGE_FREEZE, "networks"},
                      {ADCGS_STAGE_ROUND, "round"},
                      {ADCGS_STAGE_RATE, "rate"},
                      {ADCGS_STAGE_NOISE, "noise"},
                      {ADCGS_STAGE_COARSE, "deform"}};
    for (size_t i = 0; i < ADCGS_COUNTOF(last_first); i++)
        if (adcgs_stage_has_begun(c, last_first[i].stage, progress))
            return last_first[i].name;
    return "canonical";
}
