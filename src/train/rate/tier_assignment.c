/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Assignment of anchors to tiers. */
#include "train/rate/tier_assignment.h"

#include "fmodel/body_trajectories.h"
#include "grad/random.h"
#include "splat/steps.h"
#include "train/density/anchor_set.h"
#include "train/train_views.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    VIEWS = 16,       /* maximum number of views measured */
    PIXELS = 1 << 16, /* maximum pixels of each */
    PROBES = 2,       /* random sign vectors per view for the estimate of squares */
    LEAST = 64,       /* minimum anchors of the first tier */
    LEARN_EVERY = 2   /* one of so many iterations also trains without the later tiers */
};
#define SHARE 0.4  /* of the remaining anchors: share that stays in the earlier tiers */
#define ROUND 0.75 /* of the remaining anchors: minimum share that a round keeps */

/** A view for measuring the effect of tiers, and its render with all tiers. */
typedef struct lookout {
    adcgs_view view;
    float t;
    size_t values; /**< of its image */
    float *whole;
} lookout;

typedef struct survey {
    adcgs_trainer *t;
    int n;
    lookout at[VIEWS];
    float *change; /**< [anchors] of a pass */
    double *worth; /**< [anchors] */
    adcgs_ranked *rank;
} survey;

/** Restricts the primitives to the first tiers, at least one. */
static void show(const adcgs_trainer *t, int tiers)
{
    const adcgs_fmodel *f = t->f;
    const uint32_t n = t->pass->primitives.n;
    const adcgs_slot_out o = adcgs_rows_at(t->pass->prim, n, 0);
    const float factor = adcgs_step_factor(tiers <= f->finest ? f->growth[tiers - 1] : 0);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t anchor = adcgs_anchor_of(f, i);
        o.opacity[i] = anchor < f->n && f->tier[anchor] < tiers ? o.opacity[i] : 0;
        for (int a = 0; a < 3; a++)
            o.scale[a][i] *= factor;
    }
}

static adcgs_status draw(const survey *s, const lookout *l, int tiers, float *image, int keep, adcgs_error *error)
{
    const adcgs_pass_mode mode = {.deform = ADCGS_DEFORM_ALL};
    adcgs_pass_forward(s->t->pass, s->t->f, l->t, &mode);
    show(s->t, tiers);
    return adcgs_view_render(s->t, &l->view, ADCGS_MEAN_LIGHT, image, keep, error);
}

/** Sets a training view, reduced by an integer if it is large. */
static void look_from(lookout *l, const adcgs_train_view *v)
{
    int divide = 1;
    while ((v->view.width / divide) * (v->view.height / divide) > PIXELS)
        divide++;
    l->view = v->view;
    l->t = v->t;
    l->view.width /= divide;
    l->view.height /= divide;
    l->view.fx /= (float)divide;
    l->view.fy /= (float)divide;
    l->view.cx /= (float)divide;
    l->view.cy /= (float)divide;
    l->values = 3 * (size_t)l->view.width * (size_t)l->view.height;
}

static void survey_end(survey *s)
{
    for (int i = 0; i < s->n; i++)
        adcgs_free(NULL, s->at[i].whole);
    adcgs_free(NULL, s->change);
    adcgs_free(NULL, s->worth);
    adcgs_free(NULL, s->rank);
}

static adcgs_status survey_begin(survey *s, adcgs_trainer *t, adcgs_error *error)
{
    const int n = (int)ADCGS_MIN(t->views.n, (uint32_t)VIEWS);
    *s = (survey){.t = t};
    s->change = adcgs_alloc(NULL, t->f->n, sizeof *s->change, error);
    s->worth = adcgs_alloc(NULL, t->f->n, sizeof *s->worth, error);
    s->rank = adcgs_alloc(NULL, t->f->n, sizeof *s->rank, error);
    if (!s->change || !s->worth || !s->rank)
        return adcgs_alloc_status(error);
    for (; s->n < n; s->n++) {
        lookout *l = &s->at[s->n];
        look_from(l, &t->views.list[(uint64_t)s->n * t->views.n / (uint64_t)n]);
        l->whole = adcgs_alloc(NULL, l->values, sizeof *l->whole, error);
        if (!l->whole)
            return adcgs_alloc_status(error);
        const adcgs_status status = draw(s, l, t->f->finest + 1, l->whole, 0, error);
        if (status != ADCGS_OK) {
            adcgs_free(NULL, l->whole);
            return status;
        }
    }
    return ADCGS_OK;
}

