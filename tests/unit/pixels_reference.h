/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A slow renderer in binary64, pixel by pixel over all splats, written from the formulas without any line of the product. The
 * fast renderer must agree with it.
 */
#ifndef TESTS_PIXELS_REFERENCE_H
#define TESTS_PIXELS_REFERENCE_H

#include "unit/pixels_scene.h"

/** A scene in binary64 with the layout of scene_splats. */
typedef struct reference_scene {
    uint32_t n;
    double *data;
} reference_scene;

static inline reference_scene reference_from(const scene_splats *s)
{
    reference_scene r = {s->n, malloc((size_t)s->n * SCENE_ARRAYS * sizeof(double))};
    for (size_t i = 0; i < (size_t)s->n * SCENE_ARRAYS; i++)
        r.data[i] = s->data[i];
    return r;
}

static inline double reference_value(const reference_scene *s, int array, uint32_t i)
{
    return s->data[(size_t)array * s->n + i];
}

typedef struct reference_splat {
    double z, u, v, conic[3], opacity, rgb[3];
    uint32_t slot;
} reference_splat;

static inline void reference_rotation(double out[3][3], const double q[4])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    memcpy(out, m, sizeof m);
}

static inline double reference_limit(double x, double lo, double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* Returns 0 if the splat is not rendered. */
static inline int reference_project(reference_splat *o, const reference_scene *s, const adcgs_view *view, double filter,
                                    uint32_t i)
{
    double p[3], q[4], rot[3][3], world[3][3] = {{0}}, cam[2][3], cov[2][2] = {{filter, 0}, {0, filter}};
    for (int a = 0; a < 3; a++)
        p[a] = view->translation[a];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            p[a] += (double)view->rotation[3 * a + b] * reference_value(s, SCENE_MEAN + b, i);
    o->opacity = reference_value(s, SCENE_OPACITY, i);
    o->z = p[2];
    o->slot = i;
    if (!(p[2] > view->near_plane) || o->opacity < 1.0 / 255)
        return 0;
    for (int a = 0; a < 4; a++)
        q[a] = reference_value(s, SCENE_ROTATION + a, i);
    reference_rotation(rot, q);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int c = 0; c < 3; c++)
                world[a][b] += rot[a][c] * rot[b][c] * pow(reference_value(s, SCENE_SCALE + c, i), 2);
    o->u = view->fx * p[0] / p[2] + view->cx;
    o->v = view->fy * p[1] / p[2] + view->cy;
    const double lx = reference_limit(p[0] / p[2], view->limit[0], view->limit[1]);
    const double ly = reference_limit(p[1] / p[2], view->limit[2], view->limit[3]);
    for (int b = 0; b < 3; b++) {
        cam[0][b] = view->fx / p[2] * (view->rotation[b] - lx * view->rotation[6 + b]);
        cam[1][b] = view->fy / p[2] * (view->rotation[3 + b] - ly * view->rotation[6 + b]);
    }
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            for (int c = 0; c < 3; c++)
                for (int d = 0; d < 3; d++)
                    cov[a][b] += cam[a][c] * world[c][d] * cam[b][d];
    const double shear = (1 - ldexp(1, -18)) * cov[0][1], det = cov[0][0] * cov[1][1] - shear * shear;
    o->conic[0] = cov[1][1] / det;
    o->conic[1] = -shear / det;
    o->conic[2] = cov[0][0] / det;
    for (int c = 0; c < 3; c++)
        o->rgb[c] = reference_value(s, SCENE_COLOUR + c, i);
    return 1;
}

static int reference_compare(const void *a, const void *b)
{
    const reference_splat *x = a, *y = b;
    return x->z != y->z ? (x->z < y->z ? -1 : 1) : x->slot < y->slot ? -1 : x->slot > y->slot;
}

/* alpha of a splat at a pixel; 0 where it is not rendered. */
static inline double reference_alpha(const reference_splat *g, int x, int y)
{
    const double dx = x + 0.5 - g->u, dy = y + 0.5 - g->v;
    const double alpha = g->opacity * exp(-0.5 * (g->conic[0] * dx * dx + g->conic[2] * dy * dy) - g->conic[1] * dx * dy);
    return alpha < 1.0 / 255 ? 0.0 : alpha;
}

static inline void reference_block(const reference_splat *splats, uint32_t n, const adcgs_view *view, const float background[3],
                                   int bx, int by, double *rgb)
{
    double t[16], colour[16][3] = {{0}};
    for (int i = 0; i < 16; i++)
        t[i] = bx + (i & 3) < view->width && by + (i >> 2) < view->height;
    for (uint32_t s = 0; s < n; s++) {
        double most = 0.0;
        for (int i = 0; i < 16; i++)
            most = t[i] > most ? t[i] : most;
        if (most < 1e-4)
            break;
        for (int i = 0; i < 16; i++) {
            const double alpha = reference_alpha(splats + s, bx + (i & 3), by + (i >> 2));
            for (int c = 0; c < 3; c++)
                colour[i][c] += splats[s].rgb[c] * alpha * t[i];
            t[i] *= 1.0 - alpha;
        }
    }
    for (int i = 0; i < 16; i++)
        if (bx + (i & 3) < view->width && by + (i >> 2) < view->height)
            for (int c = 0; c < 3; c++)
                rgb[((size_t)c * (size_t)view->height + (size_t)(by + (i >> 2))) * (size_t)view->width + (size_t)(bx + (i & 3))] =
                    colour[i][c] + t[i] * background[c];
}

/** rgb: planar [3][height][width]. */
static inline void reference_render(const reference_scene *s, const adcgs_view *view, const float background[3], double filter,
                                    double *rgb)
{
    reference_splat *splats = malloc((s->n + 1) * sizeof *splats);
    uint32_t n = 0;
    for (uint32_t i = 0; i < s->n; i++)
        n += (uint32_t)reference_project(splats + n, s, view, filter, i);
    qsort(splats, n, sizeof *splats, reference_compare);
    for (int y = 0; y < view->height; y += 4)
        for (int x = 0; x < view->width; x += 4)
            reference_block(splats, n, view, background, x, y, rgb);
    free(splats);
}

#endif
