/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Poses of rigid bodies, in plain C: there are few bodies. */
#include "splat/rigid_motion.h"

#include "splat/quaternion.h"

/* The centre of the box of a body's voxels; the sum of both ends is exact, in half voxels. */
static void set_centre(float centre[3], const adcgs_model *m, const uint32_t low[3], const uint32_t high[3])
{
    const float half = 0.5f * m->voxel;
    for (int a = 0; a < 3; a++)
        centre[a] = fmaf((float)(low[a] + high[a] + 1), half, m->origin[a]);
}

void adcgs_bodies_init(adcgs_body_pose pose[ADCGS_BODIES_MAX], const adcgs_model *m)
{
    uint32_t low[ADCGS_BODIES_MAX][3], high[ADCGS_BODIES_MAX][3] = {{0}};
    memset(pose, 0, ADCGS_BODIES_MAX * sizeof *pose);
    uint8_t tier[ADCGS_BODIES_MAX]; /* first tier with anchors of the body: always present if any of its anchors is */
    memset(low, 0xff, sizeof low);
    memset(tier, 0xff, sizeof tier);
    for (uint32_t i = 0; m->params.bodies && i < m->n; i++)
        if (m->body[i])
            tier[m->body[i] - 1] = ADCGS_MIN(tier[m->body[i] - 1], m->tier[i]);
    for (uint32_t i = 0; m->params.bodies && i < m->n; i++) {
        const int b = m->body[i] - 1;
        for (size_t a = 0; b >= 0 && m->tier[i] == tier[b] && a < 3; a++) {
            low[b][a] = ADCGS_MIN(low[b][a], m->pos[3 * (size_t)i + a]);
            high[b][a] = ADCGS_MAX(high[b][a], m->pos[3 * (size_t)i + a]);
        }
    }
    for (int b = 0; b < m->params.bodies; b++)
        if (low[b][0] <= high[b][0])
            set_centre(pose[b].centre, m, low[b], high[b]);
}

static void set_turn(adcgs_body_pose *pose, float w, float x, float y, float z)
{
    const float n = adcgs_norm2(w, x, y, z), root = sqrtf(n);
    const int ok = adcgs_usable_norm(n);
    pose->q[0] = ok ? w / root : 1.0f;
    pose->q[1] = ok ? x / root : 0.0f;
    pose->q[2] = ok ? y / root : 0.0f;
    pose->q[3] = ok ? z / root : 0.0f;
    adcgs_rotation_matrix(pose->matrix, pose->q[0], pose->q[1], pose->q[2], pose->q[3]);
}

void adcgs_bodies_at(adcgs_body_pose pose[ADCGS_BODIES_MAX], const adcgs_params *params, const float *row)
{
    for (int b = 0; b < params->bodies; b++) {
        const float *z = row + adcgs_pose_at(params, b + 1);
        set_turn(&pose[b], fmaf(z[0], ADCGS_POSE_SCALE, 1.0f), z[1] * ADCGS_POSE_SCALE, z[2] * ADCGS_POSE_SCALE,
                 z[3] * ADCGS_POSE_SCALE);
        for (int a = 0; a < 3; a++)
            pose[b].place[a] = pose[b].centre[a] + z[4 + a] * ADCGS_POSE_SCALE;
    }
}

static void gather_lane(adcgs_body_lanes *lanes, uint32_t l, const adcgs_body_pose *pose)
{
    for (int c = 0; c < 4; c++)
        lanes->q[c][l] = pose->q[c];
    for (int c = 0; c < 9; c++)
        lanes->matrix[c][l] = pose->matrix[c];
    for (int c = 0; c < 3; c++) {
        lanes->centre[c][l] = pose->centre[c];
        lanes->place[c][l] = pose->place[c];
    }
}

int adcgs_bodies_gather(adcgs_body_lanes *lanes, const adcgs_body_pose pose[ADCGS_BODIES_MAX], const adcgs_model *m,
                        uint32_t first)
{
    int any = 0;
    for (uint32_t l = 0; m->params.bodies && l < ADCGS_LANES; l++) {
        lanes->has[l] = first + l < m->n && m->body[first + l] > 0;
        any |= lanes->has[l];
    }
    for (uint32_t l = 0; any && l < ADCGS_LANES; l++)
        gather_lane(lanes, l, &pose[lanes->has[l] ? m->body[first + l] - 1 : 0]);
    return any;
}
