/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Initial points of anchors. */
#include "train/start_points.h"

#include "grad/random.h"
#include "init/motion_check.h"
#include "init/rigid/body_pose.h"
#include "init/splats/splat_motion.h"
#include "scene/splat_views.h"
#include "train/density/visibility.h"
#include "train/resolve.h"
#include "train/scene_frame.h"

#include <math.h>

/* Of the points; the rest are random points where matching found nothing; chosen by hand, not measured. */
#define MATCHED_SHARE 0.9
/*
 * Of all points: moving ones. With many more, anchors are too small to find motion; calibrated on cross80, one seed (same log).
 */
#define MOVING_SHARE 0.25
/* Minimum frame spacing, as share of the clip: bounds the number of lifetimes in a long clip; chosen by hand, not measured. */
#define SPACING_LEAST (1 / 15.0f)
/*
 * Factor of lifetimes for one moving camera, since more views then see an anchor; calibrated on film-cross80
 * (doc/log/matching.md).
 */
#define MONOCULAR_LIFETIMES 2.7f
#define POINTS_LOOKED_AT 1000 /* points tested for visibility in any camera; chosen by hand, not measured */
#define MOVING_MOST 2000      /* maximum number per frame for lifetimes; chosen by hand, not measured */
/* Random points; chosen by hand, not measured, except for CORE_SHARE. */
#define NEAR_RADIUS 1.2 /* scene units: radius of the volume that the cameras surround */
#define FAR_RADIUS 4.0  /* scene units: outer radius of the random points beyond it */
#define FAR_SHARE 0.2   /* of the random points lie beyond the near radius */
/* Of the points lie in the inner half of the near radius, where all cameras look; calibrated on demo. */
#define CORE_SHARE 0.5
#define PLACES_PER_POINT 400ull /* maximum number of random places per wanted point */
#define SEEN_BY 4               /* one in so many views must see a point */
#define FAR_SEEN_BY 10          /* the same beyond the near radius */

/* ---- Candidate points ---- */

/** True if the scene has points, other than those of its static splats, which matching gives with their sizes. */
static int has_points(const adcgs_scene *scene, const adcgs_train_config *config)
{
    return scene->points.n >= ADCGS_POINTS_LEAST && !(config->matching_frames && scene->splats && scene->splats->gives_points);
}

static adcgs_status alloc_points(adcgs_start_points *c, uint32_t capacity, adcgs_error *error)
{
    c->n = 0;
    c->x = adcgs_alloc(NULL, (size_t)capacity + 1, sizeof *c->x, error);
    c->rgb = adcgs_alloc(NULL, (size_t)capacity + 1, sizeof *c->rgb, error);
    c->matched = adcgs_alloc(NULL, (size_t)capacity + 1, sizeof *c->matched, error);
    return c->x && c->rgb && c->matched ? ADCGS_OK : adcgs_alloc_status(error);
}

void adcgs_start_points_clear(adcgs_start_points *c)
{
    adcgs_free(NULL, c->x);
    adcgs_free(NULL, c->rgb);
    adcgs_free(NULL, c->matched);
}

/** Converts one of the scene's points to scene units. Returns 0 if it is too far away. */
static int given_point(double x[3], const adcgs_visibility *s, uint32_t i)
{
    int far = 0;
    for (int a = 0; a < 3; a++) {
        x[a] = (s->scene->points.position[i][a] - s->origin[a]) / s->scale;
        far |= !(fabs(x[a]) < 8);
    }
    return !far;
}

/** True if a camera sees any of the scene's points; at most `most` points are tested. */
static int sees_points(const adcgs_visibility *s, uint32_t most)
{
    const uint32_t n = ADCGS_MIN(s->scene->points.n, most);
    double x[3];
    for (uint32_t i = 0; i < n; i++)
        if (given_point(x, s, (uint32_t)((uint64_t)i * s->scene->points.n / n)) && adcgs_visibility_of(s, x).seen)
            return 1;
    return 0;
}

