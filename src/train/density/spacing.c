/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Nearest voxels. The voxels of an octree cube are consecutive in Morton order, so the order itself is the tree. The distances to
 * neighbours in the order bound the search, and most cubes are beyond that bound.
 */
#include "train/density/spacing.h"

#include "geom/geom.h"

#include <math.h>

/*
 * NEAREST: literature, the initial scale of 3D Gaussian splatting (Kerbl et al. 2023). The others: chosen by hand, not measured.
 */
enum {
    NEAREST = 3, /* nearest voxels whose mean distance is wanted */
    ABOUT = 4,   /* neighbours in Morton order tested per side for a first bound */
    FEW = 8      /* maximum voxels of a cube that is not split further */
};

typedef struct query {
    const uint32_t (*pos)[3];
    const uint64_t *code;
    uint32_t self;
    uint64_t best[NEAREST]; /* squared distances, ascending */
} query;

static uint64_t distance2(const uint32_t a[3], const uint32_t b[3])
{
    uint64_t sum = 0;
    for (int i = 0; i < 3; i++) {
        const int64_t d = (int64_t)a[i] - (int64_t)b[i];
        sum += (uint64_t)(d * d);
    }
    return sum;
}

static void offer(query *q, uint64_t far)
{
    if (far >= q->best[NEAREST - 1])
        return;
    int a = NEAREST - 1;
    for (; a > 0 && far < q->best[a - 1]; a--)
        q->best[a] = q->best[a - 1];
    q->best[a] = far;
}

/** Squared distance to a cube with sides of 2^shift voxels. */
static uint64_t gap2(const uint32_t x[3], const uint32_t corner[3], int shift)
{
    uint32_t nearest[3];
    for (int a = 0; a < 3; a++)
        nearest[a] = ADCGS_MIN(ADCGS_MAX(x[a], corner[a]), corner[a] + ((1u << shift) - 1));
    return distance2(x, nearest);
}

/** First index of [low, high) whose code is not below `from`. */
static uint32_t first_from(const uint64_t *code, uint32_t low, uint32_t high, uint64_t from)
{
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (code[middle] < from)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/** Searches a cube, which holds voxels low to high - 1. */
static void look_in(query *q, uint32_t low, uint32_t high, const uint32_t corner[3], int shift)
{
    const uint32_t *x = q->pos[q->self];
    if (low == high || gap2(x, corner, shift) >= q->best[NEAREST - 1])
        return;
    if (high - low <= FEW || !shift) {
        for (uint32_t i = low; i < high; i++)
            if (i != q->self)
                offer(q, distance2(x, q->pos[i]));
        return;
    }
    const int half = shift - 1;
    const uint64_t begin = adcgs_morton(corner);
    for (uint32_t k = 0; k < 8; k++) {
        const uint32_t end = first_from(q->code, low, high, begin + ((uint64_t)(k + 1) << 3 * half));
        const uint32_t at[3] = {corner[0] + (k / 4 << half), corner[1] + ((k >> 1 & 1) << half), corner[2] + ((k & 1) << half)};
        look_in(q, low, end, at, half);
        low = end;
    }
}

/** Sets the bound to one more than a squared distance within which three voxels lie, so that they count. */
static void bound(query *q, uint32_t n)
{
    const uint32_t low = q->self > ABOUT ? q->self - ABOUT : 0, high = ADCGS_MIN(n, q->self + ABOUT + 1);
    for (int a = 0; a < NEAREST; a++)
        q->best[a] = UINT64_MAX;
    for (uint32_t i = low; i < high; i++)
        if (i != q->self)
            offer(q, distance2(q->pos[q->self], q->pos[i]));
    const uint64_t most = q->best[NEAREST - 1];
    for (int a = 0; a < NEAREST; a++)
        q->best[a] = most < UINT64_MAX ? most + 1 : most;
}

adcgs_status adcgs_spacings(const uint32_t (*pos)[3], uint32_t n, double *mean, adcgs_error *error)
{
    static const uint32_t all[3] = {0, 0, 0};
    const uint32_t known = ADCGS_MIN(n - 1, NEAREST);
    uint64_t *code = adcgs_alloc(NULL, n, sizeof *code, error);
    if (!code)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n; i++)
        code[i] = adcgs_morton(pos[i]);
    for (uint32_t i = 0; i < n; i++) {
        query q = {.pos = pos, .code = code, .self = i};
        double sum = 0;
        bound(&q, n);
        look_in(&q, 0, n, all, ADCGS_GEOM_DEPTH_MAX);
        for (uint32_t a = 0; a < known; a++)
            sum += sqrt((double)q.best[a]);
        mean[i] = known ? sum / known : 0;
    }
    adcgs_free(NULL, code);
    return ADCGS_OK;
}
