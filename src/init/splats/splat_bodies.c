/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rigid bodies among tracks of splats. */
#include "config.h"

#include "init/splats/splat_bodies.h"

#include "init/rigid/body_pose.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define TRIALS 48           /* samples for each body */
#define NEIGHBOURS 8        /* tracks of a sample: a track and those nearest to it */
#define TOLERANCE 0.006     /* scene units: a member is at most this far from its place in the body */
#define FOLLOWS 0.9         /* share of the frames in which a member is there */
#define MEMBERS_LEAST 20    /* members of a body, at least */
#define SHARE_LEAST 0.02    /* of the moving tracks, the same */
#define CANDIDATES_MAX 4000 /* tracks that are tested in a trial, evenly spread */

typedef struct search {
    const adcgs_splat_tracks *t;
    uint32_t n, rest;
    uint32_t *track;     /**< [n] candidates: moving, visible in all frames, of no body yet */
    adcgs_rigid *motion; /**< [frames] from the rest frame */
} search;

static void position(double x[3], const search *s, uint32_t candidate, uint32_t frame)
{
    const float *const p = adcgs_splat_track_at(s->t, s->track[candidate], frame);
    for (int a = 0; a < 3; a++)
        x[a] = (double)p[a];
}

/** The least-squares motion of members (candidates) from the rest frame to each frame. */
static void fit(search *s, const uint32_t *member, uint32_t n)
{
    for (uint32_t f = 0; f < s->t->frames; f++) {
        adcgs_rigid_sums sums = {.weight = 0};
        for (uint32_t i = 0; i < n; i++) {
            double from[3], to[3];
            position(from, s, member[i], s->rest);
            position(to, s, member[i], f);
            adcgs_rigid_add(&sums, from, to, 1.0);
        }
        adcgs_rigid_fit(&sums, &s->motion[f]);
    }
}

static int follows(const search *s, uint32_t candidate)
{
    uint32_t there = 0;
    double rest[3], x[3], to[3];
    position(rest, s, candidate, s->rest);
    for (uint32_t f = 0; f < s->t->frames; f++) {
        adcgs_rigid_apply(&s->motion[f], rest, to);
        position(x, s, candidate, f);
        double square = 0.0;
        for (int a = 0; a < 3; a++)
            square += (x[a] - to[a]) * (x[a] - to[a]);
        there += square <= TOLERANCE * TOLERANCE;
        if ((double)(f + 1 - there) > (1.0 - FOLLOWS) * s->t->frames)
            return 0;
    }
    return 1;
}

/** Candidates that follow the motion, every step'th tested. \return their number */
static uint32_t collect(const search *s, uint32_t *member, uint32_t step)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->n; i += step)
        if (follows(s, i))
            member[n++] = i;
    return n;
}

/** A candidate and those nearest to it in the rest frame. */
static uint32_t sample(const search *s, uint32_t seed, uint32_t member[NEIGHBOURS])
{
    double far[NEIGHBOURS], x[3], y[3];
    uint32_t n = 0;
    position(x, s, seed, s->rest);
    for (uint32_t i = 0; i < s->n; i++) {
        double square = 0.0;
        position(y, s, i, s->rest);
        for (int a = 0; a < 3; a++)
            square += (x[a] - y[a]) * (x[a] - y[a]);
        if (n == NEIGHBOURS && square >= far[n - 1])
            continue;
        uint32_t at = n < NEIGHBOURS ? n++ : n - 1;
        for (; at > 0 && far[at - 1] > square; at--) {
            far[at] = far[at - 1];
            member[at] = member[at - 1];
        }
        far[at] = square;
        member[at] = i;
    }
    return n;
}

