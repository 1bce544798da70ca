/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pruning of anchors by rank. */
#include "train/density/prune.h"

#include "train/density/anchor_set.h"

adcgs_status adcgs_prune_anchors(adcgs_trainer *t, uint32_t keep, adcgs_error *error)
{
    const adcgs_fmodel *f = t->f;
    adcgs_anchor_set s;
    adcgs_ranked *ranks = adcgs_alloc(NULL, f->n, sizeof *ranks, error);
    uint8_t *kept = adcgs_alloc(NULL, f->n, 1, error);
    adcgs_status status = ranks && kept ? adcgs_anchor_set_init(&s, f->n, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        for (uint32_t i = 0; i < f->n; i++) {
            ranks[i] = (adcgs_ranked){0, i};
            for (int j = 0; j < f->params.k; j++)
                ranks[i].score += t->stats.weight[adcgs_fmodel_slot(f, i, j)];
        }
        adcgs_rank(ranks, f->n);
        for (uint32_t i = 0; i < ADCGS_MIN(f->n, ADCGS_MAX(keep, 1)); i++)
            kept[ranks[i].index] = 1;
        for (uint32_t i = 0; i < f->n; i++)
            if (kept[i])
                adcgs_anchor_set_add(&s, f->pos[i], i, 0);
        status = adcgs_anchor_set_adopt(t, &s, error);
        adcgs_anchor_set_clear(&s);
    }
    adcgs_free(NULL, ranks);
    adcgs_free(NULL, kept);
    return status;
}
