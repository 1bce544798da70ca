/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Initial poses, choice of the best, and refinement. */
#include "init/rigid/track.h"

#include "init/rigid/direct.h"
#include "init/rigid/members.h"

#include <math.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured one by one; checked against the true motion of turning boxes (test_bodies). */
enum {
    FEW = 120,    /* points of a body for trying initial poses */
    MANY = 700,   /* points of a body for refining a pose */
    BEST = 6,     /* initial poses that are refined */
    LOST_MOST = 4 /* maximum number of frames in a row without a match */
};
#define SHARE_GOOD 0.25 /* minimum share of matching points */
#define LIGHT_GOOD 0.45 /* minimum agreement of the images */
#define SHARE_SURE 0.35 /* share of matching points from which no other initial pose is tried */
#define LIGHT_SURE 0.52 /* agreement from which no other initial pose is tried */
#define ABOUT 0.97      /* relative score that counts as equally good */
#define MEASURED 64     /* points by which two poses are compared, approximately */
#define AHEAD_MOST 4    /* steps by which motion is continued at most */
#define APART 3.0       /* pixels: minimum distance between the positions about which rotations are tried */
#define TURN_STEP 0.26  /* radians between rotations */
enum { TURNS = 4, STARTS = 3 + 2 * 13 * 2 * TURNS }; /* steps to each side; 2 positions x 13 axes, geometry */

/* Reach and sharpness in pixels, and rounds, from coarse to fine; chosen by hand, not measured. */
static const adcgs_registration_stage lay_far = {.reach = 14, .sharp = 5, .rounds = 6};
static const adcgs_registration_stage lay_near = {.reach = 5, .sharp = 2.5, .rounds = 4};
static const adcgs_registration_stage lay_close = {.reach = 3, .sharp = 1.5, .rounds = 5};

static uint32_t stride_for(const adcgs_body_model *m, uint32_t wanted)
{
    return ADCGS_MAX(m->n / wanted, 1);
}

static double score_of(const adcgs_placement *p)
{
    return p->share * p->light;
}

static int is_good(const adcgs_placement *p)
{
    return p->share > SHARE_GOOD && p->light > LIGHT_GOOD;
}

static int is_sure(const adcgs_placement *p)
{
    return p->share > SHARE_SURE && p->light > LIGHT_SURE;
}

double adcgs_track_centre(const adcgs_track *t, double centre[3])
{
    double far = 0;
    memset(centre, 0, 3 * sizeof *centre);
    for (uint32_t i = 0; i < t->model.n; i++)
        for (int a = 0; a < 3; a++)
            centre[a] += t->model.p[i].x[a] / t->model.n;
    for (uint32_t i = 0; i < t->model.n; i++)
        for (int a = 0; a < 3; a++)
            far += pow(t->model.p[i].x[a] - centre[a], 2) / t->model.n;
    return sqrt(far);
}

/* ---- One frame ---- */

/** A body, the frame to search, and the best poses so far. */
typedef struct search {
    const adcgs_track *t;
    const adcgs_layers *l;
    adcgs_pool *pool;
    adcgs_placement *start; /* [STARTS] initial poses to try */
    int frame, starts, n;
    adcgs_placement best[BEST];
} search;

double adcgs_track_between(const adcgs_track *t, const adcgs_rigid *a, const adcgs_rigid *b)
{
    double sum = 0;
    const uint32_t stride = stride_for(&t->model, MEASURED);
    uint32_t n = 0;
    for (uint32_t i = 0; i < t->model.n; i += stride, n++) {
        double x[3], y[3];
        adcgs_rigid_apply(a, t->model.p[i].x, x);
        adcgs_rigid_apply(b, t->model.p[i].x, y);
        for (int k = 0; k < 3; k++)
            sum += (x[k] - y[k]) * (x[k] - y[k]);
    }
    return n ? sqrt(sum / n) : 0;
}

static void keep_best(search *s, const adcgs_placement *p)
{
    int at = s->n;
    for (int i = 0; i < s->n; i++)
        if (adcgs_track_between(s->t, &s->best[i].at, &p->at) < 2 * s->t->model.pixel) { /* the same pose again */
            if (score_of(p) <= score_of(&s->best[i]))
                return;
            at = i;
            break;
        }
    if (at == BEST && score_of(p) <= score_of(&s->best[BEST - 1]))
        return;
    at = ADCGS_MIN(at, BEST - 1);
    s->n = ADCGS_MAX(s->n, at + 1);
    for (; at > 0 && score_of(&s->best[at - 1]) < score_of(p); at--)
        s->best[at] = s->best[at - 1];
    s->best[at] = *p;
}

static void add_start(search *s, const adcgs_placement *from, const adcgs_rigid *at)
{
    s->start[s->starts] = *from;
    s->start[s->starts++].at = *at;
}

