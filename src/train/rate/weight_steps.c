/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Lattices of the networks' weights by rate and distortion. */
#include "train/rate/weight_steps.h"

#include "fmodel/from_model.h"
#include "train/density/sample.h"

#include <math.h>

enum { PATIENCE = 2 }; /* steps without a gain at which the search stops; chosen by hand, not measured */

/*
 * Steps per RMS of a layer's weights, where the search begins; chosen by hand, not measured. Output layers are more sensitive,
 * above all those of motion.
 */
#define STEPS_HIDDEN 16
#define STEPS_OUTPUT 64
#define STEPS_MOTION 1024 /* outputs are positions */

/* ---- Bits ---- */

static void encode_rounded(adcgs_range_enc *e, adcgs_tensor *t, const float *w)
{
    for (size_t i = 0; i < (size_t)t->rows * t->cols; i++)
        t->m[i] = (int32_t)fmin(fmax(rint(ldexp((double)w[i], t->e)), -0x1p30), 0x1p30);
    if (t->rows && t->cols)
        adcgs_tensor_encode(e, t);
}

adcgs_status adcgs_weight_step_bits(const adcgs_mlp *m, const float *p, int layer, int e, double *bits, adcgs_error *error)
{
    const size_t end = layer < m->hidden ? m->w[layer + 1] : m->n, n = (size_t)m->in[layer] * (size_t)m->n_out[layer];
    adcgs_tensor w = {(uint32_t)m->n_out[layer], (uint32_t)m->in[layer], 0, (uint8_t)e, NULL};
    adcgs_tensor b = {(uint32_t)(end - m->b[layer]), 1, 0, (uint8_t)e, NULL};
    adcgs_buffer bytes;
    adcgs_range_enc enc;
    w.m = b.m = adcgs_alloc(NULL, ADCGS_MAX(n, b.rows), sizeof *w.m, error);
    if (!w.m)
        return adcgs_alloc_status(error);
    adcgs_buffer_init(&bytes);
    adcgs_range_enc_init(&enc, &bytes);
    encode_rounded(&enc, &w, p + m->w[layer]);
    encode_rounded(&enc, &b, p + m->b[layer]);
    adcgs_range_enc_finish(&enc);
    *bits = 8.0 * (double)bytes.size;
    const int failed = bytes.failed;
    adcgs_buffer_clear(&bytes);
    adcgs_free(NULL, w.m);
    return failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for coded weights") : ADCGS_OK;
}

/* ---- Choice ---- */

typedef struct search {
    adcgs_trainer *t;
    int group, layer, min, max; /**< min, max: exponents allowed */
    double base;                /**< distortion of the current networks in bits: loss, or the features' bits */
} search;

static adcgs_status cost_of(const search *s, int e, double *cost, adcgs_error *error)
{
    adcgs_mlp *m = &s->t->f->mlp[s->group];
    const float *p = s->t->f->param[s->group].p;
    double bits, now;
    *cost = INFINITY;
    if (e < s->min || e > s->max)
        return ADCGS_OK;
    m->weight_step[s->layer] = (int8_t)e;
    adcgs_mlp_prepare(m, p, 1);
    ADCGS_TRY(adcgs_sample_distortion(s->t, s->group, &now, error));
    ADCGS_TRY(adcgs_weight_step_bits(m, p, s->layer, e, &bits, error));
    *cost = now - s->base + bits;
    return ADCGS_OK;
}

/**
 * Changes an exponent by steps in one direction as long as the cost falls. A noisy loss may interrupt the search for one step.
 */
static adcgs_status walk(const search *s, int *e, double *least, int step, adcgs_error *error)
{
    for (int at = *e + step; (at - *e) * step <= PATIENCE; at += step) {
        double cost;
        ADCGS_TRY(cost_of(s, at, &cost, error));
        if (!(cost < *least))
            continue;
        *least = cost;
        *e = at;
    }
    return ADCGS_OK;
}

/**
 * Searches around the nominal exponent in both directions. If it is far too coarse, a noisy loss may also fall with a coarser
 * one.
 */
static adcgs_status choose_layer(const search *s, int from, int8_t *chosen, adcgs_error *error)
{
    int coarser = from, finer = from;
    double least;
    ADCGS_TRY(cost_of(s, from, &least, error));
    ADCGS_TRY(walk(s, &coarser, &least, -1, error));
    ADCGS_TRY(walk(s, &finer, &least, 1, error));
    *chosen = (int8_t)(finer > from ? finer : coarser);
    return ADCGS_OK;
}

