/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Growth and pruning of anchors by temporal significance (paper section 3.5), and the final decisions. */
#include "train/trainer.h"

#include "geom/geom.h"
#include "train/initialise.h"
#include "train/residual_densify.h"

#include <math.h>
#include <stdlib.h>

/* ---- A set of grid cells ---- */

typedef struct cells {
    uint64_t *key; /* cell + 1, 0: empty */
    size_t mask;
} cells;

/** Insert a cell; returns 0 if it was there already. */
static int cells_add(cells *c, const uint32_t pos[3])
{
    const uint32_t cell[3] = { pos[0] >> 2, pos[1] >> 2, pos[2] >> 2 };
    const uint64_t key = adcgs_morton(cell) + 1;
    size_t at = (size_t)((key * 0x9e3779b97f4a7c15u) >> 20) & c->mask;
    while (c->key[at]) {
        if (c->key[at] == key)
            return 0;
        at = (at + 1) & c->mask;
    }
    c->key[at] = key;
    return 1;
}

/* ---- Growth candidates ---- */

typedef struct candidate {
    float score;
    uint32_t slot;
} candidate;

static int by_score(const void *a, const void *b)
{
    const candidate *x = a, *y = b;
    if (x->score != y->score)
        return x->score < y->score ? 1 : -1;
    return (x->slot > y->slot) - (x->slot < y->slot);
}

static uint32_t anchor_of(const adcgs_fmodel *f, uint32_t slot)
{
    return slot / (64u * f->params.k) * 64 + slot % 64;
}

static uint32_t find_candidates(const adcgs_trainer *t, candidate *list)
{
    const uint32_t slots = t->pass->primitives.n;
    uint32_t n = 0;
    for (uint32_t i = 0; i < slots; i++) {
        const float w = t->stats.weight[i];
        if (anchor_of(t->f, i) >= t->f->n || !(w > 1))
            continue;
        const float score = t->stats.significance[i] / w;
        if (score > t->config.grow_threshold)
            list[n++] = (candidate){ score, i };
    }
    qsort(list, n, sizeof *list, by_score);
    return n;
}

/** Anchors whose primitives stay transparent or cover next to nothing. */
static int is_idle(const adcgs_trainer *t, uint32_t anchor, double min_pixels)
{
    const int k = t->f->params.k;
    float opacity = 0;
    double weight = 0;
    for (int i = 0; i < k; i++) {
        const size_t slot = adcgs_fmodel_slot(t->f, anchor, i);
        opacity = fmaxf(opacity, t->stats.opacity[slot]);
        weight += t->stats.weight[slot];
    }
    return opacity < t->config.prune_opacity * (float)t->stats.n || weight < min_pixels * t->stats.n;
}

/** The next set of anchors. */
typedef struct next_set {
    uint32_t n, capacity;
    uint32_t (*pos)[3];
    uint32_t *source, *order;
    uint8_t *fresh;
} next_set;

static void next_clear(next_set *s)
{
    free(s->pos);
    free(s->source);
    free(s->order);
    free(s->fresh);
}

static adcgs_status next_init(next_set *s, uint32_t capacity, adcgs_error *error)
{
    s->n = 0;
    s->capacity = capacity;
    s->pos = malloc(capacity * sizeof *s->pos);
    s->source = malloc(capacity * sizeof *s->source);
    s->order = malloc(capacity * sizeof *s->order);
    s->fresh = malloc(capacity * sizeof *s->fresh);
    if (s->pos && s->source && s->order && s->fresh)
        return ADCGS_OK;
    next_clear(s);
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %u anchors", capacity);
}

static void next_add(next_set *s, const uint32_t pos[3], uint32_t source, int fresh)
{
    memcpy(s->pos[s->n], pos, sizeof s->pos[0]);
    s->source[s->n] = source;
    s->fresh[s->n++] = (uint8_t)fresh;
}

/** The cell of a place in scene units; 0 if it is outside the grid. */
static int cell_of(const adcgs_fmodel *f, const float x[3], uint32_t pos[3])
{
    const uint32_t side = 1u << f->shape.depth;
    int inside = 1;
    for (int a = 0; a < 3; a++) {
        const float v = floorf((x[a] - f->origin[a]) / f->voxel);
        inside &= v >= 0 && v < (float)side;
        pos[a] = inside ? (uint32_t)v : 0;
    }
    return inside;
}

