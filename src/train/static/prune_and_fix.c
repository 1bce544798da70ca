/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pruning and detection of static anchors. */
#include "train/static/prune_and_fix.h"

#include "train/density/anchor_set.h"
#include "train/density/floaters.h"
#include "train/density/sample.h"
#include "train/static/unchanging.h"

#include <math.h>

/* Origin: chosen by hand, not measured. */
enum {
    DECIDE_TIMES = 16, /* times at which motion is measured */
    DECIDE_VIEWS = 32  /* maximum number of views for measuring the loss */
};
/*
 * Of the rendered weight: maximum of the faint primitives dropped; calibrated on zju, the robots and the demo
 * (doc/log/densification.md).
 */
#define FAINT_SHARE 0.1
/* Mean opacity of rendered primitives below which a scene counts as faint; calibrated on five scenes (doc/log/static.md). */
#define FAINT_MEAN 0.4
/* Of an anchor's rendered weight: maximum at changing pixels of a static one; calibrated on seven scenes (doc/log/static.md). */
#define CHANGING_SHARE 0.01F
#define MOVED 0.5f /* pixels: motion of an effect of 1; chosen by hand, not measured */
/* Colour difference, values of 0 to 1, of an effect of 1; chosen by hand, not measured. */
#define TINTED 0.03f
#define FADED 0.03f /* difference of opacity of an effect of 1; chosen by hand, not measured */
/* Ratio of losses that motion gains by fitting the noise of images; chosen by hand, not measured. */
#define NOISE_FIT 1.01
/* Bits of a weight; calibrated on boxes that move by pixels (doc/log/static.md, "The price of the motion networks"). */
#define WEIGHT_BITS 7
/* One in so many hidden weights stays where little moves; calibrated on the same scenes. */
#define UNITS_ONE_IN 10
/* Pixels per view in which the anchor is: minimum rendered weight of a primitive; chosen by hand, not measured. */
#define UNSEEN_SHARE 0.05f

/**
 * Weighted mean opacity of the rendered primitives relative to FAINT_MEAN, at most 1. In a scene of faint layers each layer has
 * little effect on the image, but the layers of one object move together.
 */
static float usual_opacity(const adcgs_trainer *t)
{
    const adcgs_fmodel *f = t->f;
    double drawn = 0, opacity = 0;
    for (size_t i = 0; i < t->pass->primitives.n; i++) {
        const uint32_t anchor = adcgs_anchor_of(f, (uint32_t)i);
        if (anchor >= f->n || f->keep[i] == 0 || !(t->stats.presence[anchor] > 0))
            continue;
        drawn += (double)t->stats.weight[i];
        opacity += (double)(t->stats.weight[i] * t->stats.opacity[i] / t->stats.presence[anchor]);
    }
    return drawn > 0 ? (float)fmin(1, opacity / drawn / FAINT_MEAN) : 1;
}

/**
 * Largest effect of time on each anchor's primitives. For an opaque primitive in an opaque scene, 1 is MOVED pixels of
 * motion, TINTED of colour, or FADED of opacity. Smaller effects look like noise and cost network evaluations in every frame.
 */
static adcgs_status measure_motion(adcgs_trainer *t, float *effect, adcgs_error *error)
{
    const adcgs_fmodel *f = t->f;
    const size_t slots = t->pass->primitives.n;
    float *still = adcgs_alloc(NULL, slots * ADCGS_ROWS, sizeof *still, error);
    if (!still)
        return adcgs_alloc_status(error);
    const float usual = usual_opacity(t);
    /* Scene units per pixel of the full resolution at unit distance. */
    const float pixel = (float)t->config.scale / (t->views.list[0].view.fx * (float)t->views.divide);
    adcgs_pass_forward(t->pass, f, 0, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_NONE});
    memcpy(still, t->pass->prim, slots * ADCGS_ROWS * sizeof *still);
    for (int step = 0; step < DECIDE_TIMES; step++) {
        adcgs_pass_forward(t->pass, f, (float)step / (DECIDE_TIMES - 1), &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
        for (size_t i = 0; i < slots; i++) {
            const uint32_t anchor = adcgs_anchor_of(f, (uint32_t)i);
            if (anchor >= f->n || f->keep[i] == 0)
                continue;
            const float *now = t->pass->prim;
            const float o = fmaxf(now[ADCGS_ROW_OPACITY * slots + i], still[ADCGS_ROW_OPACITY * slots + i]);
            float shift = 0, tint = 0;
            for (size_t a = 0; a < 3; a++) {
                shift = fmaxf(shift, fabsf(now[(ADCGS_ROW_MEAN + a) * slots + i] - still[(ADCGS_ROW_MEAN + a) * slots + i]));
                tint = fmaxf(tint, fabsf(now[(ADCGS_ROW_COLOUR + a) * slots + i] - still[(ADCGS_ROW_COLOUR + a) * slots + i]));
            }
            const float fade = fabsf(now[ADCGS_ROW_OPACITY * slots + i] - still[ADCGS_ROW_OPACITY * slots + i]);
            const float here = fmaxf(fmaxf(o * shift / (MOVED * pixel), o * tint / TINTED), fade / FADED);
            effect[anchor] = fmaxf(effect[anchor], here / usual);
        }
    }
    adcgs_free(NULL, still);
    return ADCGS_OK;
}