/** The members of the best body; scratch and best: [n]. */
static uint32_t find_one(search *s, uint32_t *best, uint32_t *scratch)
{
    const uint32_t step = s->n / CANDIDATES_MAX + 1;
    uint32_t most = 0, near[NEIGHBOURS], seed_of_best = 0;
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        const uint32_t seed = (uint32_t)(((uint64_t)trial * 2 + 1) * s->n / (2 * TRIALS));
        fit(s, near, sample(s, seed, near));
        const uint32_t n = collect(s, scratch, step);
        if (n > most) {
            most = n;
            seed_of_best = seed;
        }
    }
    if (!most)
        return 0;
    fit(s, near, sample(s, seed_of_best, near));
    uint32_t n = collect(s, best, 1);
    for (int pass = 0; pass < 2 && n; pass++) {
        fit(s, best, n);
        n = collect(s, best, 1);
    }
    return n;
}

static adcgs_status write_body(adcgs_stereo_body *b, const search *s, const uint32_t *member, uint32_t n, adcgs_error *error)
{
    *b = (adcgs_stereo_body){.n = n, .pose = adcgs_alloc(NULL, s->t->frames, sizeof *b->pose, error)};
    if (!b->pose)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n; i++) {
        double x[3];
        position(x, s, member[i], s->rest);
        for (int a = 0; a < 3; a++)
            b->pivot[a] += x[a] / n;
    }
    for (uint32_t f = 0; f < s->t->frames; f++)
        adcgs_stereo_pose_set(&b->pose[f], &s->motion[f], b->pivot);
    adcgs_stereo_poses_align(b->pose, s->t->frames);
    return ADCGS_OK;
}

/** Removes the members from the candidates. */
static void claim(search *s, uint8_t *body, uint8_t number, const uint32_t *member, uint32_t n)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < n; i++)
        body[s->track[member[i]]] = number;
    for (uint32_t i = 0; i < s->n; i++)
        if (!body[s->track[i]])
            s->track[left++] = s->track[i];
    s->n = left;
}

static int is_always_visible(const adcgs_splat_tracks *t, uint32_t i)
{
    for (uint32_t f = 0; f < t->frames; f++)
        if (!adcgs_splat_track_is_visible(t, i, f))
            return 0;
    return 1;
}

adcgs_status adcgs_splat_bodies_find(adcgs_stereo *out, uint8_t *body, const adcgs_splat_tracks *t, const uint8_t *kind,
                                     uint8_t moving, uint32_t rest, uint32_t most, adcgs_error *error)
{
    search s = {.t = t, .rest = rest};
    s.track = adcgs_alloc(NULL, (size_t)t->n + 1, sizeof *s.track, error);
    s.motion = adcgs_alloc(NULL, t->frames, sizeof *s.motion, error);
    uint32_t *const best = adcgs_alloc(NULL, (size_t)t->n + 1, sizeof *best, error);
    uint32_t *const scratch = adcgs_alloc(NULL, (size_t)t->n + 1, sizeof *scratch, error);
    out->body = adcgs_alloc(NULL, (size_t)most + 1, sizeof *out->body, error);
    adcgs_status status = s.track && s.motion && best && scratch && out->body ? ADCGS_OK : adcgs_alloc_status(error);
    for (uint32_t i = 0; status == ADCGS_OK && i < t->n; i++)
        if (kind[i] == moving && is_always_visible(t, i))
            s.track[s.n++] = i;
    const uint32_t least = (uint32_t)fmax(MEMBERS_LEAST, SHARE_LEAST * s.n);
    while (status == ADCGS_OK && out->n_bodies < most && s.n >= least) {
        const uint32_t n = find_one(&s, best, scratch);
        if (n < least)
            break;
        status = write_body(&out->body[out->n_bodies], &s, best, n, error);
        if (status == ADCGS_OK)
            claim(&s, body, (uint8_t)++out->n_bodies, best, n);
    }
    adcgs_free(NULL, s.track);
    adcgs_free(NULL, s.motion);
    adcgs_free(NULL, best);
    adcgs_free(NULL, scratch);
    return status;
}
