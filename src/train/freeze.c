/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The moment when the anchors' values become what the stream holds, and going back on it. */
#include "train/curvature.h"

/** Where a group's values go. */
static void values_of(adcgs_fmodel *f, float *value[ADCGS_P_ANCHOR])
{
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        value[i] = f->param[i].p;
}

adcgs_status adcgs_trainer_prices(const adcgs_trainer *t, double strength, adcgs_rdo *rdo, adcgs_error *error)
{
    if (!t->frozen)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "values are decided by rate and distortion only once they are frozen");
    *rdo = (adcgs_rdo){ .lambda_bit = t->config.without_rate ? 0 : strength * t->lambda * 0x1p-23 };
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        rdo->target[i] = t->f->param[i].m;
        /* No picture shows eta: it is there for the sake of f_v's bits, and has no price of its own. */
        rdo->curvature[i] = i == ADCGS_P_ETA ? NULL : t->f->param[i].v;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_trainer_choose(adcgs_trainer *t, double strength, adcgs_error *error)
{
    float *value[ADCGS_P_ANCHOR];
    adcgs_rdo rdo;
    values_of(t->f, value);
    ADCGS_TRY(adcgs_trainer_prices(t, strength, &rdo, error));
    const adcgs_quantise_options options = { .cpu = t->cpu, .mu = t->pass->mu, .factor = t->pass->factor, .value = value,
                                             .rdo = &rdo };
    return t->quantise(t->f, &options, error);
}

void adcgs_trainer_densities(adcgs_trainer *t)
{
    adcgs_rate rate;
    adcgs_pass_densities(t->pass, t->f, &rate);
    memcpy(t->mean_bits, rate.bits, sizeof rate.bits);
}

adcgs_status adcgs_trainer_freeze(adcgs_trainer *t, adcgs_error *error)
{
    float *value[ADCGS_P_ANCHOR], *curvature[ADCGS_P_ANCHOR];
    values_of(t->f, value);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        adcgs_param *p = &t->f->param[i];
        memcpy(p->m, p->p, p->n * sizeof *p->m);
        curvature[i] = p->v;
    }
    const adcgs_quantise_options nearest = { .cpu = t->cpu, .mu = t->pass->mu, .factor = t->pass->factor, .value = value };
    ADCGS_TRY(t->quantise(t->f, &nearest, error));
    adcgs_trainer_densities(t);
    ADCGS_TRY(adcgs_curvature_measure(t, curvature, NULL, error));
    t->frozen = 1;
    if (t->config.rdo_strength > 0) {
        ADCGS_TRY(adcgs_trainer_choose(t, (double)t->config.rdo_strength, error));
        adcgs_trainer_densities(t);
    }
    return ADCGS_OK;
}