static void grow(adcgs_trainer *t, next_set *s, uint32_t budget, const candidate *list, uint32_t n, cells *occupied)
{
    const float *const *mean = t->pass->primitives.mean;
    for (uint32_t i = 0; i < n && s->n < budget; i++) {
        const uint32_t slot = list[i].slot;
        uint32_t pos[3];
        if (cell_of(t->f, (const float[]){ mean[0][slot], mean[1][slot], mean[2][slot] }, pos) && cells_add(occupied, pos))
            next_add(s, pos, anchor_of(t->f, slot), 1);
    }
}

/* ---- Growth where something is missing ---- */

enum { MISSING_MOST = 512 };

static uint32_t nearest_anchor(const adcgs_fmodel *f, const uint32_t pos[3])
{
    double least = INFINITY;
    uint32_t nearest = 0;
    for (uint32_t i = 0; i < f->n; i++) {
        double d = 0;
        for (int a = 0; a < 3; a++)
            d += pow((double)f->pos[i][a] - (double)pos[a], 2);
        if (d < least) {
            least = d;
            nearest = i;
        }
    }
    return nearest;
}

/** Take in the places that are free, moved to the front; returns how many. */
static uint32_t sow(adcgs_trainer *t, next_set *s, uint32_t budget, adcgs_missing *places, uint32_t n, cells *occupied)
{
    uint32_t taken = 0;
    for (uint32_t i = 0; i < n && s->n < budget; i++) {
        uint32_t pos[3];
        if (!cell_of(t->f, places[i].x, pos) || !cells_add(occupied, pos))
            continue;
        next_add(s, pos, nearest_anchor(t->f, pos), 1);
        places[taken++] = places[i];
    }
    return taken;
}

/** Anchors where something was missing begin as small as a pixel, in its colour, with no features. */
static void dress(adcgs_fmodel *f, const adcgs_missing *places, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        uint32_t pos[3], at = 0;
        cell_of(f, places[i].x, pos);
        while (at < f->n && memcmp(f->pos[at], pos, sizeof pos) != 0)
            at++;
        if (at == f->n)
            continue;
        for (int a = 0; a < 3; a++) {
            *adcgs_fmodel_at(f, ADCGS_P_SIGMA, at, a) = *adcgs_fmodel_at(f, ADCGS_P_SIGMA, at, 3 + a) = logf(places[i].size);
            *adcgs_fmodel_at(f, ADCGS_P_COLOUR, at, a) = places[i].rgb[a];
        }
        for (int a = 0; a < adcgs_fmodel_rows(f, ADCGS_P_FV); a++)
            *adcgs_fmodel_at(f, ADCGS_P_FV, at, a) = 0;
    }
}

/** Sort the set, hand it to the model, and shrink what is new: half the reach, smaller primitives. */
static adcgs_status adopt(adcgs_trainer *t, next_set *s, adcgs_error *error)
{
    uint32_t *source = malloc(s->n * sizeof *source);
    uint8_t *fresh = malloc(s->n);
    if (!source || !fresh) {
        free(source);
        free(fresh);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %u anchors", s->n);
    }
    adcgs_morton_sort(&s->pos[0][0], s->n, s->order, error);
    for (uint32_t i = 0; i < s->n; i++) {
        source[i] = s->source[s->order[i]];
        fresh[i] = s->fresh[s->order[i]];
    }
    adcgs_status status = adcgs_fmodel_regroup(t->f, (const uint32_t(*)[3])s->pos, source, fresh, s->n, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < s->n; i++)
        for (int a = 0; fresh[i] && a < 3; a++) {
            *adcgs_fmodel_at(t->f, ADCGS_P_SIGMA, i, a) -= 0.6f;
            *adcgs_fmodel_at(t->f, ADCGS_P_SIGMA, i, 3 + a) -= 0.4f;
        }
    free(source);
    free(fresh);
    return status == ADCGS_OK ? adcgs_trainer_resize(t, error) : status;
}

double adcgs_trainer_budget(const adcgs_train_config *c, double progress)
{
    const double ramp = fmin(1, (progress - c->grow_from) / (0.8 * (c->grow_until - c->grow_from)));
    const double from = ADCGS_MIN(c->start_anchors, c->max_anchors);
    return from + (c->max_anchors - from) * ramp;
}

/** What a refinement works with. */
typedef struct workspace {
    next_set next;
    cells occupied;
    candidate *list;        /* [slots] */
    adcgs_missing *missing; /* [MISSING_MOST] */
} workspace;

static void workspace_clear(workspace *w)
{
    next_clear(&w->next);
    free(w->occupied.key);
    free(w->list);
    free(w->missing);
}

