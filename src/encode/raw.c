/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Models without compression. */
#include "encode/raw.h"

#include <math.h>

/** Sets the steps of a group of parameters whose rows repeat after `channels`. */
static void finest_steps(adcgs_fmodel *f, int group, int channels)
{
    for (int c = 0; c < channels; c++) {
        const float step = adcgs_fmodel_finest_step(f, group, c);
        for (int r = c; r < adcgs_fmodel_rows(f, group); r += channels)
            f->step[group][r] = step;
    }
}

void adcgs_raw_prepare(adcgs_fmodel *f)
{
    finest_steps(f, ADCGS_P_FV, f->params.n_fv);
    finest_steps(f, ADCGS_P_FG, f->params.n_fg);
    finest_steps(f, ADCGS_P_SIGMA, adcgs_sigma_rows(&f->params));
    finest_steps(f, ADCGS_P_COLOUR, ADCGS_COLOUR_N);
    memset(f->param[ADCGS_P_ETA].p, 0, f->param[ADCGS_P_ETA].n * sizeof(float));
    for (int i = ADCGS_P_ETA_PRIOR; i < ADCGS_P_COUNT; i++)
        if (i != ADCGS_P_STEP)
            memset(f->param[i].p, 0, f->param[i].n * sizeof(float));
}

static void put(adcgs_buffer *out, float x)
{
    adcgs_write_uint(out, adcgs_float_bits(x), 4);
}

static void put_latents(adcgs_buffer *out, const int16_t *yq, const float *d, int channels)
{
    for (int c = 0; c < channels; c++)
        put(out, (float)yq[c] * d[c]);
}

static void put_tensor(adcgs_buffer *out, const adcgs_tensor *t)
{
    for (size_t i = 0; i < (size_t)t->rows * t->cols; i++)
        if (t->mode == 1)
            adcgs_write_uint(out, (uint32_t)t->m[i], 4);
        else
            put(out, (float)ldexp(t->m[i], -(int)t->e));
}

adcgs_status adcgs_raw_write(const adcgs_model *m, adcgs_buffer *out, adcgs_error *error)
{
    const adcgs_params *p = &m->params;
    for (size_t i = 0; i < 3 * (size_t)m->n; i++)
        put(out, m->origin[i % 3] + ((float)m->pos[i] + 0.5f) * m->voxel);
    for (uint32_t i = 0; i < m->n; i++)
        put_latents(out, m->fv + (size_t)i * p->n_fv, m->d_fv, p->n_fv);
    for (uint32_t i = 0; i < m->n; i++)
        put_latents(out, m->sigma + (size_t)i * (size_t)adcgs_sigma_rows(p), m->d_sigma, adcgs_sigma_coded(m, i));
    for (uint32_t i = 0; i < m->n; i++)
        put_latents(out, m->colour + (size_t)i * ADCGS_COLOUR_N, m->d_colour, ADCGS_COLOUR_N);
    for (uint32_t i = 0; i < m->n; i++)
        for (int k = 0; k < p->k; k++)
            if (m->mask[i] >> k & 1)
                put_latents(out, m->fg + ((size_t)i * p->k + (size_t)k) * p->n_fg, m->d_fg, p->n_fg);
    for (int role = ADCGS_ROLE_PREDICTION; role < ADCGS_ROLES; role++)
        for (int l = 0; m->net[role].present && l < m->net[role].n_layers; l++) {
            put_tensor(out, &m->net[role].layer[l].w);
            put_tensor(out, &m->net[role].layer[l].b);
        }
    return out->failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the uncompressed model") : ADCGS_OK;
}