/** Mean squared error of the renders with only these tiers. */
static adcgs_status measure(const survey *s, int tiers, double *wrong, adcgs_error *error)
{
    *wrong = 0;
    for (int i = 0; i < s->n; i++) {
        const lookout *l = &s->at[i];
        double sum = 0;
        ADCGS_TRY(draw(s, l, tiers, s->t->image, 0, error));
        for (size_t j = 0; j < l->values; j++)
            sum += (double)(s->t->image[j] - l->whole[j]) * (double)(s->t->image[j] - l->whole[j]);
        *wrong += sum / (double)l->values;
    }
    return ADCGS_OK;
}

/** Finds the best growth among values within `reach` of the current one. */
static adcgs_status fit(const survey *s, int tiers, int reach, adcgs_error *error)
{
    uint8_t *growth = &s->t->f->growth[tiers - 1], best = *growth;
    const int first = ADCGS_MAX(0, best - reach), last = ADCGS_MIN(ADCGS_GROWTH_MAX, best + reach);
    double least = INFINITY, wrong;
    for (int g = first; g <= last; g++) {
        *growth = (uint8_t)g;
        ADCGS_TRY(measure(s, tiers, &wrong, error));
        best = wrong < least ? (uint8_t)g : best;
        least = fmin(least, wrong);
    }
    *growth = best;
    return ADCGS_OK;
}

/** Sum over each anchor's primitives of opacity times the gradient of (t->image . t->grad) with respect to opacity. */
static adcgs_status change_of_anchors(survey *s, const lookout *l, adcgs_error *error)
{
    adcgs_trainer *t = s->t;
    adcgs_raster_grads grads = t->pass->grads;
    grads.screen = NULL;
    ADCGS_TRY(adcgs_view_backward(t, &l->view, ADCGS_MEAN_LIGHT, &grads, error));
    memset(s->change, 0, t->f->n * sizeof *s->change);
    for (uint32_t i = 0; i < t->pass->primitives.n; i++)
        if (t->pass->primitives.opacity[i] > 0)
            s->change[adcgs_anchor_of(t->f, i)] += grads.opacity[i] * t->pass->primitives.opacity[i];
    return ADCGS_OK;
}

/**
 * Gain of the renders from each anchor, in squared error. Without the anchor a pixel changes by d, to first order, and its
 * squared error by d^2 - 2 d error. The sum of squares is estimated by products with random signs.
 */
static adcgs_status weigh(survey *s, int tiers, uint32_t round, adcgs_error *error)
{
    adcgs_trainer *t = s->t;
    memset(s->worth, 0, t->f->n * sizeof *s->worth);
    for (int i = 0; i < s->n; i++) {
        const lookout *l = &s->at[i];
        ADCGS_TRY(draw(s, l, tiers, t->image, 1, error));
        for (int probe = 0; probe <= PROBES; probe++) {
            const uint32_t seed = adcgs_mix32(round * (VIEWS * (PROBES + 1)) + (uint32_t)(i * (PROBES + 1) + probe));
            for (size_t j = 0; j < l->values; j++)
                t->grad[j] = !probe ? t->image[j] - l->whole[j] : adcgs_mix32(seed + (uint32_t)j) & 1 ? 1 : -1;
            ADCGS_TRY(change_of_anchors(s, l, error));
            for (uint32_t a = 0; a < t->f->n; a++)
                s->worth[a] += !probe ? -2 * (double)s->change[a] : (double)s->change[a] * (double)s->change[a] / PROBES;
        }
    }
    return ADCGS_OK;
}