/** Adds the scene's points in scene units, evenly thinned. Points without a colour get the colour of the images. */
static void given_points(adcgs_start_points *c, const adcgs_visibility *s, uint32_t wanted)
{
    const adcgs_scene_points *p = &s->scene->points;
    const uint32_t n = p->n < wanted ? p->n : wanted;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t from = (uint32_t)((uint64_t)i * p->n / n);
        double x[3];
        if (!given_point(x, s, from))
            continue;
        const adcgs_point_visibility seen = p->coloured ? (adcgs_point_visibility){0} : adcgs_visibility_of(s, x);
        for (int a = 0; a < 3; a++) {
            c->x[c->n][a] = x[a];
            c->rgb[c->n][a] = p->coloured ? p->colour[from][a] / 255.0 : seen.rgb[a];
        }
        c->n++;
    }
}

/** Uniform in a ball, or outside it with a density proportional to distance^-3, like the resolution of images. */
static void random_place(double x[3], uint64_t seed, uint64_t i)
{
    double length;
    do {
        length = 0;
        for (int a = 0; a < 3; a++) {
            x[a] = 2 * adcgs_random_unit(seed, 1000, i * 4 + (uint64_t)a) - 1;
            length += x[a] * x[a];
        }
        i ^= 0x5851f42d4c957f2du; /* rejected corners are sampled again */
        seed++;
    } while (length > 1 || length < 1e-6);
    const double u = adcgs_random_unit(seed, 1001, i), far = NEAR_RADIUS * pow(FAR_RADIUS / NEAR_RADIUS, u / FAR_SHARE);
    const double scale = u < FAR_SHARE ? far / sqrt(length) : u < FAR_SHARE + CORE_SHARE ? 0.5 * NEAR_RADIUS : NEAR_RADIUS;
    for (int a = 0; a < 3; a++)
        x[a] *= scale;
}

/**
 * Adds random points that enough cameras see and, with alpha, that are opaque in enough of them. Space known from matching stays
 * empty.
 */
static void random_points(adcgs_start_points *c, const adcgs_visibility *s, const adcgs_stereo *stereo, uint32_t wanted,
                          uint64_t seed)
{
    for (uint64_t i = 0; c->n < wanted && i < PLACES_PER_POINT * wanted; i++) {
        double x[3];
        random_place(x, seed, i);
        const int far = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] > NEAR_RADIUS * NEAR_RADIUS;
        const int need = (int)s->n / (far ? FAR_SEEN_BY : SEEN_BY) > 1 ? (int)s->n / (far ? FAR_SEEN_BY : SEEN_BY) : 1;
        const adcgs_point_visibility g = adcgs_visibility_of(s, x);
        if (g.seen < need || g.covered * 2 < g.seen || adcgs_stereo_is_known(stereo, x))
            continue;
        for (int a = 0; a < 3; a++) {
            c->x[c->n][a] = x[a];
            c->rgb[c->n][a] = g.rgb[a];
        }
        c->n++;
    }
}

/* ---- Matched points ---- */

static void add_matched(adcgs_start_points *c, const adcgs_stereo *found, const adcgs_stereo_point *p)
{
    adcgs_stereo_rest(found, p, c->x[c->n]);
    for (int a = 0; a < 3; a++) {
        if (!(fabs(c->x[c->n][a]) < 8))
            return;
        c->rgb[c->n][a] = (double)p->rgb[a];
    }
    c->matched[c->n] = p;
    c->n++;
}

/** The matched frame nearest to the middle of time. */
static float middle_frame_time(const adcgs_stereo *s)
{
    float best = s->n_frames ? s->frame_time[0] : 0.5f;
    for (uint32_t i = 1; i < s->n_frames; i++)
        if (fabsf(s->frame_time[i] - 0.5f) < fabsf(best - 0.5f))
            best = s->frame_time[i];
    return best;
}

/** Kinds of moving points, definition: part of a rigid body, independent, or on a static surface. */
enum { OF_BODY, BY_ITSELF, IN_PLACE };

static int kind_of(const adcgs_stereo_point *p)
{
    return p->body ? OF_BODY : p->in_place ? IN_PLACE : BY_ITSELF;
}

