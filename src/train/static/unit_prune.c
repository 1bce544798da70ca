/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pruning of hidden units by regression, rate and distortion. */
#include "train/static/unit_prune.h"

#include "fmodel/from_model.h"

#include "grad/random.h"
#include "train/density/sample.h"

#include <math.h>

/* Origin: chosen by hand, not measured; WIDTH_MAX by the format. */
enum {
    SAMPLES = 4096, /* of a network's activations */
    WIDTH_MAX = ADCGS_NET_WIDTH_MAX
};

/** Bits of a weight on its lattice, approximately; chosen by hand, not measured. */
#define WEIGHT_BITS 5.0

/*
 * Shares of the distortion that remain after the rest of the run has compensated; calibrated on synth_robot_dnerf and demo
 * (doc/log/networks.md, "Removal that relies on later training").
 */
#define LASTING 0.1      /* of the image loss */
#define LASTING_BITS 0.4 /* of the features' bits; chosen by hand, not measured */

#define AT_A_TIME 16 /* one in so many units goes in a step of the search; chosen by hand, not measured */
/* The search ends when one in so many units has gone without a gain; chosen by hand, not measured. */
#define VAIN 4

/* ---- Activations at samples ---- */

typedef struct sample {
    uint32_t anchor;
    int k;
    double t;
} sample;

/** Selects the i-th sample: an anchor and primitive that the network affects. Returns 0 if the selected one is not affected. */
static int draw(const adcgs_fmodel *f, int group, uint32_t i, sample *s)
{
    const int deforms = group == ADCGS_P_OMEGA || group == ADCGS_P_VARPI, each = group == ADCGS_P_THETA || group >= ADCGS_P_E_FG;
    s->anchor = (uint32_t)(adcgs_random64(3, (uint64_t)group, 3 * i) % f->n);
    s->k = (int)(adcgs_random64(3, (uint64_t)group, 3 * i + 1) % f->params.k);
    s->t = adcgs_random_unit(3, (uint64_t)group, 3 * i + 2);
    if (deforms)
        return f->moving[s->anchor] != 0;
    return !each || f->keep[adcgs_fmodel_slot(f, s->anchor, s->k)] != 0;
}

/** Writes `count` rows of an anchor's parameters, unscaled or, for entropy networks, in units of 16 steps. */
static double *put_rows(const adcgs_fmodel *f, double *x, int group, uint32_t anchor, int first, int count, int in_steps)
{
    for (int r = first; r < first + count; r++)
        *x++ = (double)*adcgs_fmodel_at(f, group, anchor, r) / (in_steps ? (double)(ADCGS_MU_GAIN * f->step[group][r]) : 1);
    return x;
}

static double *put_time(const adcgs_fmodel *f, double *x, double t)
{
    const int width = f->params.time_width, columns = adcgs_fmodel_time_columns(&f->params);
    const adcgs_time_rows at = adcgs_fmodel_time_rows(&f->params, (float)t);
    const float *z = f->param[ADCGS_P_TIME].p + (size_t)at.first * (size_t)columns;
    for (int j = 0; j < width; j++, x++) {
        *x = 0;
        for (int i = 0; i < at.n; i++)
            *x += (double)at.weight[i] * (double)z[i * columns + j];
    }
    return x;
}

static void put_inputs(const adcgs_fmodel *f, int group, const sample *s, double *x)
{
    const int nv = f->params.n_fv, ng = f->params.n_fg, fp = 6 * f->params.octaves;
    if (group == ADCGS_P_E_FV) {
        put_rows(f, x, ADCGS_P_ETA, s->anchor, 0, f->params.n_eta, 1);
        return;
    }
    for (int i = 0; group == ADCGS_P_VARPI && i < fp; i++)
        *x++ = (double)f->code[adcgs_slot_of(s->anchor, fp, i)];
    if (group != ADCGS_P_VARPI || f->params.fine_uses_fv)
        x = put_rows(f, x, ADCGS_P_FV, s->anchor, 0, nv, f->mlp[group].entropy);
    const int slots = group == ADCGS_P_THETA ? adcgs_slot_inputs(&f->params) : 0;
    for (int i = 0; i < slots; i++)
        *x++ = i == s->k;
    if (group == ADCGS_P_THETA || group > ADCGS_P_E_FG)
        x = put_rows(f, x, ADCGS_P_FG, s->anchor, s->k * ng, f->mlp[group].own - nv - slots, f->mlp[group].entropy);
    if (f->mlp[group].time)
        put_time(f, x, s->t);
}

