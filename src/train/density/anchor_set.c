/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The next set of anchors of a run. */
#include "train/density/anchor_set.h"

#include "geom/geom.h"

#include <math.h>
#include <stdlib.h>

/* Log of scale: a new anchor has shorter offsets than its source; chosen by hand, not measured. */
#define OFFSETS_SMALLER 0.6f
#define SHAPES_SMALLER 0.4f /* log of scale: and smaller primitives; chosen by hand, not measured */
/* Sum of presence over views, below which nothing is known of an anchor; chosen by hand, not measured. */
#define PRESENCE_LEAST 0.25f

void adcgs_anchor_set_clear(adcgs_anchor_set *s)
{
    adcgs_free(NULL, s->pos);
    adcgs_free(NULL, s->source);
    adcgs_free(NULL, s->order);
    adcgs_free(NULL, s->fresh);
}

adcgs_status adcgs_anchor_set_init(adcgs_anchor_set *s, uint32_t capacity, adcgs_error *error)
{
    s->n = 0;
    s->capacity = capacity;
    s->pos = adcgs_alloc(NULL, capacity, sizeof *s->pos, error);
    s->source = adcgs_alloc(NULL, capacity, sizeof *s->source, error);
    s->order = adcgs_alloc(NULL, capacity, sizeof *s->order, error);
    s->fresh = adcgs_alloc(NULL, capacity, sizeof *s->fresh, error);
    if (s->pos && s->source && s->order && s->fresh)
        return ADCGS_OK;
    adcgs_anchor_set_clear(s);
    return adcgs_alloc_status(error);
}

void adcgs_anchor_set_add(adcgs_anchor_set *s, const uint32_t pos[3], uint32_t source, int fresh)
{
    memcpy(s->pos[s->n], pos, sizeof s->pos[0]);
    s->source[s->n] = source;
    s->fresh[s->n++] = (uint8_t)fresh;
}

adcgs_status adcgs_anchor_set_adopt(adcgs_trainer *t, adcgs_anchor_set *s, adcgs_error *error)
{
    uint32_t *source = adcgs_alloc(NULL, s->n, sizeof *source, error);
    uint8_t *fresh = adcgs_alloc(NULL, s->n, 1, error);
    adcgs_status status = source && fresh ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        const int sorted = adcgs_morton_sort(&s->pos[0][0], s->n, s->order, error);
        status = sorted < 0 ? (adcgs_status)sorted : ADCGS_OK;
    }
    for (uint32_t i = 0; status == ADCGS_OK && i < s->n; i++) {
        source[i] = s->source[s->order[i]];
        fresh[i] = s->fresh[s->order[i]];
    }
    if (status == ADCGS_OK)
        status = adcgs_fmodel_regroup(t->f, (const uint32_t(*)[3])s->pos, source, fresh, s->n, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < s->n; i++)
        for (int a = 0; fresh[i] && a < 3; a++) {
            *adcgs_fmodel_at(t->f, ADCGS_P_SIGMA, i, a) -= OFFSETS_SMALLER;
            *adcgs_fmodel_at(t->f, ADCGS_P_SIGMA, i, 3 + a) -= SHAPES_SMALLER;
        }
    adcgs_free(NULL, source);
    adcgs_free(NULL, fresh);
    return status == ADCGS_OK ? adcgs_trainer_resize(t, error) : status;
}

int adcgs_anchor_is_idle(const adcgs_trainer *t, uint32_t anchor, double min_pixels)
{
    const int k = t->f->params.k;
    float opacity = 0;
    double weight = 0;
    for (int i = 0; i < k; i++) {
        const size_t slot = adcgs_fmodel_slot(t->f, anchor, i);
        opacity = fmaxf(opacity, t->stats.opacity[slot]);
        weight += t->stats.weight[slot];
    }
    /* Means over the frames in its lifetime. An anchor whose lifetime had no frame stays. */
    const float n = t->stats.presence[anchor], in_view = t->stats.in_view[anchor];
    if (!(n > PRESENCE_LEAST))
        return 0;
    if (opacity < t->config.prune_opacity * n)
        return 1;
    return in_view > PRESENCE_LEAST ? weight < min_pixels * (double)in_view : t->stats.n >= t->views.n;
}

static int by_score(const void *a, const void *b)
{
    const adcgs_ranked *x = a, *y = b;
    if (x->score != y->score)
        return x->score < y->score ? 1 : -1;
    return (x->index > y->index) - (x->index < y->index);
}

void adcgs_rank(adcgs_ranked *list, size_t n)
{
    qsort(list, n, sizeof *list, by_score);
}
