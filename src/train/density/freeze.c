/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Freezing of the anchors' values. */
#include "train/density/freeze.h"

#include "train/rate/curvature.h"
#include "train/rate/levels.h"

#define HELD 1e20f /* loss per squared change of a value: more than any bits are worth; arithmetic */

/** Fixes the levels of frozen anchors, which must not change. */
static void hold_settled(const adcgs_fmodel *f, float *const curvature[ADCGS_P_ANCHOR])
{
    for (int i = 0; f->follows && i < ADCGS_P_ANCHOR; i++) {
        const size_t rows = (size_t)adcgs_fmodel_rows(f, i);
        for (size_t j = 0; j < f->param[i].n; j++)
            if (f->trainable[j / ADCGS_LANES / rows * ADCGS_LANES + j % ADCGS_LANES] == 0)
                curvature[i][j] = HELD;
    }
}

adcgs_status adcgs_freeze(adcgs_trainer *t, adcgs_error *error)
{
    float *value[ADCGS_P_ANCHOR], *curvature[ADCGS_P_ANCHOR];
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        adcgs_param *p = &t->f->param[i];
        value[i] = p->p;
        memcpy(p->m, p->p, p->n * sizeof *p->m);
        curvature[i] = p->v;
    }
    const adcgs_quantise_options nearest = {.cpu = t->cpu, .mu = t->pass->mu, .factor = t->pass->factor, .value = value};
    ADCGS_TRY(t->quantise(t->f, &nearest, error));
    adcgs_level_bits(t);
    if (t->config.target != ADCGS_TARGET_NONE)
        ADCGS_TRY(adcgs_curvature_measure(t, curvature, NULL, error));
    else
        for (int i = 0; i < ADCGS_P_ANCHOR; i++)
            memset(curvature[i], 0, t->f->param[i].n * sizeof *curvature[i]);
    hold_settled(t->f, curvature);
    t->stage.frozen = 1;
    return ADCGS_OK;
}
