/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene's frame of reference and the first anchors. */
#include "train/initialise.h"

#include "data/extent.h"
#include "data/sort.h"
#include "geom/geom.h"
#include "grad/random.h"

#include <math.h>
#include <stdlib.h>

/* ---- Frame ---- */

/** Solve the symmetric 3x3 system a x = b by Cramer's rule; 0 if it is singular. */
static int solve3(const double a[9], const double b[3], double x[3])
{
    const double c0 = a[4] * a[8] - a[5] * a[7], c1 = a[5] * a[6] - a[3] * a[8], c2 = a[3] * a[7] - a[4] * a[6];
    const double det = a[0] * c0 + a[1] * c1 + a[2] * c2;
    if (fabs(det) < 1e-9)
        return 0;
    x[0] = (b[0] * c0 + b[1] * (a[2] * a[7] - a[1] * a[8]) + b[2] * (a[1] * a[5] - a[2] * a[4])) / det;
    x[1] = (b[0] * c1 + b[1] * (a[0] * a[8] - a[2] * a[6]) + b[2] * (a[2] * a[3] - a[0] * a[5])) / det;
    x[2] = (b[0] * c2 + b[1] * (a[1] * a[6] - a[0] * a[7]) + b[2] * (a[0] * a[4] - a[1] * a[3])) / det;
    return 1;
}

/** The point nearest to all optical axes in the least-squares sense, pulled slightly towards the points the cameras face. */
static void focus_point(const adcgs_scene *scene, double extent, double focus[3])
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    double a[9] = { 0 }, b[3] = { 0 };
    for (uint32_t v = 0; v < n; v++) {
        const double *m = scene->views[ADCGS_SPLIT_TRAIN][v].camera.cam_to_world;
        const double d[3] = { m[2], m[6], m[10] }, c[3] = { m[3], m[7], m[11] };
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                const double p = (i == j) - d[i] * d[j];
                a[i * 3 + j] += p / n;
                b[i] += p * c[j] / n;
            }
    }
    if (!solve3(a, b, focus)) /* parallel axes: in front of the first camera */
        for (int i = 0; i < 3; i++) {
            const double *m = scene->views[ADCGS_SPLIT_TRAIN][0].camera.cam_to_world;
            focus[i] = m[4 * i + 3] + extent * m[4 * i + 2];
        }
}

adcgs_status adcgs_scene_frame(const adcgs_scene *scene, double origin[3], double *scale, adcgs_error *error)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    double extent;
    ADCGS_TRY(adcgs_scene_extent(scene, &extent, error));
    focus_point(scene, extent, origin);
    double *distance = adcgs_alloc(NULL, n, sizeof *distance, error);
    if (!distance)
        return adcgs_alloc_status(error);
    for (uint32_t v = 0; v < n; v++) {
        const double *m = scene->views[ADCGS_SPLIT_TRAIN][v].camera.cam_to_world;
        const double d[3] = { m[3] - origin[0], m[7] - origin[1], m[11] - origin[2] };
        distance[v] = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    }
    adcgs_sort(distance, n);
    *scale = distance[n / 2] > ADCGS_EXTENT_NOTHING * extent ? distance[n / 2] : extent; /* all may stand in one place */
    adcgs_free(NULL, distance);
    return ADCGS_OK;
}

/* ---- What the cameras see ---- */

/** Views that are looked at, at most. */
enum { SIGHTS = 64 };

typedef struct sight {
    const adcgs_scene *scene;
    double origin[3], scale;
    uint32_t n;             /* views sampled */
    float *rgb[SIGHTS];        /* their pictures, reduced */
    adcgs_camera camera[SIGHTS];
} sight;

static void sight_clear(sight *s)
{
    for (uint32_t i = 0; i < s->n; i++)
        free(s->rgb[i]);
}

static adcgs_status sight_init(sight *s, const adcgs_scene *scene, adcgs_error *error)
{
    const uint32_t all = scene->n_views[ADCGS_SPLIT_TRAIN], n = ADCGS_MIN(all, SIGHTS);
    memset(s, 0, sizeof *s);
    s->scene = scene;
    ADCGS_TRY(adcgs_scene_frame(scene, s->origin, &s->scale, error));
    for (uint32_t i = 0; i < n; i++) {
        const adcgs_scene_view *view = &scene->views[ADCGS_SPLIT_TRAIN][(uint64_t)i * all / n];
        const adcgs_status status = adcgs_scene_load(scene, view, 4, &s->rgb[i], &s->camera[i], error);
        if (status != ADCGS_OK) {
            sight_clear(s);
            return status;
        }
        s->n = i + 1;
    }
    return ADCGS_OK;
}

typedef struct glimpse {
    int seen;      /* views whose frame holds the point */
    int covered;   /* of those, views whose pixel is not background */
    double rgb[3]; /* mean colour over the covered views */
} glimpse;