static uint32_t count_moving(const adcgs_stereo *found, int kind)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < found->n_moving; i++)
        n += kind_of(&found->moving[i]) == kind;
    return n;
}

/** Adds at most `most` moving points of a kind, evenly spread over all frames. */
static uint32_t add_moving(adcgs_start_points *c, const adcgs_stereo *found, int kind, uint32_t most)
{
    const uint32_t there = count_moving(found, kind);
    uint32_t n = 0;
    most = ADCGS_MIN(most, there);
    for (uint32_t i = 0, seen = 0; i < found->n_moving && n < most; i++) {
        if (kind_of(&found->moving[i]) != kind)
            continue;
        if ((uint64_t)seen++ * most / there >= n) {
            add_matched(c, found, &found->moving[i]);
            n++;
        }
    }
    return n;
}

/**
 * Divides the moving points among the kinds. All frames show the same bodies, so bodies get a smaller share. Independent motion
 * needs points in each frame. Points on static surfaces fill the rest.
 */
static void add_all_that_moves(adcgs_start_points *c, const adcgs_stereo *found, float half, uint32_t most)
{
    const double of_body = fmin(2 * (double)half, 1) * count_moving(found, OF_BODY), others = count_moving(found, BY_ITSELF);
    uint32_t left = most;
    if (of_body > 0)
        left -= add_moving(c, found, OF_BODY, (uint32_t)(most * of_body / (of_body + others)));
    left -= add_moving(c, found, BY_ITSELF, left);
    add_moving(c, found, IN_PLACE, left);
}

/**
 * Adds matched points. With lifetimes: moving points of all frames, and points on static surfaces if there are too few. Without:
 * moving points of the middle frame. The rest are static points.
 */
static void matched_points(adcgs_start_points *c, const adcgs_stereo *found, uint32_t most, int spans, float half)
{
    const uint32_t wanted = most > c->n ? (uint32_t)(MATCHED_SHARE * (most - c->n)) : 0, begin = c->n;
    const uint32_t moving = ADCGS_MIN((uint32_t)(MOVING_SHARE * most), found->n_moving);
    const float middle = middle_frame_time(found);
    if (spans)
        add_all_that_moves(c, found, half, moving);
    for (uint32_t i = 0; !spans && i < found->n_moving && c->n < most; i++)
        if (found->moving[i].t >= middle && found->moving[i].t <= middle && !found->moving[i].in_place)
            add_matched(c, found, &found->moving[i]);
    const uint32_t left = wanted - ADCGS_MIN(c->n - begin, wanted), n = ADCGS_MIN(left, found->n_still);
    for (uint32_t i = 0; i < n; i++)
        add_matched(c, found, &found->still[(uint64_t)i * found->n_still / n]);
}

/**
 * Uses the scene's points, with matched moving points; otherwise matched points, and random points where matching found nothing.
 */
static adcgs_status find_points(adcgs_start_points *c, const adcgs_visibility *s, const adcgs_train_config *config,
                                const adcgs_stereo *found, adcgs_error *error)
{
    const uint32_t all = config->start_anchors, moving = config->params.spans ? (uint32_t)(MOVING_SHARE * all) : 0;
    /* Points that no camera sees cannot be trained. A part of a scene may show a place without the scene's points. */
    const int given = has_points(s->scene, config) && sees_points(s, all);
    if (has_points(s->scene, config) && !given && !s->scene->whole && !sees_points(s, POINTS_LOOKED_AT))
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%s: no training camera sees any of the %u initial points: check their units and axes against poses",
                          s->scene->directory, s->scene->points.n);
    if (given || s->scene->points.n < ADCGS_POINTS_LEAST)
        given_points(c, s, given ? all - moving : all);
    if (c->n >= ADCGS_POINTS_LEAST && !moving)
        return ADCGS_OK;
    matched_points(c, found, all, config->params.spans, adcgs_half_lifetime(config, found));
    if (given || (s->scene->splats && c->n >= ADCGS_POINTS_LEAST)) /* splats show all that there is */
        return ADCGS_OK;
    random_points(c, s, found, config->start_anchors, config->seed);
    return c->n ? ADCGS_OK
                : adcgs_fail(error, ADCGS_ERR_DATA, "%s: no volume is seen by a quarter of the training cameras: check the poses",
                             s->scene->directory);
}