static adcgs_status workspace_init(workspace *w, const adcgs_trainer *t, uint32_t budget, adcgs_error *error)
{
    const size_t anchors = (size_t)t->f->n + budget;
    size_t buckets = 1;
    while (buckets < 4 * anchors)
        buckets *= 2;
    ADCGS_TRY(next_init(&w->next, (uint32_t)anchors + 1, error));
    w->occupied = (cells){ calloc(buckets, sizeof *w->occupied.key), buckets - 1 };
    w->list = malloc((size_t)t->pass->primitives.n * sizeof *w->list);
    w->missing = malloc(MISSING_MOST * sizeof *w->missing);
    if (w->occupied.key && w->list && w->missing)
        return ADCGS_OK;
    workspace_clear(w);
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for refinement");
}

static void keep_anchors(const adcgs_trainer *t, workspace *w)
{
    for (uint32_t i = 0; i < t->f->n; i++)
        if (!is_idle(t, i, 0.2)) {
            cells_add(&w->occupied, t->f->pos[i]);
            next_add(&w->next, t->f->pos[i], i, 0);
        }
    if (!w->next.n)
        next_add(&w->next, t->f->pos[0], 0, 0);
}

/**
 * Random points fill the space that cameras see; a scene's own, as matched between pictures, leave out what is plain or seldom
 * seen. Gaps are looked for while pictures are small.
 */
static int leaves_gaps(const adcgs_trainer *t, double progress)
{
    return t->scene->points.n >= ADCGS_POINTS_LEAST && progress < t->config.quarter_until;
}

adcgs_status adcgs_trainer_refine(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const uint32_t budget = (uint32_t)adcgs_trainer_budget(&t->config, progress);
    uint32_t n_missing = 0;
    workspace w;
    ADCGS_TRY(workspace_init(&w, t, budget, error));
    keep_anchors(t, &w);
    adcgs_status status = ADCGS_OK;
    if (leaves_gaps(t, progress))
        status = adcgs_trainer_missing(t, w.missing, MISSING_MOST, &n_missing, error);
    if (status == ADCGS_OK) {
        n_missing = sow(t, &w.next, budget, w.missing, n_missing, &w.occupied);
        adcgs_pass_forward(t->pass, t->f, 0, &(adcgs_pass_mode){ .deform = ADCGS_DEFORM_NONE }); /* canonical places */
        grow(t, &w.next, budget, w.list, find_candidates(t, w.list), &w.occupied);
        status = adopt(t, &w.next, error);
    }
    if (status == ADCGS_OK)
        dress(t->f, w.missing, n_missing);
    workspace_clear(&w);
    return status;
}

adcgs_status adcgs_trainer_prune(adcgs_trainer *t, uint32_t keep, adcgs_error *error)
{
    const adcgs_fmodel *f = t->f;
    next_set s;
    candidate *rank = malloc(f->n * sizeof *rank);
    uint8_t *kept = calloc(f->n, 1);
    adcgs_status status = rank && kept ? next_init(&s, f->n, error)
                                       : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %u anchors", f->n);
    if (status == ADCGS_OK) {
        for (uint32_t i = 0; i < f->n; i++) {
            rank[i] = (candidate){ 0, i };
            for (int j = 0; j < f->params.k; j++)
                rank[i].score += t->stats.weight[adcgs_fmodel_slot(f, i, j)];
        }
        qsort(rank, f->n, sizeof *rank, by_score);
        for (uint32_t i = 0; i < ADCGS_MIN(f->n, ADCGS_MAX(keep, 1)); i++)
            kept[rank[i].slot] = 1;
        for (uint32_t i = 0; i < f->n; i++)
            if (kept[i])
                next_add(&s, f->pos[i], i, 0);
        status = adopt(t, &s, error);
        next_clear(&s);
    }
    free(rank);
    free(kept);
    return status;
}

/* ---- Decisions before rounding ---- */

enum { DECIDE_TIMES = 16, DECIDE_VIEWS = 32 };

/**
 * Largest effect of time on each anchor's primitives. 1 is half a pixel of way, or 0.03 of colour, for an opaque one, or 0.03
 * of opacity: what lies below is seen as noise, and costs every frame its networks.
 */
