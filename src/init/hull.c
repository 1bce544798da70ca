/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Silhouettes, cubes, and visibility. */
#include "init/hull.h"

#include <math.h>

/*
 * Origin, unless a line states one: chosen by hand, not measured. Hulls as a whole are measured on pose2sim_4cam
 * (doc/log/matching.md).
 */
enum {
    VIEWS_LEAST = 3,     /* minimum number of views that contain a cube; two views constrain it too little */
    DEEPEST = 12,        /* maximum number of halvings of the first cube */
    POINTS_MOST = 400000 /* maximum number of surface points; a hull that nearly fills the first cube gives no information */
};
#define REACH 2.0   /* scene units: half an edge of the first cube */
#define CLOSED 2.0f /* pixels: radius of the closing of silhouettes */
#define WELL_IN 3.0 /* pixels from the silhouette's edge beyond which no background shines through */
/* Radius of a cube in an image / half its size: no gaps between cubes; chosen by hand, not measured. */
#define FOOTPRINT 1.25
#define SQRT_2 1.41421356f /* geometry: a diagonal step */
#define SQRT_3 1.7320508   /* geometry: radius of the sphere around a cube / half its edge */

/** Silhouettes of n views as distances to their edges, in pixels, and depth maps of the visible surface. */
typedef struct hull {
    int n;
    const adcgs_stereo_view *views;
    float *inside[ADCGS_STEREO_CAMERAS];  /**< [h][w] greater than 0 inside the silhouette */
    float *nearest[ADCGS_STEREO_CAMERAS]; /**< [h][w] depth */
    adcgs_stereo_list surface;
} hull;

/** Classification of a cube by the views. */
typedef enum content { EMPTY, FULL, MIXED } content;

/* ---- Silhouettes ---- */

/** Lowers one distance to the values that its neighbours imply. */
static void relax(float *d, int w, int x, int y, int h, int step)
{
    static const int across[4] = {-1, 0, 1, -1}, down[4] = {-1, -1, -1, 0};
    static const float way[4] = {SQRT_2, 1, SQRT_2, 1};
    for (int k = 0; k < 4; k++) {
        const int a = x + step * across[k], b = y + step * down[k];
        if (a >= 0 && b >= 0 && a < w && b < h)
            d[y * w + x] = fminf(d[y * w + x], d[b * w + a] + way[k]);
    }
}

/** Distances to the nearest 0 (Borgefors 1986, Distance transformations in digital images, CVGIP 34). */
static void spread(float *d, int w, int h)
{
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            relax(d, w, x, y, h, 1);
    for (int y = h - 1; y >= 0; y--)
        for (int x = w - 1; x >= 0; x--)
            relax(d, w, x, y, h, -1);
}

/** Signed distances to the silhouette's edge, positive inside, after closing of holes and gaps. scratch: [h][w] */
static void measure(float *inside, float *scratch, const uint8_t *moves, int w, int h)
{
    const int n = w * h;
    for (int i = 0; i < n; i++)
        scratch[i] = moves[i] ? 0 : (float)n;
    spread(scratch, w, h);
    for (int i = 0; i < n; i++)
        inside[i] = scratch[i] <= CLOSED ? (float)n : 0;
    spread(inside, w, h);
    for (int i = 0; i < n; i++)
        scratch[i] = inside[i] > CLOSED ? 0 : (float)n;
    spread(scratch, w, h);
    for (int i = 0; i < n; i++)
        inside[i] = inside[i] > CLOSED ? inside[i] - CLOSED : -scratch[i];
}

static void hull_clear(hull *o)
{
    for (int i = 0; i < o->n; i++) {
        adcgs_free(NULL, o->inside[i]);
        adcgs_free(NULL, o->nearest[i]);
    }
    adcgs_stereo_list_clear(&o->surface);
}

static adcgs_status hull_init(hull *o, const adcgs_stereo_view *views, const uint8_t *const *moves, int n, adcgs_error *error)
{
    *o = (hull){.n = n, .views = views};
    for (int i = 0; i < n; i++) {
        const size_t plane = (size_t)views[i].w * (size_t)views[i].h;
        o->inside[i] = adcgs_alloc(NULL, plane, sizeof(float), error);
        o->nearest[i] = adcgs_alloc(NULL, plane, sizeof(float), error);
        if (!o->inside[i] || !o->nearest[i])
            return adcgs_alloc_status(error);
        measure(o->inside[i], o->nearest[i], moves[i], views[i].w, views[i].h);
        for (size_t k = 0; k < plane; k++)
            o->nearest[i][k] = INFINITY;
    }
    return ADCGS_OK;
}

/* ---- Cubes ---- */

/**
 * Classifies a cube of half edge `half`. *pixel: edge of a cube that covers one pixel in the nearest view; 0 if no image contains
 * it.
 */
