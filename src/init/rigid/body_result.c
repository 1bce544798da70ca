/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The result of tracking a rigid body: its poses in all frames, and its points. */
#include "init/rigid/body_result.h"

#include "geometry/rotation.h"
#include "init/rigid/body_pose.h"

#include <math.h>

/** Marks the points of the body in all frames. */
static void claim(adcgs_stereo *out, const adcgs_track *t, adcgs_layers *l, adcgs_stereo_body *b, uint8_t number)
{
    for (int m = 0; m < l->n; m++)
        for (uint32_t i = 0; t->known[m] && i < t->model.n; i++) {
            double x[3];
            uint32_t j;
            adcgs_rigid_apply(&t->place[m].at, t->model.p[i].x, x);
            while (adcgs_body_match(&t->model, i, x, &l->all[m], &t->place[m], &j)) {
                l->p[l->begin[m] + j].body = number;
                out->moving[l->begin[m] + j].body = number;
                b->n++;
            }
        }
}

/** Interpolates between two known poses. */
static void set_between(adcgs_stereo_pose *p, const adcgs_stereo_pose *a, const adcgs_stereo_pose *b, double share)
{
    double turn[3], part[4];
    adcgs_rotation_between(a->q, b->q, turn);
    adcgs_rotation_exp(turn, share, part);
    adcgs_rotation_multiply(a->q, part, p->q);
    for (int k = 0; k < 3; k++)
        p->way[k] = a->way[k] + share * (b->way[k] - a->way[k]);
}

/** Sets the poses of frames in which the body was not found. */
static void fill(adcgs_stereo_body *b, const adcgs_track *t, const adcgs_layers *l)
{
    const float *when = l->rig->frame_time;
    for (int m = 0; m < l->n; m++) {
        int before = m, after = m;
        while (before >= 0 && !t->known[before])
            before--;
        while (after < l->n && !t->known[after])
            after++;
        if (before == m)
            continue;
        if (before >= 0 && after < l->n)
            set_between(&b->pose[m], &b->pose[before], &b->pose[after],
                        (double)(when[m] - when[before]) / (double)(when[after] - when[before]));
        else
            b->pose[m] = b->pose[before >= 0 ? before : after];
    }
}

/** The frame with a known pose that is nearest to the middle of time. */
static int find_rest(const adcgs_track *t, const adcgs_layers *l)
{
    int best = -1;
    for (int m = 0; m < l->n; m++)
        if (t->known[m] && (best < 0 || fabsf(l->rig->frame_time[m] - 0.5f) < fabsf(l->rig->frame_time[best] - 0.5f)))
            best = m;
    return best;
}

adcgs_status adcgs_body_write(adcgs_stereo *out, const adcgs_track *t, adcgs_layers *l, uint8_t number, adcgs_error *error)
{
    adcgs_stereo_body *const b = &out->body[number - 1];
    double centre[3];
    adcgs_rigid back, at;
    const adcgs_rigid *rest = &t->place[find_rest(t, l)].at;
    *b = (adcgs_stereo_body){.pose = adcgs_alloc(NULL, (size_t)l->n, sizeof *b->pose, error)};
    if (!b->pose)
        return adcgs_alloc_status(error);
    adcgs_track_centre(t, centre);
    adcgs_rigid_apply(rest, centre, b->pivot);
    adcgs_rigid_inverse(rest, &back);
    for (int m = 0; m < l->n; m++)
        if (t->known[m]) {
            adcgs_rigid_then(&back, &t->place[m].at, &at);
            adcgs_stereo_pose_set(&b->pose[m], &at, b->pivot);
        }
    fill(b, t, l);
    adcgs_stereo_poses_align(b->pose, (uint32_t)l->n);
    claim(out, t, l, b, number);
    return ADCGS_OK;
}