/** Adds rotations about 13 axes to both sides. */
static void add_turns(search *s, const adcgs_placement *from, const adcgs_rigid *base)
{
    double rest[3], centre[3];
    adcgs_track_centre(s->t, rest);
    adcgs_rigid_apply(base, rest, centre);
    for (int k = 14; k < 27; k++) /* one half of the 26 corners, edges and faces of a cube */
        for (int step = -TURNS; step <= TURNS; step++) {
            const double axis[3] = {k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
            const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
            const double angle = step * TURN_STEP / length;
            adcgs_rigid at;
            if (!step)
                continue;
            adcgs_rigid_about((const double[]){angle * axis[0], angle * axis[1], angle * axis[2]}, centre,
                              (const double[]){0, 0, 0}, &at);
            adcgs_rigid_then(base, &at, &at);
            add_start(s, from, &at);
        }
}

static void try_start(void *arg, int i, int thread)
{
    const search *s = arg;
    const adcgs_body_model *m = &s->t->model;
    const adcgs_frame_views *views = &s->l->views[s->frame];
    adcgs_registration_stage far = lay_far, near = lay_near;
    (void)thread;
    far.stride = near.stride = stride_for(m, FEW);
    adcgs_body_register(m, &s->l->few[s->frame], views, &far, &s->start[i]);
    adcgs_body_register(m, &s->l->all[s->frame], views, &near, &s->start[i]);
    adcgs_direct_judge(m, views, near.stride, &s->start[i]);
    adcgs_body_judge(m, &s->l->all[s->frame], views, near.stride, &s->start[i]);
}

/** Tries all initial poses that were added. */
static void try_starts(search *s)
{
    adcgs_pool_run(s->pool, try_start, s, s->starts);
    for (int i = 0; i < s->starts; i++)
        keep_best(s, &s->start[i]);
    s->starts = 0;
}

/** Refines a pose to a fraction of a pixel. */
static void refine(const adcgs_track *t, const adcgs_layers *l, int frame, int is_close, adcgs_placement *p)
{
    adcgs_registration_stage lay = lay_close;
    const adcgs_body_model *m = &t->model;
    lay.stride = stride_for(m, MANY);
    if (!is_close)
        adcgs_body_register(m, &l->all[frame], &l->views[frame], &lay, p);
    adcgs_direct_refine(m, &l->views[frame], lay.stride, p);
    adcgs_direct_judge(m, &l->views[frame], lay.stride, p);
    adcgs_body_judge(m, &l->all[frame], &l->views[frame], lay.stride, p);
}

static void refine_best(void *arg, int i, int thread)
{
    search *s = arg;
    (void)thread;
    refine(s->t, s->l, s->frame, 0, &s->best[i]);
}

static void choose(search *s, adcgs_placement *out)
{
    adcgs_pool_run(s->pool, refine_best, s, s->n);
    *out = s->best[0];
    for (int i = 1; i < s->n; i++)
        if (score_of(&s->best[i]) > score_of(out))
            *out = s->best[i];
}

/* ---- From frame to frame ---- */

/** The two frames with a known pose nearest to a frame; -1: none. */
static void find_known(const adcgs_track *t, const adcgs_layers *l, int frame, int out[2])
{
    out[0] = out[1] = -1;
    for (int off = 1; off < l->n && out[1] < 0; off++)
        for (int k = frame - off; k <= frame + off && out[1] < 0; k += 2 * off)
            if (k >= 0 && k < l->n && t->known[k])
                out[out[0] >= 0] = k;
}

void adcgs_track_extrapolate(const adcgs_track *t, const adcgs_layers *l, int frame, const int known[2], adcgs_rigid *out)
{
    const float *when = l->rig->frame_time;
    const double span = (double)(when[known[0]] - when[known[1]]), more = (double)(when[frame] - when[known[0]]);
    const int times = (int)fmin(fmax(round(more / span), -AHEAD_MOST), AHEAD_MOST);
    adcgs_rigid step;
    adcgs_rigid_inverse(&t->place[known[1]].at, &step);
    adcgs_rigid_then(&step, &t->place[known[0]].at, &step);
    if (times < 0) /* a frame between the two */
        adcgs_rigid_inverse(&step, &step);
    *out = t->place[known[0]].at;
    for (int i = 0; i < abs(times); i++)
        adcgs_rigid_then(out, &step, out);
}

/** Pose shifted by the mean velocity of the body's matching points. */
static void drift(const adcgs_track *t, const adcgs_layers *l, int frame, int known, adcgs_rigid *out)
{
    const double span = (double)(l->rig->frame_time[frame] - l->rig->frame_time[known]);
    double sum[3] = {0, 0, 0}, n = 0;
    for (uint32_t i = 0; i < t->model.n; i++) {
        double x[3], normal[3];
        uint32_t j = 0;
        if (!adcgs_body_point_at(&t->model, i, &t->place[known].at, &l->views[known], x, normal) ||
            !adcgs_body_match(&t->model, i, x, &l->all[known], &t->place[known], &j))
            continue;
        n++;
        for (int a = 0; a < 3; a++)
            sum[a] += span * (double)l->all[known].p[j].velocity[a];
    }
    *out = t->place[known].at;
    for (int a = 0; a < 3 && n > 0; a++)
        out->t[a] += sum[a] / n;
}

/** search: all members except those of the frame. */
static void find_at(adcgs_track *t, const adcgs_layers *l, int frame, int turns, search s)
{
    adcgs_rigid base[2];
    adcgs_placement place;
    int known[2];
    s.frame = frame;
    find_known(t, l, frame, known);
    const adcgs_placement *from = &t->place[known[0]];
    drift(t, l, frame, known[0], &base[1]);
    base[0] = from->at;
    if (known[1] >= 0)
        adcgs_track_extrapolate(t, l, frame, known, &base[0]);
    add_start(&s, from, &base[0]);
    try_starts(&s);
    choose(&s, &place);
    if (known[1] < 0 || !is_sure(&place)) {
        add_start(&s, from, &from->at);
        add_start(&s, from, &base[1]);
        if (turns)
            add_turns(&s, from, &base[0]);
        if (turns && adcgs_track_between(t, &base[0], &base[1]) > APART * t->model.pixel)
            add_turns(&s, from, &base[1]);
        try_starts(&s);
        choose(&s, &place);
    }
    t->known[frame] = (uint8_t)is_good(&place);
    t->place[frame] = place;
}

adcgs_status adcgs_track_run(adcgs_track *t, const adcgs_layers *l, int start, adcgs_pool *pool, adcgs_error *error)
{
    search s = {.t = t, .l = l, .pool = pool, .start = adcgs_alloc(NULL, STARTS, sizeof *s.start, error)};
    adcgs_status status = s.start ? ADCGS_OK : adcgs_alloc_status(error);
    t->place[start].at = adcgs_rigid_none;
    t->known[start] = 1;
    for (int i = 0; i < 3 * ADCGS_BODY_SIDES; i++)
        t->place[start].gain[i / 3][i % 3] = 1;
    for (int way = 1; way >= -1; way -= 2)
        for (int m = start + way, lost = 0; m >= 0 && m < l->n && lost < LOST_MOST && status == ADCGS_OK; m += way) {
            if (!l->all[m].n || t->model.n < 3) {
                lost++;
                continue;
            }
            find_at(t, l, m, !lost, s);
            lost = t->known[m] ? 0 : lost + 1;
            if (t->known[m])
                status = adcgs_members_grow(t, l, m, error);
        }
    adcgs_free(NULL, s.start);
    return status;
}

/* ---- Second pass over the frames ---- */

/** Compares the current pose with the one that continues the motion, and prefers the latter if the images agree about as well. */
static void look_again(adcgs_track *t, const adcgs_layers *l, int frame, int way)
{
    const int known[2] = {frame - way, frame - 2 * way};
    adcgs_placement on, *now = &t->place[frame];
    if (known[1] < 0 || known[1] >= l->n || !t->known[known[0]] || !t->known[known[1]] || !l->all[frame].n)
        return;
    on = t->place[known[0]];
    adcgs_track_extrapolate(t, l, frame, known, &on.at);
    refine(t, l, frame, 0, &on);
    if (!is_good(&on))
        return;
    if (t->known[frame])
        refine(t, l, frame, 1, now);
    if (!t->known[frame] || score_of(&on) > ABOUT * score_of(now))
        *now = on;
    t->known[frame] = 1;
}

void adcgs_track_rematch(adcgs_track *t, const adcgs_layers *l, int start)
{
    for (int m = start + 1; m < l->n; m++)
        look_again(t, l, m, 1);
    for (int m = start - 1; m >= 0; m--)
        look_again(t, l, m, -1);
}

typedef struct again {
    adcgs_track *t;
    const adcgs_layers *l;
} again;

static void refine_one(void *arg, int frame, int thread)
{
    const again *a = arg;
    adcgs_placement *p = &a->t->place[frame];
    (void)thread;
    if (!a->t->known[frame])
        return;
    refine(a->t, a->l, frame, 1, p);
    a->t->known[frame] = (uint8_t)is_good(p);
}

void adcgs_track_refine(adcgs_track *t, const adcgs_layers *l, adcgs_pool *pool)
{
    again a = {t, l};
    adcgs_pool_run(pool, refine_one, &a, l->n);
}
