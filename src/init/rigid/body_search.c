/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Search for rigid bodies: seeds, and acceptance tests. */
#include "init/rigid/body_search.h"

#include "init/rigid/body_result.h"
#include "init/rigid/direct.h"
#include "init/rigid/members.h"
#include "init/rigid/merge.h"
#include "model/model.h"
#include "system/sort_values.h"

#include <math.h>

/*
 * Origin, unless a line states one: chosen by hand, not measured one by one. Bodies as a whole are checked against true motion
 * (tests/unit/init/test_bodies) and on six scenes (doc/log/bodies.md, "Rigid bodies").
 */
enum {
    SEED_LEAST = 60, /* points: minimum size of a seed and of a body */
    TRIES = 12,      /* maximum number of seeds that are tracked */
    VAIN = 8,        /* maximum number of rejected seeds in a row */
    REFINEMENTS = 6, /* rounds of refinement over all frames */
    AROUND = 64,     /* maximum number of neighbours of a point */
    KNOWN_LEAST = 4  /* minimum number of frames in which a body is found */
};
#define LINK 1.2          /* distance between connected points, in units of the layers' reach */
#define EARLY 0.3         /* weight reduction of a seed at either end of the time range */
#define KNOWN_SHARE 0.4   /* minimum share of all frames in which a body is found */
#define SHARE_LEAST 0.4   /* minimum share of a body's points that match, averaged over frames */
#define MOVES_LEAST 2.0   /* pixels: minimum motion of a body */
#define LIGHT_BETTER 0.08 /* minimum gain of image agreement over the body held at one pose */
#define JUDGED 500        /* points that are compared with the images, approximately */

/*
 * Share of a shadow's points that lie on a static surface; calibrated on demo: 0.98 to 1, rotating objects 0.52 to 0.86
 * (doc/log/matching.md).
 */
#define IN_PLACE 0.9
/* Chosen by hand, not measured. */
#define TRAVELS 6.0       /* pixels: travel of the point that moves least, from which the whole body travels */
#define TRAVELS_SHARE 0.5 /* the same, relative to the mean travel of the points; one of the two suffices */
#define BESIDE 4.0        /* pixels: distance from a body within which no seed starts */
#define LEAP_LEAST 1.5    /* pixels: tolerated deviation from constant motion, constant part */
#define LEAP 0.9          /* part of it that grows with the body's step; the median over frames counts */

/** Working memory. */
typedef struct work {
    adcgs_stereo *out;
    adcgs_pool *pool;
    adcgs_layers l;
    uint8_t *tried; /* [n_moving] 1: was part of a seed */
    uint32_t *part; /* [n_moving] */
    adcgs_track t;
} work;

/* ---- Seeds ---- */

/**
 * Finds the largest connected part of any frame, with a preference for frames near the middle of time. Sets *n to 0 if no part is
 * large enough.
 */
static adcgs_status find_seed(work *w, int *frame, uint32_t *part, uint32_t *n, adcgs_error *error)
{
    double most = 0;
    *n = 0;
    for (int m = 0; m < w->l.n; m++) {
        const uint32_t begin = w->l.begin[m], points = w->l.begin[m + 1] - begin;
        const double off = fabs(2.0 * m / ADCGS_MAX(w->l.n - 1, 1) - 1);
        uint32_t parts;
        ADCGS_TRY(adcgs_cloud_parts(&w->l.all[m], LINK * w->l.reach, w->tried + begin, w->part + begin, &parts, error));
        uint32_t *size = adcgs_alloc(NULL, (size_t)parts + 1, sizeof *size, error);
        if (!size)
            return adcgs_alloc_status(error);
        for (uint32_t i = 0; i < points; i++)
            size[w->part[begin + i]]++;
        for (uint32_t k = 1; k <= parts; k++)
            if (size[k] >= SEED_LEAST && size[k] * (1 - EARLY * off) > most) {
                most = size[k] * (1 - EARLY * off);
                *frame = m;
                *part = k;
                *n = size[k];
            }
        adcgs_free(NULL, size);
    }
    return ADCGS_OK;
}

static adcgs_status plant(work *w, int frame, uint32_t part, adcgs_error *error)
{
    const uint32_t begin = w->l.begin[frame];
    w->t.model.pixel = w->l.pixel;
    for (uint32_t i = begin; i < w->l.begin[frame + 1]; i++)
        if (w->part[i] == part) {
            w->tried[i] = 1;
            ADCGS_TRY(adcgs_body_add(&w->t.model, &w->l.p[i], w->l.normal[i], error));
        }
    return ADCGS_OK;
}

/* ---- Acceptance ---- */

