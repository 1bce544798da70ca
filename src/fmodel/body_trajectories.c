/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rigid bodies: poses, their gradients, and their centres of rotation. */
#include "fmodel/body_trajectories.h"

#include "geometry/rotation.h"

#include <math.h>

/** Reads and normalises a quaternion from the first four of a pose's seven columns. Returns its original length. */
static float read_quaternion(const float *columns, float q[4])
{
    float square = 0;
    for (int i = 0; i < 4; i++) {
        q[i] = columns[i] * ADCGS_POSE_SCALE + (i ? 0 : 1);
        square += q[i] * q[i];
    }
    const float length = sqrtf(square);
    for (int i = 0; i < 4; i++)
        q[i] = length > 0x1p-20f ? q[i] / length : (float)!i;
    return length;
}

void adcgs_bodies_pose(const adcgs_fmodel *f, const float *columns, adcgs_body_place *pose)
{
    for (int b = 0; b < f->params.bodies; b++) {
        const float *z = columns + adcgs_pose_at(&f->params, b + 1);
        read_quaternion(z, pose[b].q);
        for (int a = 0; a < 3; a++) {
            pose[b].centre[a] = f->centre[b][a];
            pose[b].to[a] = f->centre[b][a] + z[4 + a] * ADCGS_POSE_SCALE;
        }
    }
}

void adcgs_bodies_pose_back(const adcgs_fmodel *f, const float *columns, const adcgs_body_grad *grad, float *d)
{
    for (int b = 0; b < f->params.bodies; b++, d += ADCGS_POSE_N, grad++) {
        const float *m = grad->m;
        float q[4];
        const float length = read_quaternion(columns + adcgs_pose_at(&f->params, b + 1), q);
        const float w = q[0], x = q[1], y = q[2], z = q[3];
        /* Gradient of the quaternion and of the matrix 1 - 2 y^2 - 2 z^2, 2 x y - 2 w z, ... */
        const float g[4] = {
            grad->q[0] + 2 * (z * (m[3] - m[1]) + y * (m[2] - m[6]) + x * (m[7] - m[5])),
            grad->q[1] + 2 * (y * (m[1] + m[3]) + z * (m[2] + m[6]) + w * (m[7] - m[5]) - 2 * x * (m[4] + m[8])),
            grad->q[2] + 2 * (x * (m[1] + m[3]) + z * (m[5] + m[7]) + w * (m[2] - m[6]) - 2 * y * (m[0] + m[8])),
            grad->q[3] + 2 * (x * (m[2] + m[6]) + y * (m[5] + m[7]) + w * (m[3] - m[1]) - 2 * z * (m[0] + m[4])),
        };
        const float along = w * g[0] + x * g[1] + y * g[2] + z * g[3];
        for (int i = 0; i < 4; i++)
            d[i] = length > 0x1p-20f ? (g[i] - q[i] * along) / length * ADCGS_POSE_SCALE : 0;
        for (int a = 0; a < 3; a++)
            d[4 + a] = grad->way[a] * ADCGS_POSE_SCALE;
    }
}

/** Converts a pose's translation from one pivot to another: R (x - a) + a + way = R (x - b) + b + out. */
static void move_pivot(const double q[4], const double a[3], const double way[3], const double b[3], double out[3])
{
    const double v[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    double r[12];
    adcgs_rotation_to_pose(q, r);
    for (int i = 0; i < 3; i++)
        out[i] = way[i] - v[i] + r[4 * i] * v[0] + r[4 * i + 1] * v[1] + r[4 * i + 2] * v[2];
}

static float *pose_of(adcgs_fmodel *f, int body, int row)
{
    return f->param[ADCGS_P_TIME].p + (size_t)row * (size_t)adcgs_fmodel_time_columns(&f->params) +
           adcgs_pose_at(&f->params, body);
}

void adcgs_bodies_set_pose(adcgs_fmodel *f, int body, int row, const double q[4], const double pivot[3], const double way[3])
{
    const float *c = f->centre[body - 1];
    float *z = pose_of(f, body, row);
    double own[3];
    move_pivot(q, pivot, way, (const double[]){(double)c[0], (double)c[1], (double)c[2]}, own);
    for (int i = 0; i < 4; i++)
        z[i] = (float)((q[i] - !i) / (double)ADCGS_POSE_SCALE);
    for (int a = 0; a < 3; a++)
        z[4 + a] = (float)(own[a] / (double)ADCGS_POSE_SCALE);
}

uint32_t adcgs_bodies_box(const adcgs_fmodel *f, int body, int tiers, uint32_t low[3], uint32_t high[3])
{
    uint32_t n = 0;
    for (int a = 0; a < 3; a++) {
        low[a] = UINT32_MAX;
        high[a] = 0;
    }
    for (uint32_t i = 0; i < f->n; i++) {
        if (f->body[i] != body || f->moving[i] == 0 || f->tier[i] >= tiers)
            continue;
        n++;
        for (int a = 0; a < 3; a++) {
            low[a] = ADCGS_MIN(low[a], f->pos[i][a]);
            high[a] = ADCGS_MAX(high[a], f->pos[i][a]);
        }
    }
    return n;
}

/** Centre of the box of a body's anchors; the current centre if it has none. */
static void find_centre(const adcgs_fmodel *f, int body, float centre[3])
{
    uint32_t low[3], high[3], n = 0;
    for (int tiers = 1; !n && tiers <= ADCGS_TIERS_MAX; tiers++)
        n = adcgs_bodies_box(f, body, tiers, low, high);
    for (int a = 0; n > 0 && a < 3; a++)
        centre[a] = fmaf((float)(low[a] + high[a] + 1), 0.5f * f->voxel, f->origin[a]);
}

void adcgs_bodies_recentre(adcgs_fmodel *f)
{
    for (int b = 1; b <= f->params.bodies; b++) {
        float *c = f->centre[b - 1], found[3] = {c[0], c[1], c[2]};
        find_centre(f, b, found);
        if (!memcmp(found, c, sizeof found))
            continue;
        const double from[3] = {(double)c[0], (double)c[1], (double)c[2]};
        memcpy(c, found, sizeof found);
        for (int row = 0; row < f->params.time_rows; row++) {
            const float *z = pose_of(f, b, row);
            double unit[4], way[3];
            float q[4];
            read_quaternion(z, q);
            for (int i = 0; i < 4; i++)
                unit[i] = (double)q[i];
            for (int a = 0; a < 3; a++)
                way[a] = (double)(z[4 + a] * ADCGS_POSE_SCALE);
            adcgs_bodies_set_pose(f, b, row, unit, from, way);
        }
    }
}