/** Inputs of layers 1.. into h, [layer][width]. */
static void activate(const adcgs_mlp *m, const float *p, const double *x, double *h)
{
    const double *in = x;
    for (int l = 0; l < m->hidden; l++, in = h, h += m->width)
        for (int o = 0; o < m->width; o++) {
            double sum = (double)p[m->b[l] + (size_t)o];
            for (int i = 0; i < m->in[l]; i++)
                sum += (double)p[m->w[l] + (size_t)o * (size_t)m->in[l] + (size_t)i] * in[i];
            h[o] = (sum < 0 ? sum * 0x1p-6 : sum) + (l > 0 ? in[o] : 0);
        }
}

/** Adds the products of one sample's h and a 1 to the lower half of the sums. */
static void add_products(double *sum, const double *h, int n)
{
    for (int i = 0; i < n; i++) {
        const double a = i < n - 1 ? h[i] : 1;
        for (int j = 0; j <= i; j++)
            sum[i * n + j] += a * (j < n - 1 ? h[j] : 1);
    }
}

/* ---- Inverse of the sums ---- */

/** Inverts a positive definite matrix in place, given its lower half (Gauss-Jordan; no pivoting needed). */
static void invert(double *a, int n)
{
    double mean = 0;
    for (int i = 0; i < n; i++)
        mean += a[i * n + i] / n;
    for (int i = 0; i < n; i++) {
        a[i * n + i] += 1e-6 * mean + 1e-30; /* for units that are nearly equal, or never active */
        for (int j = 0; j < i; j++)
            a[j * n + i] = a[i * n + j];
    }
    for (int k = 0; k < n; k++) {
        const double pivot = 1 / a[k * n + k];
        a[k * n + k] = 1;
        for (int j = 0; j < n; j++)
            a[k * n + j] *= pivot;
        for (int i = 0; i < n; i++) {
            const double by = a[i * n + k];
            if (i == k)
                continue;
            a[i * n + k] = 0;
            for (int j = 0; j < n; j++)
                a[i * n + j] -= by * a[k * n + j];
        }
    }
}

adcgs_status adcgs_gram_take(adcgs_gram *gram, const adcgs_fmodel *f, int group, adcgs_error *error)
{
    const adcgs_mlp *m = &f->mlp[group];
    double x[ADCGS_NET_INPUTS_MAX], h[(ADCGS_MLP_LAYERS - 1) * WIDTH_MAX];
    memset(gram, 0, sizeof *gram);
    gram->n = m->width + 1;
    const size_t size = (size_t)gram->n * (size_t)gram->n;
    for (int l = 0; l < m->hidden; l++) {
        gram->inverse[l] = adcgs_alloc(NULL, size, sizeof(double), error);
        if (!gram->inverse[l]) {
            adcgs_gram_clear(gram);
            return adcgs_alloc_status(error);
        }
    }
    for (uint32_t i = 0; i < SAMPLES; i++) {
        sample s;
        if (!draw(f, group, i, &s))
            continue;
        put_inputs(f, group, &s, x);
        activate(m, f->param[group].p, x, h);
        for (int l = 0; l < m->hidden; l++)
            add_products(gram->inverse[l], h + l * m->width, gram->n);
    }
    for (int l = 0; l < m->hidden; l++)
        invert(gram->inverse[l], gram->n);
    return ADCGS_OK;
}