static content ask(const hull *o, const double x[3], double half, double *pixel)
{
    int seen = 0, mixed = 0;
    *pixel = 0;
    for (int i = 0; i < o->n; i++) {
        const adcgs_stereo_view *v = &o->views[i];
        double at[2] = {0, 0}, depth;
        const int in_picture = adcgs_stereo_rig_project(v, x, at, &depth);
        const double around = SQRT_3 * half; /* radius of the circumscribed sphere */
        if (depth <= 2 * around) {           /* the sphere encloses the camera or lies behind it */
            mixed += depth > -around;
            seen += depth > -around;
            continue;
        }
        const double radius = around * v->fx / (depth - around);
        if (!in_picture) {
            const int near = at[0] > -radius && at[1] > -radius && at[0] < v->w + radius && at[1] < v->h + radius;
            seen += near;
            mixed += near;
            continue;
        }
        const double d = (double)o->inside[i][(int)at[1] * v->w + (int)at[0]];
        seen++;
        if (d <= -radius)
            return EMPTY;
        mixed += d < radius;
        *pixel = *pixel > 0 ? fmin(*pixel, depth / v->fx) : depth / v->fx;
    }
    return seen < ADCGS_MIN(VIEWS_LEAST, o->n) ? EMPTY : mixed ? MIXED : FULL;
}

/** True if the point lies inside the silhouette of every image that contains it, and enough images do. */
static int is_within(const hull *o, const double x[3])
{
    int seen = 0;
    for (int i = 0; i < o->n; i++) {
        double at[2], depth;
        if (!adcgs_stereo_rig_project(&o->views[i], x, at, &depth))
            continue;
        if (o->inside[i][(int)at[1] * o->views[i].w + (int)at[0]] < 0)
            return 0;
        seen++;
    }
    return seen >= ADCGS_MIN(VIEWS_LEAST, o->n);
}

/** Halves a cube until its parts are surface pixels. */
static adcgs_status halve(hull *o, const double x[3], double half, int depth, adcgs_error *error)
{
    double pixel;
    if (ask(o, x, half, &pixel) != MIXED || o->surface.n > POINTS_MOST)
        return ADCGS_OK;
    if (2 * half <= pixel || depth == DEEPEST) {
        const adcgs_stereo_point p = {.x = {x[0], x[1], x[2]}, .size = (float)(2 * half)};
        return is_within(o, x) ? adcgs_stereo_list_add(&o->surface, &p, error) : ADCGS_OK;
    }
    for (int k = 0; k < 8; k++) {
        const double part[3] = {x[0] + (k & 1 ? half : -half) / 2, x[1] + (k & 2 ? half : -half) / 2,
                                x[2] + (k & 4 ? half : -half) / 2};
        ADCGS_TRY(halve(o, part, half / 2, depth + 1, error));
    }
    return ADCGS_OK;
}

/* ---- Visibility ---- */

/** Lowers the depth map of a view under a surface cube. The footprint is enlarged, so that there are no gaps. */
static void hide(const adcgs_stereo_view *v, float *nearest, const adcgs_stereo_point *p)
{
    double at[2], depth;
    if (!adcgs_stereo_rig_project(v, p->x, at, &depth))
        return;
    const double radius = FOOTPRINT * (double)p->size * v->fx / depth;
    const int left = ADCGS_MAX((int)(at[0] - radius), 0), right = ADCGS_MIN((int)(at[0] + radius), v->w - 1);
    const int top = ADCGS_MAX((int)(at[1] - radius), 0), bottom = ADCGS_MIN((int)(at[1] + radius), v->h - 1);
    for (int b = top; b <= bottom; b++)
        for (int a = left; a <= right; a++)
            nearest[b * v->w + a] = fminf(nearest[b * v->w + a], (float)depth);
}

/** Sets the appearance of a point from the view in which it is farthest from the silhouette's edge; 0 if no view sees it. */
static int dress(const hull *o, adcgs_stereo_point *p)
{
    const double thick = 3 * (double)p->size;
    double best = 0;
    for (int i = 0; i < o->n; i++) {
        const adcgs_stereo_view *v = &o->views[i];
        double at[2], depth;
        if (!adcgs_stereo_rig_project(v, p->x, at, &depth))
            continue;
        const int px = (int)at[0], py = (int)at[1];
        const float *pixel = v->pixels + 4 * ((size_t)py * (size_t)v->w + (size_t)px);
        if (depth > (double)o->nearest[i][py * v->w + px] + thick || pixel[3] == 0)
            continue;
        const double good = fmin((double)o->inside[i][py * v->w + px], WELL_IN) / depth;
        if (good <= best)
            continue;
        best = good;
        memcpy(p->rgb, pixel, sizeof p->rgb);
        p->size = (float)(depth / v->fx);
        p->detail = adcgs_stereo_detail(v, px, py);
    }
    return best > 0;
}

static adcgs_status take_seen(adcgs_stereo_list *list, const hull *o, const adcgs_stereo_point *like, adcgs_error *error)
{
    for (size_t k = 0; k < o->surface.n; k++)
        for (int i = 0; i < o->n; i++)
            hide(&o->views[i], o->nearest[i], &o->surface.point[k]);
    for (size_t k = 0; k < o->surface.n; k++) {
        adcgs_stereo_point p = *like;
        memcpy(p.x, o->surface.point[k].x, sizeof p.x);
        p.size = o->surface.point[k].size;
        if (dress(o, &p))
            ADCGS_TRY(adcgs_stereo_list_add(list, &p, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_hull_find(adcgs_stereo_list *list, const adcgs_stereo_view *views, const uint8_t *const *moves, int n,
                             const adcgs_stereo_point *like, adcgs_error *error)
{
    static const double middle[3];
    hull o;
    adcgs_status status = hull_init(&o, views, moves, n, error);
    if (status == ADCGS_OK && n > 1)
        status = halve(&o, middle, REACH, 0, error);
    if (status == ADCGS_OK && o.surface.n <= POINTS_MOST)
        status = take_seen(list, &o, like, error);
    hull_clear(&o);
    return status;
}
