/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Poses of rigid bodies. */
#include "init/rigid/body_pose.h"

#include "geometry/rotation.h"

#include <math.h>

void adcgs_stereo_pose_set(adcgs_stereo_pose *p, const adcgs_rigid *at, const double pivot[3])
{
    double pose[12] = {0}, there[3];
    for (int a = 0; a < 9; a++)
        pose[4 * (a / 3) + a % 3] = at->r[a];
    adcgs_rotation_from_pose(pose, p->q);
    adcgs_rigid_apply(at, pivot, there);
    for (int a = 0; a < 3; a++)
        p->way[a] = there[a] - pivot[a];
}

void adcgs_stereo_poses_align(adcgs_stereo_pose *poses, uint32_t n)
{
    for (uint32_t i = 1; i < n; i++) {
        const double *q = poses[i - 1].q;
        double *next = poses[i].q;
        const double dot = q[0] * next[0] + adcgs_v3_dot(q + 1, next + 1);
        for (int k = 0; k < 4 && dot < 0; k++)
            next[k] = -next[k];
    }
}

adcgs_stereo_pose adcgs_stereo_pose_at(const adcgs_stereo *s, uint32_t body, float t)
{
    const adcgs_stereo_pose *pose = s->body[body].pose;
    uint32_t next = 0;
    while (next < s->n_frames && s->frame_time[next] < t)
        next++;
    if (next == 0 || next == s->n_frames)
        return pose[next ? next - 1 : 0];
    const adcgs_stereo_pose *a = &pose[next - 1], *b = &pose[next];
    const double u = (double)((t - s->frame_time[next - 1]) / (s->frame_time[next] - s->frame_time[next - 1]));
    adcgs_stereo_pose out;
    double square = 0;
    for (int i = 0; i < 4; i++) {
        out.q[i] = a->q[i] + u * (b->q[i] - a->q[i]);
        square += out.q[i] * out.q[i];
    }
    for (int i = 0; i < 4; i++)
        out.q[i] /= sqrt(square);
    for (int i = 0; i < 3; i++)
        out.way[i] = a->way[i] + u * (b->way[i] - a->way[i]);
    return out;
}

void adcgs_stereo_rest(const adcgs_stereo *s, const adcgs_stereo_point *p, double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = p->x[a] + (p->body ? 0 : (double)p->velocity[a] * (double)p->shift);
    if (!p->body)
        return;
    const adcgs_stereo_body *body = &s->body[p->body - 1];
    const adcgs_stereo_pose at = adcgs_stereo_pose_at(s, p->body - 1u, p->t);
    double r[12], v[3];
    adcgs_rotation_to_pose(at.q, r);
    for (int i = 0; i < 3; i++)
        v[i] = x[i] - body->pivot[i] - at.way[i];
    for (int i = 0; i < 3; i++)
        x[i] = body->pivot[i] + r[i] * v[0] + r[4 + i] * v[1] + r[8 + i] * v[2];
}