/** Approximate steps per RMS of a layer's weights. */
static double nominal_steps(int group, int is_last)
{
    return !is_last ? STEPS_HIDDEN : group == ADCGS_P_OMEGA ? STEPS_MOTION : STEPS_OUTPUT;
}

static int nominal(const adcgs_fmodel *f, int group, int layer)
{
    const adcgs_mlp *m = &f->mlp[group];
    const float *p = f->param[group].p;
    const size_t begin = m->w[layer], end = layer < m->hidden ? m->w[layer + 1] : m->n;
    double square = 0;
    for (size_t i = begin; i < end; i++)
        square += (double)p[i] * (double)p[i];
    const double rms = sqrt(square / (double)(end - begin));
    const int e = (int)ceil(log2(nominal_steps(group, layer == m->hidden) / fmax(rms, 1e-6)));
    return ADCGS_MIN(ADCGS_MAX(e, ADCGS_WEIGHT_STEP_MIN), m->entropy ? ADCGS_E24_BITS : ADCGS_WEIGHT_STEP_MAX);
}

void adcgs_weight_steps_nominal(adcgs_trainer *t)
{
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        adcgs_mlp *m = &t->f->mlp[i];
        for (int l = 0; m->n && l <= m->hidden && (m->entropy || !t->config.without_weight_steps); l++)
            m->weight_step[l] = (int8_t)nominal(t->f, i, l);
    }
}

/**
 * The coarsest lattice of a layer. For an entropy network it is the nominal one. In a stream with hardly any bits left, each
 * single lattice could be coarse without harm. But together the lattices of all layers and networks would shift the means of all
 * anchors by many steps. The shift occurs when they are chosen, and again with the first weight that moves to another lattice
 * point in training.
 */
static int coarsest(const adcgs_fmodel *f, int group, int layer)
{
    return f->mlp[group].entropy ? nominal(f, group, layer) : ADCGS_WEIGHT_STEP_MIN;
}

/** Chooses a network's layers one after the other, each with the previous lattices of the others: their losses add up. */
static adcgs_status choose_network(adcgs_trainer *t, int group, int8_t chosen[ADCGS_MLP_LAYERS], adcgs_error *error)
{
    adcgs_mlp *m = &t->f->mlp[group];
    const float *p = t->f->param[group].p;
    search s = {.t = t, .group = group, .max = m->entropy ? ADCGS_E24_BITS : ADCGS_WEIGHT_STEP_MAX};
    int8_t before[ADCGS_MLP_LAYERS];
    memcpy(before, m->weight_step, sizeof before);
    ADCGS_TRY(adcgs_sample_distortion(t, group, &s.base, error));
    for (s.layer = 0; s.layer <= m->hidden; s.layer++) {
        s.min = coarsest(t->f, group, s.layer);
        ADCGS_TRY(choose_layer(&s, nominal(t->f, group, s.layer), &chosen[s.layer], error));
        m->weight_step[s.layer] = before[s.layer];
        adcgs_mlp_prepare(m, p, 1);
    }
    return ADCGS_OK;
}

adcgs_status adcgs_weight_steps_choose(adcgs_trainer *t, adcgs_error *error)
{
    int8_t chosen[ADCGS_P_COUNT][ADCGS_MLP_LAYERS];
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        adcgs_mlp *m = &t->f->mlp[i];
        memcpy(chosen[i], m->weight_step, sizeof chosen[i]);
        if (adcgs_fmodel_is_settled(t->f, i))
            continue;
        memset(m->weight_step, m->entropy ? ADCGS_E24_BITS : ADCGS_WEIGHT_STEP_NONE, sizeof m->weight_step);
        memcpy(chosen[i], m->weight_step, sizeof chosen[i]);
        if (m->n)
            adcgs_mlp_prepare(m, t->f->param[i].p, 1);
    }
    /* E_q affects both the image and the features; its few weights keep all bits. */
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT && !t->config.without_weight_steps; i++)
        if (t->f->mlp[i].n && i != ADCGS_P_E_STEPS && !adcgs_fmodel_is_settled(t->f, i))
            ADCGS_TRY(choose_network(t, i, chosen[i], error));
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        memcpy(t->f->mlp[i].weight_step, chosen[i], sizeof chosen[i]);
    return ADCGS_OK;
}