/** True if the body's motion is nearly constant between most frames. Tracks of chance matches jump. */
static int is_steady(const work *w)
{
    double off[ADCGS_MATCHING_FRAMES_MAX];
    uint32_t n = 0;
    int before[2] = {-1, -1};
    for (int m = 0; m < w->l.n; m++) {
        adcgs_rigid on;
        if (!w->t.known[m])
            continue;
        if (before[1] >= 0) {
            adcgs_track_extrapolate(&w->t, &w->l, m, before, &on);
            const double step = adcgs_track_between(&w->t, &w->t.place[before[0]].at, &w->t.place[m].at);
            off[n++] = adcgs_track_between(&w->t, &on, &w->t.place[m].at) / (LEAP_LEAST * w->t.model.pixel + LEAP * step);
        }
        before[1] = before[0];
        before[0] = m;
    }
    adcgs_sort(off, n);
    return n && off[n / 2] < 1;
}

typedef enum verdict { IS_NONE, IS_STILL, IS_BODY } verdict;

/** Travel of the point that moves least, from its position in frame `first`. */
static double travel(const adcgs_track *t, int n, int first)
{
    double least = -1;
    for (uint32_t i = 0; i < t->model.n; i++) {
        double from[3], to[3], far = 0;
        adcgs_rigid_apply(&t->place[first].at, t->model.p[i].x, from);
        for (int m = 0; m < n; m++) {
            adcgs_rigid_apply(&t->place[t->known[m] ? m : first].at, t->model.p[i].x, to);
            far = fmax(far, pow(to[0] - from[0], 2) + pow(to[1] - from[1], 2) + pow(to[2] - from[2], 2));
        }
        least = least < 0 ? far : fmin(least, far);
    }
    return sqrt(fmax(least, 0));
}

/**
 * True if the whole body travels, but lies on surfaces that are static most of the time: a shadow, or an uncovered background.
 */
static int is_shadow(const work *w, int first, double far)
{
    const adcgs_track *t = &w->t;
    double n = 0, in_place = 0;
    for (int m = 0; m < w->l.n; m++)
        for (uint32_t i = 0; t->known[m] && i < t->model.n; i++) {
            double x[3];
            uint32_t j;
            adcgs_rigid_apply(&t->place[m].at, t->model.p[i].x, x);
            if (!adcgs_body_match(&t->model, i, x, &w->l.all[m], &t->place[m], &j))
                continue;
            n++;
            in_place += w->l.all[m].p[j].in_place == ADCGS_PLACE_STILL;
        }
    const double all = travel(t, w->l.n, first);
    return in_place > IN_PLACE * n && (all > TRAVELS * t->model.pixel || all > TRAVELS_SHARE * far);
}

/** True if the images agree better with the moving body than with the body held at frame `rest`, under any lighting. */
static int beats_still(const work *w, int rest)
{
    const adcgs_track *t = &w->t;
    const uint32_t stride = t->model.n / JUDGED + 1;
    double better = 0;
    int away = 0;
    for (int m = 0; m < w->l.n; m++) {
        if (!t->known[m] || adcgs_track_between(t, &t->place[rest].at, &t->place[m].at) < MOVES_LEAST * t->model.pixel)
            continue;
        better += adcgs_direct_any_light(&t->model, &w->l.views[m], stride, &t->place[m].at) -
                  adcgs_direct_any_light(&t->model, &w->l.views[m], stride, &t->place[rest].at);
        away++;
    }
    return away && better > LIGHT_BETTER * away;
}

static verdict judge(const work *w)
{
    const adcgs_track *t = &w->t;
    double share = 0, far = 0;
    int known = 0, at[ADCGS_MATCHING_FRAMES_MAX];
    for (int m = 0; m < w->l.n; m++)
        if (t->known[m]) {
            at[known++] = m;
            share += t->place[m].share;
            far = fmax(far, adcgs_track_between(t, &t->place[at[0]].at, &t->place[m].at));
        }
    if (t->model.n < SEED_LEAST || known < KNOWN_LEAST || share < SHARE_LEAST * known)
        return IS_NONE;
    if (far < MOVES_LEAST * t->model.pixel)
        return IS_STILL;
    return known >= KNOWN_SHARE * w->l.n && beats_still(w, at[0]) && beats_still(w, at[known / 2]) &&
                   beats_still(w, at[known - 1]) && is_steady(w) && !is_shadow(w, at[0], far)
               ? IS_BODY
               : IS_NONE;
}

/** Blocks seeds on and near the body in the frames where it is tracked; for a static body, in all frames. */
static void exclude(work *w, int still)
{
    const adcgs_track *t = &w->t;
    for (int m = 0; m < w->l.n; m++)
        for (uint32_t i = 0; (t->known[m] || still) && i < t->model.n; i++) {
            double x[3];
            uint32_t near[AROUND];
            adcgs_rigid_apply(still ? &adcgs_rigid_none : &t->place[m].at, t->model.p[i].x, x);
            const uint32_t n = adcgs_cloud_within(&w->l.all[m], x, BESIDE * t->model.pixel, near, AROUND);
            for (uint32_t k = 0; k < n; k++)
                w->tried[w->l.begin[m] + near[k]] = 1;
        }
}