void adcgs_gram_clear(adcgs_gram *gram)
{
    for (int l = 0; l < ADCGS_MLP_LAYERS - 1; l++)
        adcgs_free(NULL, gram->inverse[l]);
    memset(gram, 0, sizeof *gram);
}

/* ---- Removal of a unit ---- */

void adcgs_mlp_prune_unit(const adcgs_mlp *m, float *p, adcgs_gram *gram, int unit)
{
    const int n = gram->n;
    for (int l = 1; l <= m->hidden; l++) {
        double *a = gram->inverse[l - 1], *by = a + unit * n;
        const double pivot = by[unit];
        for (int o = 0; o < m->n_out[l]; o++) {
            float *w = p + m->w[l] + (size_t)o * (size_t)m->width, *b = p + m->b[l] + o;
            const double gone = (double)w[unit] / pivot;
            for (int j = 0; j < m->width; j++)
                w[j] = (float)((double)w[j] - gone * by[j]);
            *b = (float)((double)*b - gone * by[n - 1]);
            w[unit] = 0;
        }
        for (int i = 0; i < n; i++) {
            const double share = a[i * n + unit] / pivot;
            for (int j = 0; i != unit && j < n; j++)
                a[i * n + j] -= share * by[j];
        }
        for (int i = 0; i < n; i++)
            a[i * n + unit] = by[i] = 0;
    }
}

/**
 * Effect of a unit's removal on the layers after it: the product of three terms. They are the part that the other units cannot
 * replace, the square of each weight that reads the unit, and the mean squared gradient there (Adam keeps it for the biases).
 */
static double presence(const adcgs_mlp *m, const adcgs_param *param, const adcgs_gram *gram, int unit, const uint8_t *keep)
{
    double sum = 0;
    for (int l = 1; l <= m->hidden; l++) {
        double square = 0;
        for (int o = 0; o < m->n_out[l]; o++) {
            const double w = (double)param->p[m->w[l] + (size_t)o * (size_t)m->width + (size_t)unit];
            if (l == m->hidden || (keep[o] && o != unit))
                square += w * w * ((double)param->v[m->b[l] + (size_t)o] + 1e-30);
        }
        sum += square / gram->inverse[l - 1][unit * gram->n + unit];
    }
    return sum;
}

static int least_present(const adcgs_mlp *m, const adcgs_param *param, const adcgs_gram *gram, const uint8_t *keep)
{
    int best = -1;
    double least = INFINITY;
    for (int u = 0; u < m->width; u++) {
        const double here = keep[u] ? presence(m, param, gram, u, keep) : INFINITY;
        if (here < least) {
            least = here;
            best = u;
        }
    }
    return best;
}

/* ---- Choice ---- */

void adcgs_fmodel_narrow(adcgs_fmodel *f, int group, const uint8_t *keep)
{
    adcgs_param *param = &f->param[group];
    float *const blocks[] = {param->p, param->g, param->m, param->v};
    const adcgs_mlp old = f->mlp[group];
    int width = 0;
    for (int u = 0; u < old.width; u++)
        width += keep[u] != 0;
    adcgs_fmodel_set_width(f, group, width);
    for (size_t block = 0; block < ADCGS_COUNTOF(blocks); block++) {
        float *to = blocks[block]; /* never ahead of the reads */
        for (int l = 0; l <= old.hidden; l++) {
            const float *w = blocks[block] + old.w[l], *b = blocks[block] + old.b[l];
            for (int o = 0; o < old.n_out[l]; o++)
                for (int i = 0; i < old.in[l]; i++)
                    if ((l == old.hidden || keep[o]) && (l == 0 || keep[i]))
                        *to++ = w[o * old.in[l] + i];
            for (int o = 0; o < old.n_out[l]; o++)
                if (l == old.hidden || keep[o])
                    *to++ = b[o];
        }
    }
}

typedef struct slimming {
    adcgs_trainer *t;
    int group, width, left; /**< width before, units left */
    uint8_t keep[WIDTH_MAX], best_keep[WIDTH_MAX];
    float *best;          /**< parameters of the lowest cost */
    double before, least; /**< distortion with all units; lowest cost so far */
    adcgs_gram gram;
} slimming;

