/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Private to the passes: layout of a group's activations, and functions shared by forward and backward passes. */
#ifndef ADCGS_FMODEL_PASS_LAYOUT_H
#define ADCGS_FMODEL_PASS_LAYOUT_H

#include "fmodel/pass.h"
#include "grad/random.h"

/** Number of pieces in which groups are merged, for any number of threads; chosen by hand, not measured. */
#define ADCGS_PASS_CHUNKS 8

/** Activations of one group. h: outputs of hidden layers; below: sign masks of adcgs_train_dsp.residual. */
typedef struct adcgs_act {
    float *theta_h, *theta_out; /* per primitive, and theta_below */
    size_t theta_h_stride, theta_below_stride;
    float *omega_h, *omega_out;
    float *varpi_h, *varpi_out;
    uint64_t *theta_below, *omega_below, *varpi_below, *steps_below;
    float *steps_h, *steps_out, *steps_dlog; /* E_q: octaves; gradient of the factors' logarithms */
} adcgs_act;

static inline adcgs_act adcgs_pass_act(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g)
{
    const adcgs_mlp *th = &f->mlp[ADCGS_P_THETA], *om = &f->mlp[ADCGS_P_OMEGA], *va = &f->mlp[ADCGS_P_VARPI];
    const adcgs_mlp *eq = &f->mlp[ADCGS_P_E_STEPS];
    const size_t k = f->params.k;
    adcgs_act a;
    float *at = p->act + (size_t)g * p->act_stride;
/* clang-format off */
#define TAKE(field, rows) (a.field = (void *)at, at += (size_t)(rows) * ADCGS_LANES)
    /* clang-format on */
    a.theta_h_stride = (size_t)th->hidden * (size_t)th->width * ADCGS_LANES;
    a.theta_below_stride = adcgs_mlp_below_rows(th) * 32;
    TAKE(theta_h, k * (size_t)th->hidden * (size_t)th->width);
    TAKE(theta_below, k * adcgs_mlp_below_rows(th));
    TAKE(theta_out, k * ADCGS_THETA_OUT);
    TAKE(omega_h, om->hidden * om->width);
    TAKE(omega_below, adcgs_mlp_below_rows(om));
    TAKE(omega_out, om->out);
    TAKE(varpi_h, va->hidden * va->width);
    TAKE(varpi_below, adcgs_mlp_below_rows(va));
    TAKE(varpi_out, va->out);
    TAKE(steps_h, eq->hidden * eq->width);
    TAKE(steps_below, adcgs_mlp_below_rows(eq));
    TAKE(steps_out, eq->out);
    TAKE(steps_dlog, eq->out);
#undef TAKE
    return a;
}

/** Sets the arrays that prediction and deformation read and write for a group, according to deform. */
void adcgs_pass_io(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, adcgs_deform deform, adcgs_group_io *io);

/** Deformation of a group of anchors: none if nothing in it moves, which saves the evaluation of the networks. */
static inline adcgs_deform adcgs_pass_deform_of(const adcgs_fmodel *f, uint32_t g, adcgs_deform deform)
{
    const float *moving = f->moving + (size_t)g * ADCGS_LANES;
    float any = 0;
    for (int l = 0; l < ADCGS_LANES; l++)
        any += moving[l];
    return any > 0 ? deform : ADCGS_DEFORM_NONE;
}

/** True if the last forward pass used adaptive steps. */
static inline int adcgs_pass_adapts(const adcgs_pass *p, const adcgs_fmodel *f)
{
    return f->params.adaptive_steps && p->quant != ADCGS_QUANT_NONE;
}
/** Factors of a group of anchors: [steps][64]. */
static inline float *adcgs_pass_factors(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g)
{
    return p->factor + (size_t)g * (size_t)adcgs_params_steps(&f->params) * ADCGS_LANES;
}
/** Index of the factor for a row of a parameter group; -1: none. */
int adcgs_pass_factor_of(const adcgs_fmodel *f, int group, int row);
/** Evaluates E_q on the f_v in `used`; if `set`, its outputs become the factors. */
void adcgs_pass_evaluate_factors(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, int set, float *scratch);
/** to = from / factor, and to = from * factor, over the rows of a parameter group in a group of anchors. */
void adcgs_pass_divide(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, int group, float *to, const float *from);
void adcgs_pass_multiply(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, int group, float *to, const float *from);
/** Initialises steps_dlog from the gradients of the images; adcgs_rate_group() adds those of the rate. */
void adcgs_pass_factors_begin(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g);
/** Propagates steps_dlog to E_q and f_v. */
void adcgs_pass_factors_back(const adcgs_pass *p, adcgs_fmodel *f, uint32_t g, float *partial, float *scratch);

/**
 * Rate of one group. Adds gradients to f's anchors (scale included), to steps_dlog with adaptive steps, and to the partial
 * network gradients; adds to bits[ADCGS_GROUPS]. If the last forward pass rounded, the rate is the coder's, and the group's p->mu
 * and p->factor receive the current means and factors.
 */
void adcgs_rate_group(const adcgs_pass *p, adcgs_fmodel *f, uint32_t group, float scale, float *partial, float *scratch,
                      double *bits);

#endif
