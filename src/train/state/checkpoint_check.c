/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Validation of checkpoints. */
#include "train/state/checkpoint_check.h"

#include "geom/geom.h"
#include "net/net.h"

#include <math.h>

enum { EXPONENT_MAX = 40 }; /* bits: bound of the stream syntax (spec), definition */

const char *adcgs_checkpoint_check_places(const adcgs_fmodel *f, const uint32_t (*pos)[3], uint32_t n)
{
    uint64_t before = 0;
    for (uint32_t i = 0; i < n; i++) {
        const int outside = (pos[i][0] | pos[i][1] | pos[i][2]) >> f->shape.depth != 0;
        const uint64_t code = outside ? 0 : adcgs_morton(pos[i]);
        if (outside || (i > 0 && code <= before))
            return "an anchor is outside the grid, or not in Morton order";
        before = code;
    }
    return NULL;
}

/** True if each value is 0 or 1. */
static int are_flags(const float *v, size_t n)
{
    int bad = 0;
    for (size_t i = 0; i < n; i++)
        bad |= adcgs_float_bits(v[i]) != 0 && adcgs_float_bits(v[i]) != 0x3f800000;
    return !bad;
}

static int are_at_most(const uint8_t *v, size_t n, int most)
{
    int bad = 0;
    for (size_t i = 0; i < n; i++)
        bad |= v[i] > most;
    return !bad;
}

/** Checks the rows and views that training has reached. */
static int curriculum_is_sound(const adcgs_trainer *t)
{
    const adcgs_curriculum *c = &t->curriculum;
    const int rows = t->f->params.time_rows;
    return c->n <= c->n_views && (!c->n || !rows || (c->first >= 0 && c->first <= c->last && c->last < rows));
}

static int flags_are_sound(const adcgs_trainer *t)
{
    const uint8_t flags[] = {t->rate.lambda_used, t->stage.fixed_unchanging, t->stage.motion_tested, t->stage.pruned,
                             t->stage.tiered,     t->stage.rounding,         t->stage.frozen};
    return are_at_most(flags, sizeof flags, 1) && t->stage.units_pruned <= 2 && (!t->stage.frozen || t->stage.rounding);
}

/** Checks the control variables. Trained values need not be finite: a run that finds one that is not rolls back by itself. */
static int numbers_are_sound(const adcgs_trainer *t)
{
    const double numbers[] = {(double)t->run.lr_scale, t->rate.contrast,     t->rate.lambda,
                              t->run.least_mse,        t->run.elapsed.clock, t->run.elapsed.cpu};
    for (size_t i = 0; i < ADCGS_COUNTOF(numbers); i++)
        if (!isfinite(numbers[i]) || numbers[i] < 0)
            return 0;
    return t->run.lr_scale <= 1;
}

/** Checks weight steps: an exponent that a stream can hold, or none. */
static int steps_are_sound(const adcgs_mlp *m)
{
    for (int l = 0; m->n && l <= m->hidden; l++)
        if (m->weight_step[l] != ADCGS_WEIGHT_STEP_NONE && (m->weight_step[l] < 0 || m->weight_step[l] > EXPONENT_MAX))
            return 0;
    return 1;
}

static const char *check_anchors(const adcgs_fmodel *f)
{
    const size_t lanes = (size_t)f->groups * ADCGS_LANES;
    if (!are_flags(f->keep, lanes * f->params.k) || !are_flags(f->moving, lanes) || !are_flags(f->trainable, lanes))
        return "an anchor's flag is neither 0 nor 1";
    if (!are_at_most(f->body, lanes, f->params.bodies) || !are_at_most(f->tier, lanes, f->finest))
        return "an anchor belongs to a body or a tier that does not exist";
    if (!are_at_most(f->growth, sizeof f->growth, ADCGS_GROWTH_MAX))
        return "a growth is out of range";
    return NULL;
}

const char *adcgs_checkpoint_check(const adcgs_trainer *t)
{
    const char *const wrong = check_anchors(t->f);
    if (wrong)
        return wrong;
    if (!curriculum_is_sound(t))
        return "the time curriculum is out of range";
    if (!flags_are_sound(t))
        return "the stage of the run is invalid";
    if (!numbers_are_sound(t))
        return "a control variable of the run is out of range";
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        if (!steps_are_sound(&t->f->mlp[i]))
            return "a network's weight step is out of range";
    return NULL;
}