adcgs_status adcgs_test_motion_gain(adcgs_trainer *t, adcgs_error *error)
{
    const adcgs_fmodel *f = t->f;
    double stopped, moving;
    if (!f->params.time_rows)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_sample_loss(t, DECIDE_VIEWS, 0, &stopped, error));
    ADCGS_TRY(adcgs_sample_loss(t, DECIDE_VIEWS, 1, &moving, error));
    /* Unit pruning later leaves a small share of the hidden weights where little moves. */
    const size_t weights = (f->mlp[ADCGS_P_OMEGA].n + f->mlp[ADCGS_P_VARPI].n) / UNITS_ONE_IN + f->mlp[ADCGS_P_TIME].n;
    t->decisions.loss_still = stopped;
    t->decisions.loss_moving = moving;
    if (stopped > NOISE_FIT * moving + adcgs_cost_of_bit(t) * WEIGHT_BITS * (double)weights)
        return ADCGS_OK;
    memset(f->moving, 0, (size_t)f->groups * ADCGS_LANES * sizeof *f->moving);
    return ADCGS_OK;
}

/** Clears the time table if no anchor uses it. It costs nothing then, although other segments require it to be present. */
static void clear_time_table(adcgs_fmodel *f)
{
    adcgs_param *z = &f->param[ADCGS_P_TIME];
    float *const values[] = {z->p, z->m, z->v};
    for (size_t i = 0; i < ADCGS_COUNTOF(values); i++)
        memset(values[i], 0, z->n * sizeof(float));
}

/** Makes an anchor static unless it is frozen. Returns 1 if it was moving. */
static uint32_t rest(const adcgs_fmodel *f, uint32_t anchor)
{
    const int moved = f->moving[anchor] != 0 && f->trainable[anchor] != 0;
    if (moved)
        f->moving[anchor] = 0;
    return (uint32_t)moved;
}

adcgs_status adcgs_fix_unchanging(adcgs_trainer *t, adcgs_error *error)
{
    const adcgs_fmodel *f = t->f;
    if (!adcgs_fmodel_moves(f) || !(t->config.static_threshold > 0))
        return ADCGS_OK;
    float *const share = adcgs_alloc(NULL, f->n, sizeof *share, error);
    const adcgs_status status = share ? adcgs_changing_share(t, share, error) : adcgs_alloc_status(error);
    for (uint32_t i = 0; status == ADCGS_OK && i < f->n; i++)
        if (share[i] >= 0 && share[i] <= CHANGING_SHARE)
            t->decisions.unchanging += rest(f, i);
    adcgs_free(NULL, share);
    return status;
}

/** Marks anchors on which time has no visible effect. */
static adcgs_status decide_motion(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_fmodel *f = t->f;
    float *effect = adcgs_alloc(NULL, f->n, sizeof *effect, error);
    if (!effect)
        return adcgs_alloc_status(error);
    adcgs_status status = measure_motion(t, effect, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < f->n; i++)
        if (effect[i] < t->config.static_threshold)
            t->decisions.unmoved += rest(f, i);
    if (status == ADCGS_OK)
        status = adcgs_fix_unchanging(t, error);
    if (f->is_part && !adcgs_fmodel_moves(f))
        clear_time_table(f);
    adcgs_free(NULL, effect);
    return status;
}

/**
 * Drops primitives. Those with nearly no coverage go. Faint ones go too, the faintest first: they cost the most time, overfit
 * single views, and are soon replaced. In a scene made of faint primitives, the dropped ones amount to at most FAINT_SHARE of the
 * render, since nothing would replace more.
 */
static adcgs_status drop_primitives(adcgs_trainer *t, adcgs_error *error)
{
    const adcgs_fmodel *f = t->f;
    const size_t slots = t->pass->primitives.n;
    adcgs_ranked *faint = adcgs_alloc(NULL, slots, sizeof *faint, error);
    double drawn = 0, gone = 0;
    size_t n = 0;
    if (!faint)
        return adcgs_alloc_status(error);
    for (size_t i = 0; i < slots; i++) {
        const uint32_t anchor = adcgs_anchor_of(f, (uint32_t)i);
        if (anchor >= f->n || f->keep[i] == 0 || f->trainable[anchor] == 0)
            continue;
        const float there = t->stats.presence[anchor], opacity = t->stats.opacity[i];
        drawn += (double)t->stats.weight[i];
        if (t->stats.weight[i] < UNSEEN_SHARE * t->stats.in_view[anchor]) {
            f->keep[i] = 0;
            t->decisions.unseen++;
        } else if (opacity < t->config.min_mean_opacity * there)
            faint[n++] = (adcgs_ranked){-opacity / there, (uint32_t)i};
    }
    adcgs_rank(faint, n);
    for (size_t i = 0; i < n; i++) {
        gone += (double)t->stats.weight[faint[i].index];
        if (gone > FAINT_SHARE * drawn)
            break;
        f->keep[faint[i].index] = 0;
        t->decisions.faint++;
    }
    adcgs_free(NULL, faint);
    return ADCGS_OK;
}

adcgs_status adcgs_prune_and_fix(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_fmodel *f = t->f;
    const int k = f->params.k;
    if (!t->stats.n)
        return ADCGS_OK;
    ADCGS_TRY(drop_primitives(t, error));
    if (f->params.time_rows)
        ADCGS_TRY(decide_motion(t, error));
    adcgs_drop_floaters(t);
    adcgs_anchor_set s;
    ADCGS_TRY(adcgs_anchor_set_init(&s, f->n + 1, error));
    for (uint32_t i = 0; i < f->n; i++) {
        int kept = 0;
        for (int j = 0; j < k; j++)
            kept += f->keep[adcgs_fmodel_slot(f, i, j)] > 0;
        if (f->trainable[i] == 0 || (kept && !adcgs_anchor_is_idle(t, i, 0.5)))
            adcgs_anchor_set_add(&s, f->pos[i], i, 0);
    }
    t->decisions.idle += f->n - s.n;
    if (!s.n)
        adcgs_anchor_set_add(&s, f->pos[0], 0, 0);
    const adcgs_status status = adcgs_anchor_set_adopt(t, &s, error);
    adcgs_anchor_set_clear(&s);
    return status;
}