/** Moves the least valuable anchors of the first tiers to the next tier, until the wanted number is left. */
static void demote(survey *s, int tiers, uint32_t *left, uint32_t want)
{
    adcgs_fmodel *f = s->t->f;
    uint32_t n = 0;
    for (uint32_t a = 0; a < f->n; a++)
        if (f->tier[a] < tiers)
            s->rank[n++] = (adcgs_ranked){(float)s->worth[a], a};
    adcgs_rank(s->rank, n);
    while (*left > want)
        f->tier[s->rank[--*left].index] = (uint8_t)tiers;
}

static adcgs_status assign(survey *s, adcgs_error *error)
{
    adcgs_fmodel *f = s->t->f;
    uint32_t left = f->n, round = 0;
    for (int tiers = f->finest; tiers > 0; tiers--) {
        const uint32_t want = (uint32_t)(f->n * pow(SHARE, f->finest + 1 - tiers));
        f->growth[tiers - 1] = tiers < f->finest ? f->growth[tiers] : 0;
        while (left > want) {
            ADCGS_TRY(weigh(s, tiers, round++, error));
            demote(s, tiers, &left, ADCGS_MAX(want, (uint32_t)(ROUND * left)));
            ADCGS_TRY(fit(s, tiers, 2, error));
        }
    }
    return ADCGS_OK;
}

adcgs_status adcgs_tiers_assign(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_fmodel *f = t->f;
    survey s;
    f->finest = (uint8_t)(t->config.tiers - 1);
    while (f->finest && f->n * pow(SHARE, f->finest) < LEAST)
        f->finest--;
    memset(f->tier, 0, f->n);
    if (!f->finest)
        return ADCGS_OK;
    adcgs_status status = survey_begin(&s, t, error);
    if (status == ADCGS_OK)
        status = assign(&s, error);
    survey_end(&s);
    adcgs_bodies_recentre(f);
    return status;
}

adcgs_status adcgs_tiers_fit(adcgs_trainer *t, adcgs_error *error)
{
    survey s;
    if (!t->f->finest || t->f->follows)
        return ADCGS_OK;
    adcgs_status status = survey_begin(&s, t, error);
    for (int tiers = 1; status == ADCGS_OK && tiers <= t->f->finest; tiers++)
        status = fit(&s, tiers, 2, error);
    survey_end(&s);
    return status;
}

adcgs_status adcgs_tiers_train(adcgs_trainer *t, uint32_t view, const adcgs_pass_mode *mode, adcgs_error *error)
{
    const adcgs_fmodel *f = t->f;
    const uint64_t draw = adcgs_random64(t->config.seed, 3001, t->run.iteration);
    if (!f->finest || f->follows || t->stage.frozen || f->params.adaptive_steps || t->config.tier_weight <= 0 ||
        draw % LEARN_EVERY)
        return ADCGS_OK;
    const int tiers = 1 + (int)(draw / LEARN_EVERY % f->finest);
    const adcgs_view *v = &t->views.list[view].view;
    adcgs_raster_grads grads = t->pass->grads;
    adcgs_loss_value value;
    const float *target;
    grads.screen = NULL;
    adcgs_pass_forward(t->pass, f, t->views.list[view].t, mode);
    show(t, tiers);
    ADCGS_TRY(adcgs_view_render(t, v, view, t->image, 1, error));
    ADCGS_TRY(adcgs_trainer_target(t, view, NULL, &target, error));
    ADCGS_TRY(adcgs_trainer_loss(t, view, target, &value, error));
    ADCGS_TRY(adcgs_view_backward(t, v, view, &grads, error));
    const float weight = t->config.tier_weight, factor = weight * adcgs_step_factor(f->growth[tiers - 1]);
    const size_t n = t->pass->primitives.n;
    for (size_t i = 0; i < ADCGS_ROWS * n; i++) /* scales were multiplied by the growth in show() */
        t->pass->grad[i] *= i >= ADCGS_ROW_SCALE * n && i < ADCGS_ROW_ROTATION * n ? factor : weight;
    t->pass->pull = NULL;
    adcgs_pass_backward(t->pass, t->f, mode->deform, 0, t->config.rate_period, 0, NULL);
    return ADCGS_OK;
}