static double bits_left(const slimming *s)
{
    const adcgs_mlp *m = &s->t->f->mlp[s->group];
    adcgs_mlp narrow;
    return WEIGHT_BITS * (double)adcgs_mlp_layout(&narrow, m->own, m->time, s->left, m->hidden, m->out);
}

/** Tests if the remaining units are the best set so far. */
static adcgs_status judge(slimming *s, int *better, adcgs_error *error)
{
    adcgs_fmodel *f = s->t->f;
    double now;
    adcgs_mlp_prepare(&f->mlp[s->group], f->param[s->group].p, 1);
    ADCGS_TRY(adcgs_sample_distortion(s->t, s->group, &now, error));
    if (s->left == s->width)
        s->before = now;
    const double lasting = f->mlp[s->group].entropy ? LASTING_BITS : LASTING;
    const double cost = lasting * (now - s->before) + bits_left(s);
    *better = s->left == s->width || cost < s->least;
    if (!*better)
        return ADCGS_OK;
    s->least = cost;
    memcpy(s->best_keep, s->keep, sizeof s->keep);
    memcpy(s->best, f->param[s->group].p, f->param[s->group].n * sizeof *s->best);
    return ADCGS_OK;
}

/** Removes a network's units, some at a time. The search ends when a quarter of them has gone without a gain. */
static adcgs_status slim_network(slimming *s, adcgs_error *error)
{
    adcgs_fmodel *f = s->t->f;
    const adcgs_mlp *m = &f->mlp[s->group];
    const int step = m->entropy ? 1 : ADCGS_MAX(1, m->width / AT_A_TIME), patience = ADCGS_MAX(2, m->width / VAIN);
    int better, since = 0;
    memset(s->keep, 1, sizeof s->keep);
    s->width = s->left = m->width;
    ADCGS_TRY(judge(s, &better, error));
    while (s->left > step && since < patience) {
        for (int i = 0; i < step; i++, s->left--) {
            const int unit = least_present(m, &f->param[s->group], &s->gram, s->keep);
            adcgs_mlp_prune_unit(m, f->param[s->group].p, &s->gram, unit);
            s->keep[unit] = 0;
        }
        ADCGS_TRY(judge(s, &better, error));
        since = better ? 0 : since + step;
    }
    memcpy(f->param[s->group].p, s->best, f->param[s->group].n * sizeof *s->best);
    const int width = f->mlp[s->group].width;
    adcgs_fmodel_narrow(f, s->group, s->best_keep);
    s->t->decisions.units += (uint32_t)(width - f->mlp[s->group].width);
    adcgs_mlp_prepare(&f->mlp[s->group], f->param[s->group].p, 1);
    return ADCGS_OK;
}

adcgs_status adcgs_prune_units(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        if (t->f->mlp[i].n)
            adcgs_mlp_prepare(&t->f->mlp[i], t->f->param[i].p, 1); /* entropy networks take the coder's form */
    for (int i = ADCGS_P_ANCHOR; status == ADCGS_OK && i < ADCGS_P_COUNT; i++) {
        slimming s = {.t = t, .group = i};
        /* E_q trades distortion for bits: neither measure alone can judge it. */
        if (!t->f->mlp[i].hidden || i == ADCGS_P_E_STEPS || adcgs_fmodel_is_settled(t->f, i))
            continue;
        s.best = adcgs_alloc(NULL, t->f->param[i].n, sizeof *s.best, error);
        status = s.best ? adcgs_gram_take(&s.gram, t->f, i, error) : adcgs_alloc_status(error);
        if (status == ADCGS_OK)
            status = slim_network(&s, error);
        adcgs_gram_clear(&s.gram);
        adcgs_free(NULL, s.best);
    }
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        if (t->f->mlp[i].n)
            adcgs_mlp_prepare(&t->f->mlp[i], t->f->param[i].p, t->stage.rounding);
    return status;
}
