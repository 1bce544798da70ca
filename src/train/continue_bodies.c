/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Matching of bodies with those of the previous segment. */
#include "train/continue_bodies.h"

#include "fmodel/body_trajectories.h"
#include "geometry/rotation.h"

#include <math.h>

/* Scene units: minimum radius within which a found body matches one of the model; chosen by hand, not measured. */
#define NEAR 0.03

/** State of a model's body at the start of the segment: rotation, centre of rotation at rest and now, size. */
typedef struct stand {
    double q[4], centre[3], to[3], half;
    int anchors, found; /* found: index of its found body, from 1; 0: none */
} stand;

static void measure(const adcgs_fmodel *f, int body, stand *s)
{
    uint32_t low[3], high[3];
    s->anchors = (int)adcgs_bodies_box(f, body, ADCGS_TIERS_MAX, low, high);
    for (int a = 0; s->anchors && a < 3; a++)
        s->half = fmax(s->half, 0.5 * (double)(high[a] - low[a] + 1) * (double)f->voxel);
}

/** States of all bodies at the start of the model's time table. */
static void take_stands(const adcgs_fmodel *f, stand stands[ADCGS_BODIES_MAX])
{
    adcgs_body_place place[ADCGS_BODIES_MAX];
    adcgs_bodies_pose(f, f->param[ADCGS_P_TIME].p, place);
    for (int b = 0; b < f->params.bodies; b++) {
        stand *s = &stands[b];
        *s = (stand){.half = NEAR};
        for (int i = 0; i < 4; i++)
            s->q[i] = (double)place[b].q[i];
        for (int a = 0; a < 3; a++) {
            s->centre[a] = (double)place[b].centre[a];
            s->to[a] = (double)place[b].to[a];
        }
        measure(f, b + 1, s);
    }
}

/** Mean position of a found body's points in its first frame. Returns 0 if it has none there. */
static int place_of(const adcgs_stereo *found, uint32_t body, double x[3])
{
    int n = 0;
    x[0] = x[1] = x[2] = 0;
    for (uint32_t i = 0; i < found->n_moving && found->moving[i].t <= found->frame_time[0]; i++)
        for (int a = 0; found->moving[i].body == body + 1 && a < 3; a++) {
            x[a] += found->moving[i].x[a];
            n += a == 0;
        }
    for (int a = 0; n && a < 3; a++)
        x[a] /= n;
    return n;
}

/** The nearest body of the model whose extent contains a position; -1 if there is none. */
static int body_at(const adcgs_fmodel *f, const stand *stands, const double x[3])
{
    double least = INFINITY;
    int nearest = -1;
    for (int b = 0; b < f->params.bodies; b++) {
        const stand *s = &stands[b];
        const double away = sqrt(pow(x[0] - s->to[0], 2) + pow(x[1] - s->to[1], 2) + pow(x[2] - s->to[2], 2));
        if (s->anchors && !s->found && away < s->half && away < least) {
            least = away;
            nearest = b;
        }
    }
    return nearest;
}

static int free_body(const adcgs_fmodel *f, const stand *stands)
{
    int b = 0;
    while (b < f->params.bodies && (stands[b].anchors || stands[b].found))
        b++;
    return b < f->params.bodies ? b : -1;
}

/** R(q) x, or its inverse. */
static void turn(const double q[4], int back, const double x[3], double out[3])
{
    double r[12];
    adcgs_rotation_to_pose(q, r);
    const int row = back ? 1 : 4, column = back ? 4 : 1;
    for (int i = 0; i < 3; i++)
        out[i] = r[row * i] * x[0] + r[row * i + column] * x[1] + r[row * i + 2 * column] * x[2];
}

/**
 * Composes poses for the model's rest positions: to the state at the end of the previous segment, back to the found body's rest
 * pose, and on to the frame.
 */
static void go_on_from(adcgs_stereo_body *body, uint32_t frames, const stand *s)
{
    const adcgs_stereo_pose first = body->pose[0];
    const double back[4] = {first.q[0], -first.q[1], -first.q[2], -first.q[3]};
    double away[3], rest[3], since[4];
    for (int a = 0; a < 3; a++)
        away[a] = s->to[a] - body->pivot[a] - first.way[a];
    turn(first.q, 1, away, rest); /* offset of the centre from the pivot, in the body's rest pose */
    adcgs_rotation_multiply(back, s->q, since);
    for (uint32_t m = 0; m < frames; m++) {
        adcgs_stereo_pose *p = &body->pose[m];
        double now[3], q[4];
        turn(p->q, 0, rest, now);
        adcgs_rotation_multiply(p->q, since, q);
        for (int a = 0; a < 3; a++)
            p->way[a] += now[a] + body->pivot[a] - s->centre[a];
        memcpy(p->q, q, sizeof q);
    }
    memcpy(body->pivot, s->centre, sizeof body->pivot);
}

/** Assigns the model's body numbers to found bodies, 0 for none, and converts their poses. */
static void name_bodies(const adcgs_fmodel *f, adcgs_stereo *found, stand *stands, uint8_t number[ADCGS_BODIES_MAX])
{
    for (int fresh = 0; fresh < 2; fresh++) /* first the bodies that continue */
        for (uint32_t i = 0; i < found->n_bodies; i++) {
            double x[3];
            if (number[i] || (!fresh && !place_of(found, i, x)))
                continue;
            const int b = fresh ? free_body(f, stands) : body_at(f, stands, x);
            if (b < 0)
                continue;
            number[i] = (uint8_t)(b + 1);
            stands[b].found = (int)i + 1;
            if (!fresh)
                go_on_from(&found->body[i], found->n_frames, &stands[b]);
        }
}

adcgs_status adcgs_continue_bodies(const adcgs_fmodel *f, adcgs_stereo *found, adcgs_error *error)
{
    stand stands[ADCGS_BODIES_MAX];
    uint8_t number[ADCGS_BODIES_MAX] = {0};
    if (!f->params.bodies || !found->n_bodies)
        return ADCGS_OK;
    adcgs_stereo_body *bodies = adcgs_alloc(NULL, f->params.bodies, sizeof *bodies, error);
    if (!bodies)
        return adcgs_alloc_status(error);
    take_stands(f, stands);
    name_bodies(f, found, stands, number);
    for (uint32_t i = 0; i < found->n_bodies; i++)
        if (number[i])
            bodies[number[i] - 1] = found->body[i];
        else
            adcgs_free(NULL, found->body[i].pose);
    for (uint32_t i = 0; i < found->n_moving; i++)
        if (found->moving[i].body)
            found->moving[i].body = number[found->moving[i].body - 1];
    adcgs_free(NULL, found->body);
    found->body = bodies;
    found->n_bodies = f->params.bodies;
    return ADCGS_OK;
}