static void measure_motion(adcgs_trainer *t, float *effect)
{
    const adcgs_fmodel *f = t->f;
    const size_t slots = t->pass->primitives.n;
    float *still = malloc(slots * 14 * sizeof *still);
    if (!still) { /* without memory every anchor counts as moving: correct, only larger */
        for (uint32_t i = 0; i < f->n; i++)
            effect[i] = 1e9f;
        return;
    }
    /* Scene units per pixel of the full resolution at unit distance. */
    const float pixel = (float)t->config.scale / (t->views[0].view.fx * (float)t->divide);
    adcgs_pass_forward(t->pass, f, 0, &(adcgs_pass_mode){ .deform = ADCGS_DEFORM_NONE });
    memcpy(still, t->pass->prim, slots * 14 * sizeof *still);
    for (int step = 0; step < DECIDE_TIMES; step++) {
        adcgs_pass_forward(t->pass, f, (float)step / (DECIDE_TIMES - 1), &(adcgs_pass_mode){ .deform = ADCGS_DEFORM_ALL });
        for (size_t i = 0; i < slots; i++) {
            const uint32_t anchor = anchor_of(f, (uint32_t)i);
            if (anchor >= f->n || f->keep[i] == 0)
                continue;
            const float *now = t->pass->prim;
            const float o = fmaxf(now[10 * slots + i], still[10 * slots + i]);
            float shift = 0, tint = 0;
            for (int a = 0; a < 3; a++) {
                shift = fmaxf(shift, fabsf(now[(size_t)a * slots + i] - still[(size_t)a * slots + i]));
                tint = fmaxf(tint, fabsf(now[(size_t)(11 + a) * slots + i] - still[(size_t)(11 + a) * slots + i]));
            }
            const float fade = fabsf(now[10 * slots + i] - still[10 * slots + i]);
            const float here = fmaxf(fmaxf(o * shift / (0.5f * pixel), o * tint / 0.03f), fade / 0.03f);
            effect[anchor] = fmaxf(effect[anchor], here);
        }
    }
    free(still);
}

adcgs_status adcgs_trainer_weigh(adcgs_trainer *t, adcgs_error *error)
{
    const adcgs_fmodel *f = t->f;
    double stopped, moving;
    if (!f->params.time_rows)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_trainer_sample_loss(t, DECIDE_VIEWS, 0, &stopped, error));
    ADCGS_TRY(adcgs_trainer_sample_loss(t, DECIDE_VIEWS, 1, &moving, error));
    /* Seven bits a weight; a hundredth of the loss is what networks gain by learning the noise of each picture. */
    const size_t weights = f->mlp[ADCGS_P_OMEGA].n + f->mlp[ADCGS_P_VARPI].n + f->mlp[ADCGS_P_TIME].n;
    if (stopped > 1.01 * moving + t->lambda * 7 * (double)weights * 0x1p-23)
        return ADCGS_OK;
    memset(f->moving, 0, (size_t)f->groups * 64 * sizeof *f->moving);
    return ADCGS_OK;
}

/** Mark the anchors that time does not touch. */
static adcgs_status decide_motion(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_fmodel *f = t->f;
    float *effect = calloc(f->n, sizeof *effect);
    if (!effect)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %u anchors", f->n);
    measure_motion(t, effect);
    for (uint32_t i = 0; i < f->n; i++)
        if (effect[i] < t->config.still_below)
            f->moving[i] = 0;
    free(effect);
    return ADCGS_OK;
}

/** What covers next to nothing, and large faint primitives: they cost the most time, fit single views and are soon replaced. */
static int is_superfluous(const adcgs_trainer *t, size_t slot)
{
    const float n = (float)t->stats.n;
    return t->stats.weight[slot] < 0.05f * n || t->stats.opacity[slot] < t->config.keep_opacity * n;
}

adcgs_status adcgs_trainer_decide(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_fmodel *f = t->f;
    const int k = f->params.k;
    if (!t->stats.n)
        return ADCGS_OK;
    for (uint32_t i = 0; i < f->n; i++)
        for (int j = 0; j < k; j++) {
            const size_t slot = adcgs_fmodel_slot(f, i, j);
            if (is_superfluous(t, slot))
                f->keep[slot] = 0;
        }
    if (f->params.time_rows)
        ADCGS_TRY(decide_motion(t, error));
    next_set s;
    ADCGS_TRY(next_init(&s, f->n + 1, error));
    for (uint32_t i = 0; i < f->n; i++) {
        int kept = 0;
        for (int j = 0; j < k; j++)
            kept += f->keep[adcgs_fmodel_slot(f, i, j)] > 0;
        if (kept && !is_idle(t, i, 0.5))
            next_add(&s, f->pos[i], i, 0);
    }
    if (!s.n)
        next_add(&s, f->pos[0], 0, 0);
    const adcgs_status status = adopt(t, &s, error);
    next_clear(&s);
    return status;
}