/* ---- The search ---- */

static adcgs_status refine(work *w, int start, adcgs_error *error)
{
    if (start >= 0)
        adcgs_track_rematch(&w->t, &w->l, start);
    adcgs_track_refine(&w->t, &w->l, w->pool);
    ADCGS_TRY(adcgs_track_merge(&w->t, &w->l, error));
    adcgs_members_clean(&w->t, &w->l);
    return ADCGS_OK;
}

/** Tracks and judges one seed. */
static adcgs_status try_seed(work *w, int frame, uint32_t part, verdict *is, adcgs_error *error)
{
    w->t = (adcgs_track){.model = {.n = 0}};
    adcgs_status status = plant(w, frame, part, error);
    if (status == ADCGS_OK)
        status = adcgs_track_run(&w->t, &w->l, frame, w->pool, error);
    int known = 0;
    for (int m = 0; m < w->l.n; m++)
        known += w->t.known[m];
    const int rounds = known < KNOWN_SHARE * w->l.n ? 1 : REFINEMENTS;
    for (int k = 0; k < rounds && status == ADCGS_OK; k++)
        status = refine(w, k == 1 ? frame : -1, error);
    *is = status == ADCGS_OK ? judge(w) : IS_NONE;
    return status;
}

static adcgs_status find_all(work *w, uint32_t most, adcgs_error *error)
{
    adcgs_stereo *out = w->out;
    for (int k = 0, vain = 0; k < TRIES && vain < VAIN && out->n_bodies < ADCGS_MIN(most, ADCGS_BODIES_MAX); k++) {
        uint32_t part, n;
        int frame;
        verdict is;
        ADCGS_TRY(find_seed(w, &frame, &part, &n, error));
        if (!n)
            break;
        adcgs_status status = try_seed(w, frame, part, &is, error);
        if (is == IS_BODY) {
            status = adcgs_body_write(out, &w->t, &w->l, (uint8_t)(out->n_bodies + 1), error);
            out->n_bodies += status == ADCGS_OK;
        }
        vain = is == IS_BODY ? 0 : vain + 1;
        exclude(w, is == IS_STILL);
        adcgs_body_clear(&w->t.model);
        if (status != ADCGS_OK)
            return status;
    }
    return ADCGS_OK;
}

/** Sorts the bodies by size, the largest first. */
static void sort_bodies(adcgs_stereo *out)
{
    uint8_t number[ADCGS_BODIES_MAX + 1] = {0}, order[ADCGS_BODIES_MAX];
    for (uint32_t i = 0; i < out->n_bodies; i++) {
        uint32_t k = i;
        const adcgs_stereo_body b = out->body[i];
        for (; k > 0 && out->body[k - 1].n < b.n; k--) {
            out->body[k] = out->body[k - 1];
            order[k] = order[k - 1];
        }
        out->body[k] = b;
        order[k] = (uint8_t)i;
    }
    for (uint32_t i = 0; i < out->n_bodies; i++)
        number[order[i] + 1] = (uint8_t)(i + 1);
    for (uint32_t i = 0; i < out->n_moving; i++)
        out->moving[i].body = number[out->moving[i].body];
}

adcgs_status adcgs_stereo_find_bodies(adcgs_stereo *out, adcgs_stereo_rig *rig, uint32_t most, adcgs_pool *pool,
                                      adcgs_error *error)
{
    if (rig->n_frames < KNOWN_LEAST || out->n_moving < SEED_LEAST)
        return ADCGS_OK;
    work *w = adcgs_alloc(NULL, 1, sizeof *w, error);
    if (!w)
        return adcgs_alloc_status(error);
    *w = (work){.out = out, .pool = pool};
    adcgs_status status = adcgs_stereo_rig_smooth(rig, error);
    if (status == ADCGS_OK)
        status = adcgs_layers_init(&w->l, out, rig, error);
    w->tried = adcgs_alloc(NULL, out->n_moving, 1, error);
    w->part = adcgs_alloc(NULL, out->n_moving, sizeof *w->part, error);
    out->body = adcgs_alloc(NULL, ADCGS_BODIES_MAX, sizeof *out->body, error);
    if (status == ADCGS_OK && (!w->tried || !w->part || !out->body))
        status = adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        status = find_all(w, most, error);
    if (status == ADCGS_OK)
        sort_bodies(out);
    adcgs_free(NULL, w->tried);
    adcgs_free(NULL, w->part);
    adcgs_layers_clear(&w->l);
    adcgs_free(NULL, w);
    return status;
}
