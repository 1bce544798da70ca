/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rate-distortion optimised quantisation. */
#include "train/rate/levels.h"

adcgs_status adcgs_level_costs(const adcgs_trainer *t, double strength, adcgs_rdo *rdo, adcgs_error *error)
{
    if (!t->stage.frozen)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "levels are chosen by rate and distortion only after values are frozen");
    *rdo = (adcgs_rdo){.lambda_bit = t->config.without_rate ? 0 : strength * adcgs_cost_of_bit(t)};
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        rdo->target[i] = t->f->param[i].m;
        /* No image depends on eta. It only serves to code f_v and has no distortion of its own. */
        rdo->curvature[i] = i == ADCGS_P_ETA ? NULL : t->f->param[i].v;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_level_choose(adcgs_trainer *t, double strength, adcgs_error *error)
{
    float *value[ADCGS_P_ANCHOR];
    adcgs_rdo rdo;
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        value[i] = t->f->param[i].p;
    ADCGS_TRY(adcgs_level_costs(t, strength, &rdo, error));
    const adcgs_quantise_options options = {.cpu = t->cpu,
                                            .mu = t->pass->mu,
                                            .factor = t->pass->factor,
                                            .value = value,
                                            .rdo = &rdo};
    return t->quantise(t->f, &options, error);
}

void adcgs_level_bits(adcgs_trainer *t)
{
    adcgs_rate rate;
    adcgs_pass_rate(t->pass, t->f, &rate);
    memcpy(t->rate.mean_bits, rate.bits, sizeof rate.bits);
}
