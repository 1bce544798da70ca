/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Body of the backward projection: the sums of a slot's splat over its tiles, in the order of its entries, then from the splat to
 * mean, scale, rotation, opacity and colour.
 */
#include "grad/raster_backward_isa.h"
#include "render/project.h"

#include <stdalign.h>

#define LN2 0x1.62e43p-1f /* arithmetic */

typedef struct slot_sums {
    alignas(64) float v[SUM_WORDS][64];
    alignas(64) int32_t drawn[64];
} slot_sums;

/* Prefetch distance in slots; their rows lie in depth order, not in slot order; chosen by hand, not measured. */
#define FETCH_AHEAD 6

static void fetch_sums(const adcgs_back_job *job, uint32_t splat)
{
    if (splat == UINT32_MAX)
        return;
    const float *line = job->sums + (size_t)job->kept.first[splat] * SUM_WORDS;
    for (int i = 0; i < 4; i++)
        __builtin_prefetch(line + i * SUM_WORDS);
}

static void gather_sums(slot_sums *o, const adcgs_back_job *job, uint32_t slot)
{
    const uint32_t *where = job->kept.where + slot;
    for (uint32_t l = 0; l < 64; l++) {
        const uint32_t splat = where[l];
        alignas(64) float total[SUM_WORDS];
        vf sum = vf_set1(0.0f);
        if (l + FETCH_AHEAD < 64)
            fetch_sums(job, where[l + FETCH_AHEAD]);
        o->drawn[l] = splat != UINT32_MAX;
        if (o->drawn[l])
            for (uint32_t i = job->kept.first[splat]; i < job->kept.first[splat + 1]; i++)
                sum = vf_add(sum, vf_load(job->sums + (size_t)i * SUM_WORDS));
        vf_store(total, sum);
        for (int i = 0; i < SUM_WORDS; i++)
            o->v[i][l] = total[i];
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

/* Gradient of the quaternion from that of the rotation matrix, all four components free. */
static inline void rotation_back(float out[4], float d[3][3], float w, float x, float y, float z)
{
    out[0] = 2.0f * (z * (d[1][0] - d[0][1]) + y * (d[0][2] - d[2][0]) + x * (d[2][1] - d[1][2]));
    out[1] =
        2.0f * (y * (d[0][1] + d[1][0]) + z * (d[0][2] + d[2][0]) + w * (d[2][1] - d[1][2]) - 2.0f * x * (d[1][1] + d[2][2]));
    out[2] =
        2.0f * (x * (d[0][1] + d[1][0]) + z * (d[1][2] + d[2][1]) + w * (d[0][2] - d[2][0]) - 2.0f * y * (d[0][0] + d[2][2]));
    out[3] =
        2.0f * (x * (d[0][2] + d[2][0]) + y * (d[1][2] + d[2][1]) + w * (d[1][0] - d[0][1]) - 2.0f * z * (d[0][0] + d[1][1]));
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
    /* Where the Jacobian's x/z is clamped, it does not depend on the mean. */
    const float tx = view->fx * gu - (g->lx == g->tx ? g->jx * tilt[0] : 0.0f);
    const float ty = view->fy * gv - (g->ly == g->ty ? g->jy * tilt[1] : 0.0f);
    const float cx = tx * g->iz, cy = ty * g->iz, cz = -g->iz * (along[0] + along[1] + tx * g->tx + ty * g->ty);
    for (int j = 0; j < 3; j++)
        out->mean[j] = view->rotation[j] * cx + view->rotation[3 + j] * cy + view->rotation[6 + j] * cz;
}

/* Gradients of 64 slots before they are written: locals, so that nothing aliases and the loop vectorises. */
typedef struct slot_grads {
    alignas(64) float mean[3][64], scale[3][64], rotation[4][64], opacity[64], screen[64];
} slot_grads;

static void back_lanes(slot_grads *to, const slot_sums *o, const adcgs_back_job *job, uint32_t first)
{
    const adcgs_primitives *s = job->primitives;
    const adcgs_view view = *job->view;
    const float half_width = 0.5f * LN2 * (float)view.width, half_height = 0.5f * LN2 * (float)view.height, filter = job->filter;
    const float *mx = s->mean[0] + first, *my = s->mean[1] + first, *mz = s->mean[2] + first, *opacity = s->opacity + first;
    const float *sx = s->scale[0] + first, *sy = s->scale[1] + first, *sz = s->scale[2] + first;
    const float *qw = s->rotation[0] + first, *qx = s->rotation[1] + first;
    const float *qy = s->rotation[2] + first, *qz = s->rotation[3] + first;
    for (int l = 0; l < 64; l++) {
        const int drawn = o->drawn[l];
        const float scale[3] = {sx[l], sy[l], sz[l]}, q[4] = {qw[l], qx[l], qy[l], qz[l]};
        adcgs_projection g;
        adcgs_project_centre(&g, &view, mx[l], my[l], mz[l]);
        adcgs_quaternion_matrix(g.rot, q[0], q[1], q[2], q[3]);
        adcgs_project_shape(&g, &view, filter, scale[0], scale[1], scale[2]);
        float cov[3];
        conic_back(cov, &g, o->v[SUM_EXX][l], o->v[SUM_EXY][l], o->v[SUM_EYY][l]);
        const float inv = 1.0f / g.det, ex = o->v[SUM_EX][l], ey = o->v[SUM_EY][l];
        gaussian_grads d;
        carry_back(&d, &g, &view, scale, q, inv * (g.r * ex - g.q * ey), inv * (g.p * ey - g.q * ex), cov);
        for (int a = 0; a < 3; a++) {
            to->mean[a][l] = drawn ? d.mean[a] : 0.0f;
            to->scale[a][l] = drawn ? d.scale[a] : 0.0f;
        }
        for (int a = 0; a < 4; a++)
            to->rotation[a][l] = drawn ? d.rotation[a] : 0.0f;
        to->opacity[l] = drawn ? o->v[SUM_E][l] / opacity[l] : 0.0f;
        const float su = half_width * o->v[SUM_ABS_U][l], sv = half_height * o->v[SUM_ABS_V][l];
        to->screen[l] = sqrtf(su * su + sv * sv);
    }
}

static void project_back(const adcgs_back_job *job, uint32_t first)
{
    slot_sums sums;
    slot_grads g;
    const adcgs_raster_grads *to = &job->out;
    const size_t bytes = sizeof g.opacity;
    gather_sums(&sums, job, first);
    back_lanes(&g, &sums, job, first);
    for (int a = 0; a < 3; a++) {
        memcpy(to->mean[a] + first, g.mean[a], bytes);
        memcpy(to->scale[a] + first, g.scale[a], bytes);
        memcpy(to->colour[a] + first, sums.v[SUM_RED + 4 * a], bytes);
    }
    for (int a = 0; a < 4; a++)
        memcpy(to->rotation[a] + first, g.rotation[a], bytes);
    memcpy(to->opacity + first, g.opacity, bytes);
    memcpy(to->weight + first, sums.v[SUM_WEIGHT], bytes);
    if (to->screen)
        memcpy(to->screen + first, g.screen, bytes);
}
