/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kept anchors of the predicted segments of a recipe: modes and differences. */
#include "random_model.h"
#include "recipe_plan.h"

#include "model/inter_priv.h"

static int draw(adcgs_plan *plan, int lo, int hi)
{
    return (int)adcgs_random_range(&plan->state, lo, hi);
}

static adcgs_inter_mode pick_mode(adcgs_plan *plan, uint32_t anchor)
{
    static const adcgs_inter_mode turns[] = {ADCGS_INTER_DROPPED, ADCGS_INTER_SAME, ADCGS_INTER_REFINED};
    switch (plan->kept) {
    case ADCGS_HOLD_ALL:
        return ADCGS_INTER_SAME;
    case ADCGS_HOLD_REFINED:
        return ADCGS_INTER_REFINED;
    case ADCGS_HOLD_NONE:
        return ADCGS_INTER_DROPPED;
    case ADCGS_HOLD_FIRST:
        return anchor ? ADCGS_INTER_DROPPED : ADCGS_INTER_SAME;
    case ADCGS_HOLD_TURNS:
        return turns[anchor % 3];
    default:
        return turns[draw(plan, 0, 2)];
    }
}

/* The latent after a difference is added. turn counts the differences, so that both signs and all lengths of code occur. */
static int32_t change(adcgs_plan *plan, int32_t before, int turn)
{
    const int sign = turn & 1 ? -1 : 1, prefix = turn / 2 % 9;
    switch (plan->differences) {
    case ADCGS_CHANGE_ESCAPES:
        return before + 64 * sign * (15 + (1 << prefix) - 1 + draw(plan, 0, (1 << prefix) - 1));
    case ADCGS_CHANGE_CLIPS:
        return 40000 * sign;
    default:
        return before + 64 * draw(plan, 0, 1) * draw(plan, -3, 3);
    }
}

static void refine(adcgs_plan *plan, adcgs_inter *kept, const adcgs_model *before, uint32_t anchor, int *turn)
{
    for (int g = 0; g < ADCGS_INTER_GROUPS; g++) {
        const int n = adcgs_inter_channels(&before->params, g);
        const int coded = g == ADCGS_INTER_SIGMA && before->is_static[anchor] ? ADCGS_SIGMA_N : n;
        int16_t *const row = kept->rows[g] + (size_t)anchor * (size_t)n;
        for (int c = 0; plan->changed >> g & 1 && c < coded; c++)
            row[c] = (int16_t)adcgs_clip(change(plan, row[c], (*turn)++), 32767);
    }
}

adcgs_status adcgs_plan_keep(adcgs_plan *plan, const adcgs_model *before, adcgs_inter *kept, adcgs_error *error)
{
    int turn = 0;
    ADCGS_TRY(adcgs_inter_alloc(kept, before, NULL, error));
    for (uint32_t i = 0; i < before->n; i++) {
        kept->mode[i] = (uint8_t)pick_mode(plan, i);
        kept->n += kept->mode[i] != ADCGS_INTER_DROPPED;
        if (kept->mode[i] == ADCGS_INTER_REFINED)
            refine(plan, kept, before, i, &turn);
    }
    return ADCGS_OK;
}
