/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Running mean of a model's parameters. */
#include "fmodel/weight_average.h"

static size_t count(const adcgs_fmodel *f)
{
    size_t n = 0;
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        n += f->param[i].n;
    return n;
}

adcgs_status adcgs_weight_average_begin(adcgs_weight_average *a, const adcgs_fmodel *f, adcgs_error *error)
{
    adcgs_weight_average_clear(a);
    a->mean = adcgs_alloc(NULL, count(f), sizeof *a->mean, error);
    if (!a->mean)
        return adcgs_alloc_status(error);
    a->size = count(f);
    return ADCGS_OK;
}

adcgs_status adcgs_weight_average_add(adcgs_weight_average *a, const adcgs_fmodel *f, adcgs_error *error)
{
    if (a->n == 0 || a->size != count(f))
        ADCGS_TRY(adcgs_weight_average_begin(a, f, error));
    const float share = 1 / (float)++a->n; /* 1 at first, so that a constant parameter is its own mean, to the bit */
    float *mean = a->mean;
    for (int i = 0; i < ADCGS_P_COUNT; mean += f->param[i++].n)
        for (size_t j = 0; j < f->param[i].n; j++)
            mean[j] += share * (f->param[i].p[j] - mean[j]);
    return ADCGS_OK;
}

void adcgs_weight_average_take(adcgs_weight_average *a, adcgs_fmodel *f)
{
    const float *mean = a->mean;
    if (a->n == 0 || a->size != count(f))
        return;
    for (int i = 0; i < ADCGS_P_COUNT; mean += f->param[i++].n)
        memcpy(f->param[i].p, mean, f->param[i].n * sizeof *mean);
    a->n = 0;
}

void adcgs_weight_average_clear(adcgs_weight_average *a)
{
    adcgs_free(NULL, a->mean);
    *a = (adcgs_weight_average){.n = 0};
}