adcgs_status adcgs_start_points_find(adcgs_start_points *c, const adcgs_scene *scene, const adcgs_train_config *config,
                                     const adcgs_stereo *found, adcgs_error *error)
{
    adcgs_visibility s;
    *c = (adcgs_start_points){.n = 0};
    ADCGS_TRY(adcgs_visibility_init(&s, scene, error));
    adcgs_status status = alloc_points(c, config->start_anchors, error);
    if (status == ADCGS_OK)
        status = find_points(c, &s, config, found, error);
    adcgs_visibility_clear(&s);
    return status;
}

/* ---- Matching ---- */

float adcgs_half_lifetime(const adcgs_train_config *config, const adcgs_stereo *found)
{
    return (found->monocular ? MONOCULAR_LIFETIMES : 1) * config->lifetime_frames *
           fmaxf(adcgs_stereo_spacing(found), SPACING_LEAST);
}

/** Sets initial lifetimes: symmetric, except at known ends. Known ends do not apply to points of bodies. */
static void set_lives(adcgs_stereo *found, const adcgs_train_config *config)
{
    const float half = adcgs_half_lifetime(config, found);
    for (uint32_t i = 0; i < found->n_moving; i++) {
        adcgs_stereo_point *p = &found->moving[i];
        const int ends = config->lifetime_trim && !p->body;
        const float before = ends && p->end[0] > 0 ? fminf(p->end[0], half) : half;
        const float behind = ends && p->end[1] > 0 ? fminf(p->end[1], half) : half;
        p->life = 0.5f * (before + behind);
        p->shift = 0.5f * (behind - before);
    }
}

/** Motion is known where the scene is one of splats over time. */
static adcgs_status applies(const adcgs_scene *scene, int *out, adcgs_error *error)
{
    *out = adcgs_splat_motion_applies(scene);
    return *out ? ADCGS_OK : adcgs_stereo_applies(scene, out, error);
}

adcgs_status adcgs_start_match(adcgs_stereo *found, unsigned how, const adcgs_scene *scene, adcgs_train_config *config,
                               adcgs_pool *pool, adcgs_error *error)
{
    int matched = 0, whole = 0, moves;
    const int given = has_points(scene, config);
    adcgs_stereo_options options = {.still = 0};
    if (config->matching_frames && (!given || config->params.spans)) {
        ADCGS_TRY(applies(scene, &matched, error));
        ADCGS_TRY(applies(scene->whole ? scene->whole : scene, &whole, error));
    }
    if (matched || given)
        adcgs_resolve_start(config, scene->splats != NULL);
    if (matched && !(how & ADCGS_START_KNOWN)) {
        options.still = (uint32_t)(MATCHED_SHARE * config->start_anchors);
        options.frames = config->matching_frames;
        options.judges = (how & ADCGS_START_JUDGES) != 0;
        options.bodies = config->params.spans ? config->params.bodies : 0;
        options.moving = config->params.spans ? MOVING_MOST : (uint32_t)(MOVING_SHARE * options.still);
        ADCGS_TRY(adcgs_scene_frame(scene, options.origin, &options.scale, error));
        ADCGS_TRY(adcgs_splat_motion_applies(scene) ? adcgs_splat_motion_find(found, scene, &options, error)
                                                    : adcgs_stereo_find(found, scene, &options, pool, error));
    }
    set_lives(found, config);
    ADCGS_TRY(adcgs_stereo_check_motion(&moves, found, error));
    /* All segments of a stream have the same parameters, so a part's parameters cannot depend on its own content. */
    const int may_move = !config->matching_frames || (scene->whole ? whole : moves);
    const int is_final = !scene->whole || !whole || !may_move || !config->params.spans;
    adcgs_resolve_matching(config, may_move, is_final ? (int)found->n_bodies : -1);
    return ADCGS_OK;
}
