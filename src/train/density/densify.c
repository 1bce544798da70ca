/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Growth and pruning of anchors by temporal significance (paper section 3.5). */
#include "train/density/densify.h"

#include "geom/geom.h"
#include "init/rigid/body_pose.h"
#include "train/density/anchor_set.h"
#include "train/density/floaters.h"
#include "train/density/residual_densify.h"
#include "train/density/temporal_densify.h"
#include "train/initialise.h"
#include "train/start_points.h"

#include <math.h>
#include <stdlib.h>

/* Both per densification; chosen by hand, not measured. */
enum {
    MISSING_MOST = 512,       /* maximum number of positions from residuals */
    TEMPORAL_POINTS_MAX = 256 /* maximum number of matched points */
};
/* Share of the densification period after which the budget is whole; chosen by hand, not measured. */
#define BUDGET_BY 0.8
/* Rendered weight per view, in pixels, below which an anchor is idle; chosen by hand, not measured. */
#define IDLE_PIXELS 0.2

/* ---- A set of grid cells ---- */

typedef struct cells {
    uint64_t *key; /* cell + 1, 0: empty */
    size_t mask;
} cells;

/** Inserts a cell; returns 0 if the set contains it. */
static int cells_add(cells *c, const uint32_t pos[3])
{
    const uint32_t cell[3] = {pos[0] >> 2, pos[1] >> 2, pos[2] >> 2};
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

static uint32_t find_candidates(const adcgs_trainer *t, adcgs_ranked *list)
{
    const uint32_t slots = t->pass->primitives.n;
    uint32_t n = 0;
    for (uint32_t i = 0; i < slots; i++) {
        const float w = t->stats.weight[i];
        const uint32_t anchor = adcgs_anchor_of(t->f, i);
        if (anchor >= t->f->n || t->f->trainable[anchor] == 0 || t->f->keep[i] == 0 || !(w > 1))
            continue;
        const float score = t->stats.significance[i] / w;
        if (score > t->config.densify_threshold)
            list[n++] = (adcgs_ranked){score, i};
    }
    adcgs_rank(list, n);
    return n;
}

/** Cell of a position in scene units. Returns 0 if it is outside the grid. */
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

static void add_anchors(adcgs_trainer *t, adcgs_anchor_set *s, uint32_t budget, const adcgs_ranked *list, uint32_t n,
                        cells *occupied)
{
    const float *const *mean = t->pass->primitives.mean;
    uint32_t i = 0;
    for (; i < n && s->n < budget; i++) {
        const uint32_t slot = list[i].index;
        uint32_t pos[3];
        if (cell_of(t->f, (const float[]){mean[0][slot], mean[1][slot], mean[2][slot]}, pos) && cells_add(occupied, pos))
            adcgs_anchor_set_add(s, pos, adcgs_anchor_of(t->f, slot), 1);
    }
    t->decisions.refused = n - i;
}

/* ---- Growth from residuals ---- */

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

/** Adds anchors at free positions and moves these to the front. \return their number. */
static uint32_t sow(adcgs_trainer *t, adcgs_anchor_set *s, uint32_t budget, adcgs_residual *places, uint32_t n, cells *occupied)
{
    uint32_t taken = 0;
    for (uint32_t i = 0; i < n && s->n < budget; i++) {
        uint32_t pos[3];
        if (!cell_of(t->f, places[i].x, pos) || !cells_add(occupied, pos))
            continue;
        adcgs_anchor_set_add(s, pos, nearest_anchor(t->f, pos), 1);
        places[taken++] = places[i];
    }
    return taken;
}

/** Index of the anchor at a position in scene units; f->n if there is none. */
static uint32_t anchor_at(const adcgs_fmodel *f, const float x[3])
{
    uint32_t pos[3], at = 0;
    cell_of(f, x, pos);
    while (at < f->n && memcmp(f->pos[at], pos, sizeof pos) != 0)
        at++;
    return at;
}

/** Initialises anchors grown from residuals: one pixel in size, with the image's colour and no features. */
static void dress(adcgs_fmodel *f, const adcgs_residual *places, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t at = anchor_at(f, places[i].x);
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

/** Position of a point in its body's rest pose. */
static void rest(const adcgs_trainer *t, const adcgs_stereo_point *point, float x[3])
{
    double place[3];
    adcgs_stereo_rest(&t->stereo, point, place);
    for (int a = 0; a < 3; a++)
        x[a] = (float)place[a];
}

/** The same for points of a frame. Any free voxel will do, because neighbours may have other lifetimes. */
static uint32_t add_temporal_anchors(adcgs_trainer *t, adcgs_anchor_set *s, uint32_t budget, const adcgs_stereo_point **points,
                                     uint32_t n, cells *occupied)
{
    uint32_t taken = 0;
    for (uint32_t i = 0; i < n && s->n < budget; i++) {
        uint32_t pos[3], at = 0;
        float x[3];
        rest(t, points[i], x);
        if (!cell_of(t->f, x, pos))
            continue;
        while (at < s->n && memcmp(s->pos[at], pos, sizeof pos) != 0)
            at++;
        if (at < s->n)
            continue;
        cells_add(occupied, pos); /* blocks other growth in this voxel */
        adcgs_anchor_set_add(s, pos, nearest_anchor(t->f, pos), 1);
        points[taken++] = points[i];
    }
    return taken;
}

static void init_temporal_anchors(adcgs_trainer *t, const adcgs_stereo_point *const *points, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        adcgs_residual place = {.size = 4 * points[i]->size};
        rest(t, points[i], place.x);
        const uint32_t at = anchor_at(t->f, place.x);
        memcpy(place.rgb, points[i]->rgb, sizeof place.rgb);
        dress(t->f, &place, 1);
        if (at == t->f->n)
            continue;
        adcgs_set_lifetime(t->f, at, points[i]);
        t->f->moving[at] = 1;
        t->f->body[at] = points[i]->body;
    }
}

double adcgs_densify_budget(const adcgs_train_config *c, double progress)
{
    const double ramp = fmin(1, (progress - c->densify_start) / (BUDGET_BY * (c->densify_until - c->densify_start)));
    const double from = ADCGS_MIN(c->start_anchors, c->max_anchors);
    return from + (c->max_anchors - from) * ramp;
}

/** Working memory of a densification. */
typedef struct workspace {
    adcgs_anchor_set next;
    cells occupied;
    adcgs_ranked *list;                  /* [slots] */
    adcgs_residual *missing;             /* [MISSING_MOST] */
    const adcgs_stereo_point **temporal; /* [TEMPORAL_POINTS_MAX] points of frames with large errors */
} workspace;

static void workspace_clear(workspace *w)
{
    adcgs_anchor_set_clear(&w->next);
    adcgs_free(NULL, w->occupied.key);
    adcgs_free(NULL, w->list);
    adcgs_free(NULL, w->missing);
    adcgs_free(NULL, w->temporal);
}

static adcgs_status workspace_init(workspace *w, const adcgs_trainer *t, uint32_t budget, adcgs_error *error)
{
    const size_t anchors = (size_t)t->f->n + budget;
    size_t buckets = 1;
    while (buckets < 4 * anchors)
        buckets *= 2;
    ADCGS_TRY(adcgs_anchor_set_init(&w->next, (uint32_t)anchors + 1, error));
    w->occupied = (cells){adcgs_alloc(NULL, buckets, sizeof *w->occupied.key, error), buckets - 1};
    w->list = adcgs_alloc(NULL, t->pass->primitives.n, sizeof *w->list, error);
    w->missing = adcgs_alloc(NULL, MISSING_MOST, sizeof *w->missing, error);
    w->temporal = adcgs_alloc(NULL, TEMPORAL_POINTS_MAX, sizeof *w->temporal, error);
    if (w->occupied.key && w->list && w->missing && w->temporal)
        return ADCGS_OK;
    workspace_clear(w);
    return adcgs_alloc_status(error);
}

static void keep_anchors(adcgs_trainer *t, workspace *w)
{
    for (uint32_t i = 0; i < t->f->n; i++)
        if (t->f->trainable[i] == 0 || !adcgs_anchor_is_idle(t, i, IDLE_PIXELS)) { /* frozen anchors cost nothing */
            cells_add(&w->occupied, t->f->pos[i]);
            adcgs_anchor_set_add(&w->next, t->f->pos[i], i, 0);
        }
    t->decisions.idle += t->f->n - w->next.n;
    if (!w->next.n)
        adcgs_anchor_set_add(&w->next, t->f->pos[0], 0, 0);
}

/**
 * True if the scene's points may leave gaps. Random points fill the visible space, but matched points omit plain or seldom seen
 * regions. Gaps are searched only while images are small.
 */
static int leaves_gaps(const adcgs_trainer *t, double progress)
{
    return t->scene->points.n >= ADCGS_POINTS_LEAST && progress < t->config.quarter_size_until;
}

adcgs_status adcgs_densify(adcgs_trainer *t, double progress, adcgs_error *error)
{
    const uint32_t budget = (uint32_t)adcgs_densify_budget(&t->config, progress);
    uint32_t n_missing = 0, n_temporal = 0;
    workspace w;
    ADCGS_TRY(workspace_init(&w, t, budget, error));
    keep_anchors(t, &w);
    adcgs_status status = ADCGS_OK;
    if (leaves_gaps(t, progress) && t->config.residual_densify)
        status = adcgs_residual_find(t, w.missing, MISSING_MOST, &n_missing, error);
    if (status == ADCGS_OK && t->config.params.spans && t->stereo.n_moving)
        status = adcgs_temporal_densify_find(t, w.temporal, TEMPORAL_POINTS_MAX, &n_temporal, error);
    if (status == ADCGS_OK) {
        n_temporal = add_temporal_anchors(t, &w.next, w.next.n + (budget > w.next.n ? (budget - w.next.n) / 2 : 0), w.temporal,
                                          n_temporal, &w.occupied);
        n_missing = sow(t, &w.next, budget, w.missing, n_missing, &w.occupied);
        adcgs_drop_floaters(t);
        adcgs_pass_forward(t->pass, t->f, 0, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_NONE}); /* canonical positions */
        add_anchors(t, &w.next, budget, w.list, find_candidates(t, w.list), &w.occupied);
        t->decisions.most = ADCGS_MAX(t->decisions.most, w.next.n);
        status = adcgs_anchor_set_adopt(t, &w.next, error);
    }
    if (status == ADCGS_OK) {
        dress(t->f, w.missing, n_missing);
        init_temporal_anchors(t, w.temporal, n_temporal);
    }
    workspace_clear(&w);
    return status;
}
