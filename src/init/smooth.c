/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Smoothing of costs along eight paths, and the choice of planes. */
#include "init/smooth.h"

#include <math.h>
#include <stdlib.h>

/*
 * Origin: semi-global matching (Hirschmueller 2008), prices chosen by hand, not measured. Costs are shares of ADCGS_SWEEP_COST.
 */
enum {
    STEP_PRICE = 6,  /* cost of a step to an adjacent plane */
    JUMP_LEAST = 20, /* cost of a larger step at high contrast */
    JUMP_MORE = 60,  /* additional cost without contrast */
    PATHS = 4        /* paths from one side */
};
#define EDGE 20.0f  /* per unit of contrast: depth edges often coincide with image edges */
#define ALIKE 0.45f /* maximum cost of a strong match, relative to the full cost */
#define CLEAR 0.03f /* minimum lead of the best plane over the next best */
#define RIVAL 2     /* planes: minimum distance of the next best from the best, exclusive */

/**
 * Padding before and after the planes of a path, so that no plane is a special case: places, and a cost above all; arithmetic.
 */
enum { BESIDE = 1, BEYOND = 16000 };

/** Costs to[] of a pixel's planes when the path comes from a neighbour with costs from[]. Returns the minimum of to. */
static int16_t reach(int16_t *restrict to, const int16_t *restrict from, const int16_t *restrict cost, int planes, int16_t least,
                     int16_t jump)
{
    int16_t best = INT16_MAX;
    const int16_t leap = (int16_t)(least + jump);
    for (int d = 0; d < planes; d++) {
        const int16_t below = (int16_t)(from[d - 1] + STEP_PRICE), above = (int16_t)(from[d + 1] + STEP_PRICE);
        int16_t value = ADCGS_MIN(from[d], leap);
        value = ADCGS_MIN(value, below);
        value = ADCGS_MIN(value, above);
        value = (int16_t)(value - least + cost[d]);
        to[d] = value;
        best = ADCGS_MIN(best, value);
    }
    return best;
}

typedef struct paths {
    const adcgs_sweep *s;
    const int16_t *cost;
    int16_t *sum;             /* [h][w][planes] */
    int16_t *row[2][PATHS];   /* [w][planes + 2 BESIDE] of this row and the previous row, from plane 0 on */
    int16_t *least[2][PATHS]; /* [w] */
} paths;

static int16_t jump_between(const adcgs_sweep *s, int x, int y, int px, int py)
{
    const float *a = s->view->pixels + 4 * ((size_t)(s->y + y) * (size_t)s->view->w + (size_t)(s->x + x));
    const float *b = s->view->pixels + 4 * ((size_t)(s->y + py) * (size_t)s->view->w + (size_t)(s->x + px));
    const float contrast = fabsf(a[0] - b[0]) + fabsf(a[1] - b[1]) + fabsf(a[2] - b[2]);
    return (int16_t)(JUMP_LEAST + JUMP_MORE / (1 + EDGE * contrast));
}

/** Updates one pixel in direction `sign`: from the previous pixel, and from three in the previous row. */
static void walk(paths *p, int x, int y, int sign)
{
    static const int step[PATHS][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}};
    const int planes = p->s->planes;
    const size_t at = ((size_t)y * (size_t)p->s->w + (size_t)x) * (size_t)planes, wide = (size_t)planes + 2 * BESIDE;
    for (int k = 0; k < PATHS; k++) {
        const int px = x - sign * step[k][0], py = y - sign * step[k][1], before = step[k][1];
        int16_t *to = p->row[0][k] + (size_t)x * wide;
        if (px < 0 || py < 0 || px >= p->s->w || py >= p->s->h) {
            int16_t best = INT16_MAX;
            for (int d = 0; d < planes; d++) {
                to[d] = p->cost[at + (size_t)d];
                best = to[d] < best ? to[d] : best;
            }
            p->least[0][k][x] = best;
        } else {
            p->least[0][k][x] = reach(to, p->row[before][k] + (size_t)px * wide, p->cost + at, planes, p->least[before][k][px],
                                      jump_between(p->s, x, y, px, py));
        }
        for (int d = 0; d < planes; d++)
            p->sum[at + (size_t)d] = (int16_t)(p->sum[at + (size_t)d] + to[d]);
    }
}

