/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the backward projection: the sums of a slot's splat over its tiles,
 * in the order of its entries, then from the splat to mean, scale, rotation,
 * opacity and colour.
 */
#include "render/project.h"
#include "train/raster_isa.h"

#include <stdalign.h>

#define LN2 0x1.62e43p-1f

typedef struct slot_sums {
    alignas(64) float v[SUM_WORDS][64];
    alignas(64) int32_t drawn[64];
} slot_sums;

/* Lines listed before they are added, and how far ahead they are fetched: they lie where their tiles are. */
#define LIST_MAX 512
#define FETCH_AHEAD 24

static vf add_lines(vf sum, const float *sums, const uint32_t *lines, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        __builtin_prefetch(sums + (size_t)lines[i + FETCH_AHEAD] * SUM_WORDS);
        sum = vf_add(sum, vf_load(sums + (size_t)lines[i] * SUM_WORDS));
    }
    return sum;
}

/* The lines of slots [from, ...) as far as the list has room, and the end of each slot's. Returns the slot after the last. */
static uint32_t list_lines(uint32_t *lines, uint32_t *ends, const adcgs_kept *k, uint32_t slot, uint32_t from)
{
    uint32_t n = 0, l = from;
    for (; l < 64; l++) {
        const uint32_t splat = k->where[slot + l];
        const uint32_t begin = splat == UINT32_MAX ? 0 : k->first[splat], count = splat == UINT32_MAX ? 0 : k->first[splat + 1] - begin;
        if (n + count > LIST_MAX)
            break;
        for (uint32_t i = 0; i < count; i++)
            lines[n + i] = k->place[begin + i];
        n += count;
        ends[l] = n;
    }
    for (uint32_t i = 0; i < FETCH_AHEAD; i++)
        lines[n + i] = 0;
    return l;
}

/* A slot with more lines than a list holds. */
static vf add_many(const adcgs_back_job *job, uint32_t splat)
{
    vf sum = vf_set1(0.0f);
    for (uint32_t i = job->kept.first[splat]; i < job->kept.first[splat + 1]; i++)
        sum = vf_add(sum, vf_load(job->sums + (size_t)job->kept.place[i] * SUM_WORDS));
    return sum;
}

static void store_sum(slot_sums *o, uint32_t l, vf sum)
{
    alignas(64) float total[SUM_WORDS];
    vf_store(total, sum);
    for (int i = 0; i < SUM_WORDS; i++)
        o->v[i][l] = total[i];
}

static void gather_sums(slot_sums *o, const adcgs_back_job *job, uint32_t slot)
{
    uint32_t lines[LIST_MAX + FETCH_AHEAD], ends[64];
    for (uint32_t l = 0; l < 64; l++)
        o->drawn[l] = job->kept.where[slot + l] != UINT32_MAX;
    for (uint32_t from = 0; from < 64;) {
        const uint32_t to = list_lines(lines, ends, &job->kept, slot, from);
        uint32_t done = 0;
        for (uint32_t l = from; l < to; l++) {
            store_sum(o, l, add_lines(vf_set1(0.0f), job->sums, lines + done, ends[l] - done));
            done = ends[l];
        }
        if (to == from)
            store_sum(o, to, add_many(job, job->kept.where[slot + to]));
        from = to == from ? to + 1 : to;
    }
}

typedef struct gaussian_grads {
    float mean[3], scale[3], rotation[4];
} gaussian_grads;

/* Gradients of p, q, r from those of the conic. */
static inline void conic_back(float back[3], const adcgs_projection *g, float exx, float exy, float eyy)
{
    const float inv = 1.0f / g->det;
    const float ga = -0.5f * exx, gb = exy, gc = -0.5f * eyy;
    const float s = (ga * g->r + gb * g->q + gc * g->p) * inv;
    back[0] = inv * (gc - g->r * s);
    back[1] = ADCGS_SHEAR * (inv * (gb + 2.0f * g->q * s));
    back[2] = inv * (ga - g->p * s);
}

/* Gradient of the rotation matrix to the quaternion, all four components free. */
static inline void rotation_back(float out[4], float d[3][3], float w, float x, float y, float z)
{
    out[0] = 2.0f * (z * (d[1][0] - d[0][1]) + y * (d[0][2] - d[2][0]) + x * (d[2][1] - d[1][2]));
    out[1] = 2.0f * (y * (d[0][1] + d[1][0]) + z * (d[0][2] + d[2][0]) + w * (d[2][1] - d[1][2]) - 2.0f * x * (d[1][1] + d[2][2]));
    out[2] = 2.0f * (x * (d[0][1] + d[1][0]) + z * (d[1][2] + d[2][1]) + w * (d[0][2] - d[2][0]) - 2.0f * y * (d[0][0] + d[2][2]));
    out[3] = 2.0f * (x * (d[0][2] + d[2][0]) + y * (d[1][2] + d[2][1]) + w * (d[1][0] - d[0][1]) - 2.0f * z * (d[0][0] + d[1][1]));
}

