/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Silhouettes, cubes, and who sees what. */
#include "stereo/hull.h"

#include <math.h>

enum {
    VIEWS_LEAST = 3,     /* that have a place in their picture: two say too little */
    DEEPEST = 12,        /* halvings of the first cube */
    POINTS_MOST = 400000 /* of a surface: what is left of a first cube that is nearly full says nothing */
};
#define REACH 2.0   /* scene units: half an edge of the first cube */
#define CLOSED 2.0f /* pixels: holes and gaps of silhouettes that are closed */
#define WELL_IN 3.0 /* pixels from the edge of a silhouette where nothing of what is behind shines in */

/** Silhouettes of n views as distances to their edges, in pixels, and the depths of what each sees first. */
typedef struct hull {
    int n;
    const adcgs_stereo_view *views;
    float *inside[ADCGS_STEREO_CAMERAS];  /**< [h][w] greater than 0 within the silhouette */
    float *nearest[ADCGS_STEREO_CAMERAS]; /**< [h][w] depth */
    adcgs_stereo_list surface;
} hull;

/** What the views say of a cube. */
typedef enum content { EMPTY, FULL, MIXED } content;

/* ---- Silhouettes ---- */

/** Lower one distance to what the neighbours' say. */
static void relax(float *d, int w, int x, int y, int h, int step)
{
    static const int across[4] = { -1, 0, 1, -1 }, down[4] = { -1, -1, -1, 0 };
    static const float way[4] = { 1.41421356f, 1, 1.41421356f, 1 };
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

/** Distances in a silhouette, negative without, its holes and gaps closed. scratch: [h][w] */
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
    *o = (hull){ .n = n, .views = views };
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
 * Of a cube, half of whose edge is given. *pixel: edge of one that would be a pixel in who sees it nearest, 0 if none has it in
 * its picture.
 */
static content ask(const hull *o, const double x[3], double half, double *pixel)
{
    int seen = 0, mixed = 0;
    *pixel = 0;
    for (int i = 0; i < o->n; i++) {
        const adcgs_stereo_view *v = &o->views[i];
        double at[2] = { 0, 0 }, depth;
        const int in_picture = adcgs_stereo_rig_project(v, x, at, &depth);
        const double around = 1.7320508 * half; /* of the ball about the cube */
        if (depth <= 2 * around) { /* about the camera, or behind it */
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

/** Whether all that have a place in their picture have it within their silhouette, and enough do. */
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

/** Halve a cube until what is left is a pixel of the surface. */
static adcgs_status halve(hull *o, const double x[3], double half, int depth, adcgs_error *error)
{
    double pixel;
    if (ask(o, x, half, &pixel) != MIXED || o->surface.n > POINTS_MOST)
        return ADCGS_OK;
    if (2 * half <= pixel || depth == DEEPEST) {
        const adcgs_stereo_point p = { .x = { x[0], x[1], x[2] }, .size = (float)(2 * half) };
        return is_within(o, x) ? adcgs_stereo_list_add(&o->surface, &p, error) : ADCGS_OK;
    }
    for (int k = 0; k < 8; k++) {
        const double part[3] = { x[0] + (k & 1 ? half : -half) / 2, x[1] + (k & 2 ? half : -half) / 2,
                                 x[2] + (k & 4 ? half : -half) / 2 };
        ADCGS_TRY(halve(o, part, half / 2, depth + 1, error));
    }
    return ADCGS_OK;
}

/* ---- Who sees what ---- */

/** A cube of the surface hides what is behind it in a view: in the pixels about it, so that no gap lets through. */
static void hide(const adcgs_stereo_view *v, float *nearest, const adcgs_stereo_point *p)
{
    double at[2], depth;
    if (!adcgs_stereo_rig_project(v, p->x, at, &depth))
        return;
    const double radius = 1.25 * (double)p->size * v->fx / depth;
    const int left = ADCGS_MAX((int)(at[0] - radius), 0), right = ADCGS_MIN((int)(at[0] + radius), v->w - 1);
    const int top = ADCGS_MAX((int)(at[1] - radius), 0), bottom = ADCGS_MIN((int)(at[1] + radius), v->h - 1);
    for (int b = top; b <= bottom; b++)
        for (int a = left; a <= right; a++)
            nearest[b * v->w + a] = fminf(nearest[b * v->w + a], (float)depth);
}

/** The look of a point in the view that sees it farthest from a silhouette's edge; 0 if none sees it. */
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
