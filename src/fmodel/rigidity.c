/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rigidity: neighbourhoods, energy and gradient. */
#include "fmodel/rigidity.h"

#include "fmodel/pass_layout.h"

#include <math.h>
#include <stdlib.h>

/* Neighbours; numbers of a rotation and a translation, geometry. */
enum { NEAR = ADCGS_RIGIDITY_NEAR, PULL_ROWS = 12 };

/**
 * Stretch below which the energy is quadratic. Above it the cost grows slowly, so that parts may slide past each other. Relative
 * length; chosen by hand, not measured.
 */
#define SOFT 0.05f

/* ---- Neighbourhoods ---- */

typedef struct near_job {
    const adcgs_fmodel *f;
    adcgs_rigidity *rigid;
    const uint64_t *along; /* [n] x and index of each anchor, sorted; near anchors are near in this order */
} near_job;

/** Inserts j into a list sorted by key, then by index, so that the order of calls does not matter. */
static void keep_best(uint64_t *best, int32_t *near, int n, uint64_t key, uint32_t j)
{
    int k = n - 1;
    if (key > best[k] || (key == best[k] && near[k] >= 0 && (int32_t)j > near[k]))
        return;
    for (; k > 0 && (best[k - 1] > key || (best[k - 1] == key && near[k - 1] > (int32_t)j)); k--) {
        best[k] = best[k - 1];
        near[k] = near[k - 1];
    }
    best[k] = key;
    near[k] = (int32_t)j;
}

/** Offers anchor j to the neighbours of i: to the closest, and within reach to a random selection. */
static void consider(const adcgs_fmodel *f, uint32_t i, uint32_t j, uint64_t reach2, uint64_t best[NEAR], int32_t near[NEAR])
{
    uint64_t d = 0;
    for (int a = 0; a < 3; a++) {
        const int64_t way = (int64_t)f->pos[i][a] - (int64_t)f->pos[j][a];
        d += (uint64_t)(way * way);
    }
    keep_best(best, near, ADCGS_RIGIDITY_CLOSE, d, j);
    if (d < reach2)
        keep_best(best + ADCGS_RIGIDITY_CLOSE, near + ADCGS_RIGIDITY_CLOSE, NEAR - ADCGS_RIGIDITY_CLOSE, adcgs_random64(1, i, j),
                  j);
}

/** Finds the closest anchors, and a fixed random selection of those within reach. rank: the anchor's rank along x. */
static void find_near(const near_job *job, uint32_t rank)
{
    const adcgs_fmodel *f = job->f;
    const double reach = (double)ADCGS_RIGIDITY_REACH / (double)f->voxel;
    const uint64_t reach2 = (uint64_t)fmin(ceil(reach * reach), 0x1p62);
    const uint32_t i = (uint32_t)job->along[rank];
    int32_t *near = job->rigid->near[i];
    uint64_t best[NEAR];
    for (int k = 0; k < NEAR; k++) {
        best[k] = UINT64_MAX;
        near[k] = -1;
    }
    for (int side = -1; side <= 1; side += 2)
        for (int64_t at = (int64_t)rank + side; at >= 0 && at < (int64_t)f->n; at += side) {
            const uint32_t j = (uint32_t)job->along[at];
            const int64_t way = (int64_t)f->pos[j][0] - (int64_t)f->pos[i][0];
            if ((uint64_t)(way * way) > ADCGS_MAX(reach2, best[ADCGS_RIGIDITY_CLOSE - 1]))
                break;
            consider(f, i, j, reach2, best, near);
        }
}

static void near_group(void *arg, int group, int thread)
{
    (void)thread;
    const near_job *job = arg;
    const uint32_t begin = (uint32_t)group * ADCGS_LANES, end = ADCGS_MIN(begin + ADCGS_LANES, job->f->n);
    for (uint32_t i = begin; i < end; i++)
        find_near(job, i);
}

static int by_value(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

void adcgs_rigidity_clear(adcgs_rigidity *rigid)
{
    adcgs_free(NULL, rigid->near);
    adcgs_free(NULL, rigid->pull);
    memset(rigid, 0, sizeof *rigid);
}

adcgs_status adcgs_rigidity_build(adcgs_rigidity *rigid, const adcgs_fmodel *f, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_rigidity_clear(rigid);
    rigid->n = f->n;
    rigid->near = adcgs_alloc(NULL, f->n, sizeof *rigid->near, error);
    rigid->pull = adcgs_alloc(NULL, (size_t)f->groups * PULL_ROWS * ADCGS_LANES, sizeof *rigid->pull, error);
    if (!rigid->near || !rigid->pull)
        return adcgs_alloc_status(error);
    uint64_t *along = adcgs_alloc(NULL, f->n, sizeof *along, error);
    if (!along)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < f->n; i++)
        along[i] = (uint64_t)f->pos[i][0] << 32 | i;
    qsort(along, f->n, sizeof *along, by_value);
    near_job job = {f, rigid, along};
    adcgs_pool_run(pool, near_group, &job, (int)f->groups);
    adcgs_free(NULL, along);
    return ADCGS_OK;
}