static glimpse look_at(const sight *s, const double x[3])
{
    glimpse g = { 0, 0, { 0, 0, 0 } };
    double world[3];
    for (int a = 0; a < 3; a++)
        world[a] = s->origin[a] + s->scale * x[a];
    for (uint32_t i = 0; i < s->n; i++) {
        const adcgs_camera *c = &s->camera[i];
        double p[3];
        for (int a = 0; a < 3; a++) {
            p[a] = 0;
            for (int b = 0; b < 3; b++)
                p[a] += c->cam_to_world[4 * b + a] * (world[b] - c->cam_to_world[4 * b + 3]);
        }
        if (p[2] <= c->near_plane)
            continue;
        const double u = c->fx * p[0] / p[2] + c->cx, v = c->fy * p[1] / p[2] + c->cy;
        if (u < 0 || v < 0 || u >= c->width || v >= c->height)
            continue;
        const size_t plane = (size_t)c->width * (size_t)c->height, at = (size_t)v * (size_t)c->width + (size_t)u;
        if (isnan(s->rgb[i][at])) /* masked */
            continue;
        double off = 0;
        for (int a = 0; a < 3; a++)
            off += fabs(s->rgb[i][(size_t)a * plane + at] - s->scene->background[a]);
        g.seen++;
        if (s->scene->has_alpha && off < 0.02)
            continue;
        g.covered++;
        for (int a = 0; a < 3; a++)
            g.rgb[a] += s->rgb[i][(size_t)a * plane + at];
    }
    for (int a = 0; a < 3; a++)
        g.rgb[a] = g.covered ? g.rgb[a] / g.covered : 0.5;
    return g;
}

/* ---- Candidate points ---- */

typedef struct cloud {
    uint32_t n;
    double (*x)[3];
    double (*rgb)[3];
} cloud;

static adcgs_status cloud_alloc(cloud *c, uint32_t capacity, adcgs_error *error)
{
    c->n = 0;
    c->x = adcgs_alloc(NULL, (size_t)capacity + 1, sizeof *c->x, error);
    c->rgb = adcgs_alloc(NULL, (size_t)capacity + 1, sizeof *c->rgb, error);
    return c->x && c->rgb ? ADCGS_OK : adcgs_alloc_status(error);
}

static void cloud_clear(cloud *c)
{
    adcgs_free(NULL, c->x);
    adcgs_free(NULL, c->rgb);
}

/** The scene's own points, in scene units, evenly thinned; those without a colour take that of the pictures. */
static void given_points(cloud *c, const sight *s, uint32_t wanted)
{
    const adcgs_scene_points *p = &s->scene->points;
    const uint32_t n = p->n < wanted ? p->n : wanted;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t from = (uint32_t)((uint64_t)i * p->n / n);
        double x[3];
        int far = 0;
        for (int a = 0; a < 3; a++) {
            x[a] = (p->position[from][a] - s->origin[a]) / s->scale;
            far |= !(fabs(x[a]) < 8);
        }
        if (far)
            continue;
        const glimpse seen = p->coloured ? (glimpse){ 0 } : look_at(s, x);
        for (int a = 0; a < 3; a++) {
            c->x[c->n][a] = x[a];
            c->rgb[c->n][a] = p->coloured ? p->colour[from][a] / 255.0 : seen.rgb[a];
        }
        c->n++;
    }
}

/** Reach of the random points: the volume the cameras surround, and as a share of the points what lies behind it. */
#define NEAR_RADIUS 1.2
#define FAR_RADIUS 4.0
#define FAR_SHARE 0.2
#define CORE_SHARE 0.5 /* of the points lie in the inner half of the near radius, where all cameras look */

/** Uniform in a ball, or beyond it with density falling as the cube of the distance, as pictures resolve it. */
static void random_place(double x[3], uint64_t seed, uint64_t i)
{
    double length;
    do {
        length = 0;
        for (int a = 0; a < 3; a++) {
            x[a] = 2 * adcgs_random_unit(seed, 1000, i * 4 + (uint64_t)a) - 1;
            length += x[a] * x[a];
        }
        i ^= 0x5851f42d4c957f2du; /* rejected corners draw again */
        seed++;
    } while (length > 1 || length < 1e-6);
    const double u = adcgs_random_unit(seed, 1001, i), far = NEAR_RADIUS * pow(FAR_RADIUS / NEAR_RADIUS, u / FAR_SHARE);
    const double scale = u < FAR_SHARE ? far / sqrt(length) : u < FAR_SHARE + CORE_SHARE ? 0.5 * NEAR_RADIUS : NEAR_RADIUS;
    for (int a = 0; a < 3; a++)
        x[a] *= scale;
}

/** Random points that enough cameras see, and where alpha says so, that enough of them do not see through. */
static void random_points(cloud *c, const sight *s, uint32_t wanted, uint64_t seed)
{
    for (uint64_t i = 0; c->n < wanted && i < 400ull * wanted; i++) {
        double x[3];
        random_place(x, seed, i);
        const int far = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] > NEAR_RADIUS * NEAR_RADIUS;
        const int need = (int)s->n / (far ? 10 : 4) > 1 ? (int)s->n / (far ? 10 : 4) : 1;
        const glimpse g = look_at(s, x);
        if (g.seen < need || g.covered * 2 < g.seen)
            continue;
        for (int a = 0; a < 3; a++) {
            c->x[c->n][a] = x[a];
            c->rgb[c->n][a] = g.rgb[a];
        }
        c->n++;
    }
}

