/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Factors of steps that adapt to the anchor: E_q in integers, then a table. */
#include "splat/steps.h"

float adcgs_step_factor(int q)
{
    static const float factors[2 * ADCGS_STEP_INDEX_MAX + 1] = {
        0x1.000000p-2f, 0x1.172b84p-2f, 0x1.306fe0p-2f, 0x1.4bfdaep-2f, 0x1.6a09e6p-2f, 0x1.8ace54p-2f, 0x1.ae89fap-2f,
        0x1.d5818ep-2f, 0x1.000000p-1f, 0x1.172b84p-1f, 0x1.306fe0p-1f, 0x1.4bfdaep-1f, 0x1.6a09e6p-1f, 0x1.8ace54p-1f,
        0x1.ae89fap-1f, 0x1.d5818ep-1f, 0x1.000000p+0f, 0x1.172b84p+0f, 0x1.306fe0p+0f, 0x1.4bfdaep+0f, 0x1.6a09e6p+0f,
        0x1.8ace54p+0f, 0x1.ae89fap+0f, 0x1.d5818ep+0f, 0x1.000000p+1f, 0x1.172b84p+1f, 0x1.306fe0p+1f, 0x1.4bfdaep+1f,
        0x1.6a09e6p+1f, 0x1.8ace54p+1f, 0x1.ae89fap+1f, 0x1.d5818ep+1f, 0x1.000000p+2f,
    };
    return factors[q + ADCGS_STEP_INDEX_MAX];
}

adcgs_status adcgs_steps_init(adcgs_steps *steps, const adcgs_model *model, adcgs_cpu_level cpu, adcgs_memory *memory,
                              adcgs_error *error)
{
    *steps = (adcgs_steps){.n = adcgs_params_steps(&model->params), .n_fv = model->params.n_fv};
    return steps->n ? adcgs_e24_create(&steps->net, &model->net[ADCGS_ROLE_ENTROPY_STEPS], cpu, memory, error) : ADCGS_OK;
}

void adcgs_steps_clear(adcgs_steps *steps, adcgs_memory *memory)
{
    adcgs_e24_free(&steps->net, memory);
}

size_t adcgs_steps_scratch(const adcgs_steps *steps)
{
    const size_t rows = (size_t)(steps->n_fv + steps->n);
    return steps->n ? adcgs_e24_scratch(steps->net) + rows * ADCGS_LANES * sizeof(int16_t) : 0;
}

void adcgs_steps_factors(const adcgs_steps *steps, const adcgs_model *model, uint32_t first, float (*factor)[ADCGS_LANES],
                         void *scratch)
{
    const uint32_t lanes = ADCGS_MIN(model->n - first, (uint32_t)ADCGS_LANES);
    const size_t n_fv = (size_t)steps->n_fv;
    if (!steps->n)
        return;
    uint8_t *const of_net = scratch;
    int16_t(*x)[ADCGS_LANES] = (int16_t(*)[ADCGS_LANES])(of_net + adcgs_e24_scratch(steps->net)), (*q)[ADCGS_LANES] = x + n_fv;
    memset(x, 0, n_fv * sizeof *x);
    for (uint32_t l = 0; l < lanes; l++)
        for (size_t c = 0; c < n_fv; c++)
            x[c][l] = model->fv[(first + l) * n_fv + c];
    adcgs_e24_eval(steps->net, x[0], q[0], NULL, scratch);
    for (int i = 0; i < steps->n; i++)
        for (uint32_t l = 0; l < ADCGS_LANES; l++)
            factor[i][l] = adcgs_step_factor(l < lanes ? adcgs_clip(q[i][l], ADCGS_STEP_INDEX_MAX) : 0);
}