/* ---- Energy ---- */

/** R - I of an anchor, row by row. r: its three rotation parameters, 64 apart; NULL: none. */
static void turn_of(const float *r, float m[9])
{
    if (!r) {
        memset(m, 0, 9 * sizeof *m);
        return;
    }
    const float x = r[0], y = r[ADCGS_LANES], z = r[2 * ADCGS_LANES], s = 2 / (1 + x * x + y * y + z * z);
    m[0] = -s * (y * y + z * z);
    m[1] = s * (x * y - z);
    m[2] = s * (x * z + y);
    m[3] = s * (x * y + z);
    m[4] = -s * (x * x + z * z);
    m[5] = s * (y * z - x);
    m[6] = s * (x * z - y);
    m[7] = s * (y * z + x);
    m[8] = -s * (x * x + y * y);
}

static const float *omega_of(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t i)
{
    return adcgs_pass_act(p, f, i / ADCGS_LANES).omega_out + i % ADCGS_LANES;
}

/** Energy of a pair; force: its force on j. y: position of j, 64 apart; v: from i to j. */
static float pair(const float *y, const float *di, const float *dj, const float m[9], const float n[9], const float v[3],
                  float force[3])
{
    float e[3], stretch = 0;
    const float length = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    /* R_j y + d_j - (R_i x + d_i) - R_i (y - x) = (R_j - R_i) y + d_j - d_i */
    for (int a = 0; a < 3; a++) {
        e[a] = dj[a * ADCGS_LANES] - di[a * ADCGS_LANES] + (n[3 * a] - m[3 * a]) * y[0] +
               (n[3 * a + 1] - m[3 * a + 1]) * y[ADCGS_LANES] + (n[3 * a + 2] - m[3 * a + 2]) * y[2 * ADCGS_LANES];
        stretch += e[a] * e[a];
    }
    const float soft = 1 + stretch / (length * SOFT * SOFT), scale = 2 * SOFT / (length * SOFT * SOFT * soft);
    for (int a = 0; a < 3; a++)
        force[a] = e[a] * scale;
    return SOFT * logf(soft);
}

/** Adds a force at y to the gradient of a transformation: of its translation, and of its matrix, which multiplies y. */
static void add_force(float *pull, const float force[3], const float *y, float scale)
{
    for (int a = 0; a < 3; a++) {
        pull[a * ADCGS_LANES] += scale * force[a];
        for (int b = 0; b < 3; b++)
            pull[(3 + 3 * a + b) * ADCGS_LANES] += scale * force[a] * y[b * ADCGS_LANES];
    }
}

double adcgs_rigidity_pull(adcgs_rigidity *rigid, const adcgs_pass *p, const adcgs_fmodel *f, float weight)
{
    const float each = weight / ((float)NEAR * (float)rigid->n);
    const int turns = f->params.coarse_rotation;
    double energy = 0;
    memset(rigid->pull, 0, (size_t)f->groups * PULL_ROWS * ADCGS_LANES * sizeof *rigid->pull);
    for (uint32_t i = 0; i < rigid->n; i++) {
        const float *di = omega_of(p, f, i), *x = f->x + (size_t)(i / ADCGS_LANES) * 3 * ADCGS_LANES + i % ADCGS_LANES;
        float *pull = rigid->pull + (size_t)(i / ADCGS_LANES) * PULL_ROWS * ADCGS_LANES + i % ADCGS_LANES, m[9], n[9];
        if (f->moving[i] == 0)
            continue;
        turn_of(turns ? di + 9 * ADCGS_LANES : NULL, m);
        for (int k = 0; k < NEAR; k++) {
            const uint32_t j = (uint32_t)rigid->near[i][k];
            if (rigid->near[i][k] < 0 || f->moving[j] == 0)
                continue;
            const float *dj = omega_of(p, f, j), *y = f->x + (size_t)(j / ADCGS_LANES) * 3 * ADCGS_LANES + j % ADCGS_LANES;
            const float v[3] = {y[0] - x[0], y[ADCGS_LANES] - x[ADCGS_LANES], y[2 * ADCGS_LANES] - x[2 * ADCGS_LANES]};
            float force[3];
            turn_of(turns ? dj + 9 * ADCGS_LANES : NULL, n);
            energy += pair(y, di, dj, m, n, v, force);
            add_force(rigid->pull + (size_t)(j / ADCGS_LANES) * PULL_ROWS * ADCGS_LANES + j % ADCGS_LANES, force, y, each);
            add_force(pull, force, y, -each);
        }
    }
    return energy / ((double)NEAR * rigid->n);
}