/* ---- Anchors from points ---- */

/** A cube around the points, at least the unit ball's half, at most +-8. */
static double cube_half(const cloud *c)
{
    double half = 0.5;
    for (uint32_t i = 0; i < c->n; i++)
        for (int a = 0; a < 3; a++)
            half = fmax(half, 1.25 * fabs(c->x[i][a]));
    return fmin(half, 8);
}

/** Mean distance to the three nearest other anchors. */
static double spacing(const adcgs_fmodel *f, uint32_t i)
{
    double best[3] = { 1e9, 1e9, 1e9 };
    for (uint32_t j = 0; j < f->n; j++) {
        double d = 0;
        for (int a = 0; a < 3; a++)
            d += pow((double)f->pos[i][a] - (double)f->pos[j][a], 2);
        if (j == i || d >= best[2])
            continue;
        best[2] = d;
        for (int a = 2; a > 0 && best[a] < best[a - 1]; a--) {
            const double swap = best[a];
            best[a] = best[a - 1];
            best[a - 1] = swap;
        }
    }
    const int known = f->n > 3 ? 3 : (int)f->n - 1;
    double sum = 0;
    for (int a = 0; a < known; a++)
        sum += sqrt(best[a]);
    return known ? sum / known * f->voxel : 0.1;
}

static void set_anchor(adcgs_fmodel *f, uint32_t i, const double rgb[3])
{
    const double d = fmin(fmax(spacing(f, i), 2 * f->voxel), 1.0);
    for (int a = 0; a < 3; a++) {
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, a) = (float)log(d);
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, 3 + a) = (float)log(d);
        *adcgs_fmodel_at(f, ADCGS_P_COLOUR, i, a) = (float)rgb[a];
    }
}

/** One anchor per occupied voxel, Morton order; order[i] is the point anchor i came from, of *anchors. */
static adcgs_status voxelise(const cloud *c, double half, int depth, uint32_t (*pos)[3], uint32_t *order, uint32_t *anchors,
                             adcgs_error *error)
{
    const double voxel = 2 * half / (double)(1u << depth);
    for (uint32_t i = 0; i < c->n; i++)
        for (int a = 0; a < 3; a++) {
            const double v = floor((c->x[i][a] + half) / voxel);
            pos[i][a] = (uint32_t)fmin(fmax(v, 0), (double)(1u << depth) - 1);
        }
    const int sorted = adcgs_morton_sort(&pos[0][0], c->n, order, error);
    if (sorted < 0)
        return (adcgs_status)sorted;
    uint32_t n = 0;
    for (uint32_t i = 0; i < c->n; i++) {
        if (n && !memcmp(pos[n - 1], pos[i], sizeof pos[i]))
            continue;
        memmove(pos[n], pos[i], sizeof pos[i]);
        order[n++] = order[i];
    }
    *anchors = n;
    return ADCGS_OK;
}

static adcgs_status make_anchors(adcgs_fmodel **out, const cloud *c, const adcgs_train_config *config, adcgs_error *error)
{
    const double half = cube_half(c);
    const float origin[3] = { (float)-half, (float)-half, (float)-half };
    const float voxel = (float)(2 * half / (double)(1u << config->shape.depth));
    uint32_t(*pos)[3] = adcgs_alloc(NULL, c->n, sizeof *pos, error);
    uint32_t *order = adcgs_alloc(NULL, c->n, sizeof *order, error);
    uint32_t n = 0;
    adcgs_status status =
        pos && order ? voxelise(c, half, config->shape.depth, pos, order, &n, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        status = adcgs_fmodel_create(out, &config->params, &config->shape, origin, voxel, (const uint32_t(*)[3])pos, n,
                                     config->seed, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++)
        set_anchor(*out, i, c->rgb[order[i]]);
    adcgs_free(NULL, pos);
    adcgs_free(NULL, order);
    return status;
}

adcgs_status adcgs_initialise(adcgs_fmodel **out, const adcgs_scene *scene, const adcgs_train_config *config,
                               adcgs_error *error)
{
    sight s;
    cloud c = { 0, NULL, NULL };
    ADCGS_TRY(sight_init(&s, scene, error));
    adcgs_status status = cloud_alloc(&c, config->start_anchors, error);
    if (status == ADCGS_OK) {
        given_points(&c, &s, config->start_anchors);
        if (c.n < ADCGS_POINTS_LEAST)
            random_points(&c, &s, config->start_anchors, config->seed);
        if (!c.n)
            status = adcgs_fail(error, ADCGS_ERR_DATA,
                                "%s: no volume that at least a quarter of the training cameras see: check the poses",
                                scene->directory);
    }
    if (status == ADCGS_OK)
        status = make_anchors(out, &c, config, error);
    cloud_clear(&c);
    sight_clear(&s);
    return status;
}
