/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Curvature of the loss with respect to anchor values. Let I be an image of P values and J = dI/dy. The sum of squares of a
 * column of J is the mean of (J^T s)^2 over random signs s. One backward pass with s as the image's gradient gives it for all
 * values at once. The scale from squares to loss is then measured: values are moved up or down at random, and back.
 */
#include "train/rate/curvature.h"

#include "grad/random.h"
#include "train/density/sample.h"
#include "train/train_views.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    PROBES = 2,        /* random sign vectors per view */
    MEASURE_VIEWS = 32 /* maximum number of views for measuring the loss */
};

/*
 * Share of a step by which all values move to measure the loss. Close to the rounding error, because the curvature may differ at
 * other distances. Chosen by hand, not measured.
 */
static const float reach = 0.25f;

/** Random signs as the image's gradient; the P squares sum to 1. */
static void random_signs(float *grad, size_t n, uint32_t seed)
{
    const float size = (float)sqrt(1.0 / (double)n);
    for (size_t i = 0; i < n; i++)
        grad[i] = adcgs_mix32(seed ^ (uint32_t)i) & 1 ? size : -size;
}

/** Adds the scaled squares of the gradients, and clears them. */
static void take_squares(adcgs_fmodel *f, float *const h[ADCGS_P_ANCHOR], float scale)
{
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        adcgs_param *p = &f->param[i];
        for (size_t j = 0; i < ADCGS_P_ANCHOR && j < p->n; j++)
            h[i][j] += scale * p->g[j] * p->g[j];
        memset(p->g, 0, p->n * sizeof *p->g);
    }
}

static adcgs_status project_views(adcgs_trainer *t, float *const h[ADCGS_P_ANCHOR], adcgs_error *error)
{
    const uint32_t n = ADCGS_MIN(t->views.n, ADCGS_CURVATURE_VIEWS);
    const float scale = 1.0f / (float)(n * PROBES);
    t->pass->pull = NULL;
    for (uint32_t i = 0; i < n; i++) {
        const adcgs_train_view *v = &t->views.list[(uint64_t)i * t->views.n / n];
        const size_t values = 3 * (size_t)v->view.width * (size_t)v->view.height;
        adcgs_pass_forward(t->pass, t->f, v->t, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
        ADCGS_TRY(adcgs_view_render(t, &v->view, ADCGS_MEAN_LIGHT, t->image, 1, error));
        for (uint32_t probe = 0; probe < PROBES; probe++) {
            random_signs(t->grad, values, (uint32_t)adcgs_random64(t->config.seed, 4000 + probe, i));
            ADCGS_TRY(adcgs_view_backward(t, &v->view, ADCGS_MEAN_LIGHT, &t->pass->grads, error));
            adcgs_pass_backward(t->pass, t->f, ADCGS_DEFORM_ALL, 0, 0, 0, NULL);
            take_squares(t->f, h, scale);
        }
    }
    return ADCGS_OK;
}

/** Sets a group's values to `still` plus a part of a step with random signs. */
static void move_values(adcgs_trainer *t, int group, const float *still, float direction)
{
    const adcgs_fmodel *f = t->f;
    const size_t rows = (size_t)adcgs_fmodel_rows(f, group);
    const uint32_t seed = (uint32_t)adcgs_random64(t->config.seed, 4100, (uint64_t)group);
    for (size_t j = 0; j < f->param[group].n; j++) {
        const float sign = adcgs_mix32(seed ^ (uint32_t)j) & 1 ? direction : -direction;
        f->param[group].p[j] = still[j] + sign * reach * f->step[group][j / ADCGS_LANES % rows];
    }
}

/** Loss increase from moving a group, averaged over both directions, and the increase that h predicts. */
static adcgs_status measured_move(adcgs_trainer *t, int group, const float *h, double still_loss, double *seen, double *said,
                                  adcgs_error *error)
{
    adcgs_param *p = &t->f->param[group];
    const size_t rows = (size_t)adcgs_fmodel_rows(t->f, group);
    float *still = adcgs_alloc(NULL, p->n, sizeof *still, error);
    double up = 0, down = 0;
    if (!still)
        return adcgs_alloc_status(error);
    memcpy(still, p->p, p->n * sizeof *still);
    move_values(t, group, still, 1);
    adcgs_status status = adcgs_sample_loss(t, MEASURE_VIEWS, 1, &up, error);
    move_values(t, group, still, -1);
    if (status == ADCGS_OK)
        status = adcgs_sample_loss(t, MEASURE_VIEWS, 1, &down, error);
    memcpy(p->p, still, p->n * sizeof *still);
    adcgs_free(NULL, still);
    *seen = 0.5 * (up + down) - still_loss;
    *said = 0;
    for (size_t j = 0; j < p->n; j++) {
        const double d = (double)reach * (double)t->f->step[group][j / ADCGS_LANES % rows];
        *said += 0.5 * (double)h[j] * d * d;
    }
    return status;
}

/**
 * Calibrates h by the ratio of measured to predicted loss. A ratio that is not positive, or far from the ratio of all groups, is
 * noise of a group with little effect.
 */
static adcgs_status calibrate(adcgs_trainer *t, float *const h[ADCGS_P_ANCHOR], double ratio[ADCGS_P_ANCHOR], adcgs_error *error)
{
    double still, seen[ADCGS_P_ANCHOR], said[ADCGS_P_ANCHOR], all_seen = 0, all_said = 0;
    ADCGS_TRY(adcgs_sample_loss(t, MEASURE_VIEWS, 1, &still, error));
    for (int i = 0; i < ADCGS_P_ETA; i++) {
        ADCGS_TRY(measured_move(t, i, h[i], still, &seen[i], &said[i], error));
        all_seen += seen[i];
        all_said += said[i];
    }
    const double all = all_seen > 0 && all_said > 0 ? all_seen / all_said : 1;
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        const double own = i < ADCGS_P_ETA && said[i] > 0 ? seen[i] / said[i] : all;
        ratio[i] = fmin(fmax(own, all / 16), 16 * all);
        for (size_t j = 0; j < t->f->param[i].n; j++)
            h[i][j] *= (float)ratio[i];
    }
    return ADCGS_OK;
}

adcgs_status adcgs_curvature_measure(adcgs_trainer *t, float *const h[ADCGS_P_ANCHOR], double ratio[ADCGS_P_ANCHOR],
                                     adcgs_error *error)
{
    double factors[ADCGS_P_ANCHOR];
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        memset(h[i], 0, t->f->param[i].n * sizeof *h[i]);
    ADCGS_TRY(project_views(t, h, error));
    return calibrate(t, h, ratio ? ratio : factors, error);
}