/* From gradients of centre (u, v) and covariance (p, q, r) to those of the Gaussian. */
static inline void carry_back(gaussian_grads *out, const adcgs_projection *g, const adcgs_view *view, const float scale[3],
                              const float quaternion[4], float gu, float gv, const float cov[3])
{
    float mr[2][3], m[2][3], rot[3][3], along[2] = {0.0f, 0.0f}, tilt[2] = {0.0f, 0.0f};
    for (int j = 0; j < 3; j++) {
        const float f0 = 2.0f * cov[0] * g->f[0][j] + cov[1] * g->f[1][j], f1 = 2.0f * cov[2] * g->f[1][j] + cov[1] * g->f[0][j];
        out->scale[j] = f0 * g->mr[0][j] + f1 * g->mr[1][j];
        mr[0][j] = f0 * scale[j];
        mr[1][j] = f1 * scale[j];
    }
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            rot[k][j] = g->m[0][k] * mr[0][j] + g->m[1][k] * mr[1][j];
    rotation_back(out->rotation, rot, quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) {
            m[i][k] = mr[i][0] * g->rot[k][0] + mr[i][1] * g->rot[k][1] + mr[i][2] * g->rot[k][2];
            along[i] += m[i][k] * g->m[i][k];
            tilt[i] += m[i][k] * view->rotation[6 + k];
        }
    /* Where the Jacobian's x/z is limited, it does not move with the mean. */
    const float tx = view->fx * gu - (g->lx == g->tx ? g->jx * tilt[0] : 0.0f);
    const float ty = view->fy * gv - (g->ly == g->ty ? g->jy * tilt[1] : 0.0f);
    const float cx = tx * g->iz, cy = ty * g->iz, cz = -g->iz * (along[0] + along[1] + tx * g->tx + ty * g->ty);
    for (int j = 0; j < 3; j++)
        out->mean[j] = view->rotation[j] * cx + view->rotation[3 + j] * cy + view->rotation[6 + j] * cz;
}

static void project_back(const adcgs_back_job *job, uint32_t first)
{
    slot_sums o;
    gather_sums(&o, job, first);
    const adcgs_primitives *s = job->primitives;
    const adcgs_view view = *job->view;
    const adcgs_raster_grads to = job->out;
    const float half_width = 0.5f * LN2 * (float)view.width, half_height = 0.5f * LN2 * (float)view.height, filter = job->filter;
    for (uint32_t l = 0; l < 64; l++) {
        const uint32_t i = first + l;
        const int drawn = o.drawn[l];
        const float scale[3] = {s->scale[0][i], s->scale[1][i], s->scale[2][i]};
        const float q[4] = {s->rotation[0][i], s->rotation[1][i], s->rotation[2][i], s->rotation[3][i]};
        adcgs_projection g;
        adcgs_project_centre(&g, &view, s->mean[0][i], s->mean[1][i], s->mean[2][i]);
        adcgs_quaternion_matrix(g.rot, q[0], q[1], q[2], q[3]);
        adcgs_project_shape(&g, &view, filter, scale[0], scale[1], scale[2]);
        float cov[3];
        conic_back(cov, &g, o.v[SUM_EXX][l], o.v[SUM_EXY][l], o.v[SUM_EYY][l]);
        const float inv = 1.0f / g.det, ex = o.v[SUM_EX][l], ey = o.v[SUM_EY][l];
        gaussian_grads d;
        carry_back(&d, &g, &view, scale, q, inv * (g.r * ex - g.q * ey), inv * (g.p * ey - g.q * ex), cov);
        for (int a = 0; a < 3; a++) {
            to.mean[a][i] = drawn ? d.mean[a] : 0.0f;
            to.scale[a][i] = drawn ? d.scale[a] : 0.0f;
            to.colour[a][i] = o.v[SUM_RED + 4 * a][l];
        }
        for (int a = 0; a < 4; a++)
            to.rotation[a][i] = drawn ? d.rotation[a] : 0.0f;
        to.opacity[i] = drawn ? o.v[SUM_E][l] / s->opacity[i] : 0.0f;
        to.weight[i] = o.v[SUM_WEIGHT][l];
        const float su = half_width * o.v[SUM_ABS_U][l], sv = half_height * o.v[SUM_ABS_V][l];
        to.screen[i] = sqrtf(su * su + sv * sv);
    }
}