static void swap_rows(paths *p)
{
    for (int k = 0; k < PATHS; k++) {
        int16_t *row = p->row[0][k], *least = p->least[0][k];
        p->row[0][k] = p->row[1][k];
        p->least[0][k] = p->least[1][k];
        p->row[1][k] = row;
        p->least[1][k] = least;
    }
}

static adcgs_status smooth(const adcgs_sweep *s, const int16_t *cost, int16_t *sum, adcgs_error *error)
{
    paths p = {.s = s, .cost = cost, .sum = sum};
    const size_t row = (size_t)s->w * ((size_t)s->planes + 2 * BESIDE), all = 2 * PATHS * (row + (size_t)s->w);
    int16_t *memory = adcgs_alloc(NULL, all, sizeof *memory, error), *next = memory;
    if (!memory)
        return adcgs_alloc_status(error);
    for (size_t i = 0; i < all; i++)
        memory[i] = BEYOND;
    for (int k = 0; k < 2 * PATHS; k++) {
        p.row[k / PATHS][k % PATHS] = next + BESIDE;
        next += row;
        p.least[k / PATHS][k % PATHS] = next;
        next += s->w;
    }
    for (int y = 0; y < s->h; y++, swap_rows(&p))
        for (int x = 0; x < s->w; x++)
            walk(&p, x, y, 1);
    for (int y = s->h - 1; y >= 0; y--, swap_rows(&p))
        for (int x = s->w - 1; x >= 0; x--)
            walk(&p, x, y, -1);
    adcgs_free(NULL, memory);
    return ADCGS_OK;
}

/* ---- Decisions ---- */

/** Minimum of the parabola through three values at -1, 0, 1, the middle one being the least. */
static double lowest(double before, double here, double after)
{
    const double bend = before - 2 * here + after;
    return bend > 0 ? fmax(fmin(0.5 * (before - after) / bend, 0.5), -0.5) : 0;
}

static void decide(adcgs_depths *o, const adcgs_sweep *s, const int16_t *cost, const int16_t *sum, size_t pixel)
{
    int best = 0, next = INT16_MAX;
    for (int d = 1; d < s->planes; d++)
        best = sum[d] < sum[best] ? d : best;
    for (int d = 0; d < s->planes; d++)
        next = abs(d - best) > RIVAL && sum[d] < next ? sum[d] : next;
    const int inner = best > 0 && best + 1 < s->planes;
    const double off = inner ? lowest(sum[best - 1], sum[best], sum[best + 1]) : 0;
    const float lead = (float)(next - sum[best]) / (2 * PATHS * ADCGS_SWEEP_COST);
    o->inverse[pixel] = (float)(s->first + (best + off) * s->step);
    o->quality[pixel] = !inner                                                    ? ADCGS_DEPTH_NONE
                        : cost[best] <= ALIKE * ADCGS_SWEEP_COST && lead >= CLEAR ? ADCGS_DEPTH_STRONG
                                                                                  : ADCGS_DEPTH_WEAK;
}

adcgs_status adcgs_depths_find(adcgs_depths *o, const adcgs_sweep *s, adcgs_error *error)
{
    const size_t n = (size_t)s->w * (size_t)s->h, planes = (size_t)s->planes;
    *o = (adcgs_depths){.view = s->view, .x = s->x, .y = s->y, .w = s->w, .h = s->h, .step = s->step};
    o->inverse = adcgs_alloc(NULL, n, sizeof *o->inverse, error);
    o->quality = adcgs_alloc(NULL, n, 1, error);
    int16_t *cost = adcgs_alloc(NULL, n * planes, sizeof *cost, error), *sum = adcgs_alloc(NULL, n * planes, sizeof *sum, error);
    adcgs_status status = o->inverse && o->quality && cost && sum ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        status = adcgs_sweep_run(s, cost, error);
    if (status == ADCGS_OK)
        status = smooth(s, cost, sum, error);
    for (size_t i = 0; status == ADCGS_OK && i < n; i++)
        decide(o, s, cost + i * planes, sum + i * planes, i);
    adcgs_free(NULL, cost);
    adcgs_free(NULL, sum);
    return status;
}

void adcgs_depths_clear(adcgs_depths *o)
{
    adcgs_free(NULL, o->inverse);
    adcgs_free(NULL, o->quality);
    memset(o, 0, sizeof *o);
}
