/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Points that join or leave a body. */
#include "init/rigid/members.h"

#include "init/rigid/direct.h"

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    BODY_MOST = 6000, /* points: maximum of a body */
    HOPS = 6,         /* maximum number of growth steps per frame, each of length reach */
    SURE = 3,         /* frames in which a point must be seen before it can be dropped */
    AROUND = 32       /* maximum number of neighbours */
};
#define KEEP 0.45 /* minimum share of the frames with a match, among those in which the point is seen */
#define FITS 0.5  /* image agreement that counts as a match, if no matching point is found */

/**
 * Counts sightings and matches of the body's points in a frame. mark: [n] the frame's points that belong to the body; may be
 * NULL.
 */
static void count(adcgs_track *t, const adcgs_layers *l, int frame, uint8_t *mark)
{
    for (uint32_t i = 0; i < t->model.n; i++) {
        double x[3], normal[3];
        uint32_t j = 0;
        if (!adcgs_body_point_at(&t->model, i, &t->place[frame].at, &l->views[frame], x, normal))
            continue;
        t->model.more[i].seen++;
        const int found = adcgs_body_match(&t->model, i, x, &l->all[frame], &t->place[frame], &j);
        if (found && mark)
            mark[j] = 1;
        t->model.more[i].agreed =
            (uint16_t)(t->model.more[i].agreed +
                       (found || adcgs_direct_point(&t->model, i, &l->views[frame], &t->place[frame]) > FITS));
    }
}

static void drop(adcgs_body_model *m, int sure)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < m->n; i++)
        if (m->more[i].seen < sure || m->more[i].agreed >= KEEP * m->more[i].seen) {
            m->p[n] = m->p[i];
            m->more[n++] = m->more[i];
        }
    m->n = n;
}

/** Marks the points connected to marked points. */
static void spread(const adcgs_cloud *c, double reach, uint8_t *mark)
{
    uint32_t near[AROUND];
    for (uint8_t hop = 1; hop <= HOPS; hop++)
        for (uint32_t i = 0; i < c->n; i++) {
            if (mark[i] != hop)
                continue;
            const uint32_t n = adcgs_cloud_within(c, c->p[i].x, reach, near, AROUND);
            for (uint32_t k = 0; k < n; k++)
                if (!mark[near[k]] && !c->p[near[k]].body)
                    mark[near[k]] = (uint8_t)(hop + 1);
        }
}

/** Adds a frame's point to the body's rest pose. */
static adcgs_status add_point(adcgs_track *t, const adcgs_layers *l, int frame, uint32_t i, const adcgs_rigid *back,
                              const adcgs_cloud *own, adcgs_error *error)
{
    adcgs_stereo_point p = l->all[frame].p[i];
    const float *n = l->normal[l->begin[frame] + i];
    double x[3], turned[3];
    uint32_t near;
    adcgs_rigid_apply(back, p.x, x);
    memcpy(p.x, x, sizeof x);
    if (adcgs_cloud_within(own, x, t->model.pixel, &near, 1) || t->model.n >= BODY_MOST)
        return ADCGS_OK;
    adcgs_rigid_turn(back, (const double[]){(double)n[0], (double)n[1], (double)n[2]}, turned);
    ADCGS_TRY(adcgs_body_add(&t->model, &p, (const float[]){(float)turned[0], (float)turned[1], (float)turned[2]}, error));
    for (int a = 0; a < 3; a++)
        t->model.p[t->model.n - 1].rgb[a] /= t->place[frame].gain[t->model.more[t->model.n - 1].side][a];
    return ADCGS_OK;
}

adcgs_status adcgs_members_grow(adcgs_track *t, const adcgs_layers *l, int frame, adcgs_error *error)
{
    const adcgs_cloud *c = &l->all[frame];
    adcgs_cloud own = {.p = NULL};
    adcgs_rigid back;
    uint8_t *mark = adcgs_alloc(NULL, c->n, 1, error);
    adcgs_status status = mark ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        count(t, l, frame, mark);
        drop(&t->model, SURE);
        spread(c, l->reach, mark);
        status = adcgs_cloud_init(&own, t->model.p, t->model.n, 1, 2 * t->model.pixel, error);
    }
    adcgs_rigid_inverse(&t->place[frame].at, &back);
    for (uint32_t i = 0; i < c->n && status == ADCGS_OK; i++)
        if (mark[i]) {
            status = add_point(t, l, frame, i, &back, &own, error);
            own.p = t->model.p; /* the array may have been reallocated */
        }
    adcgs_cloud_clear(&own);
    adcgs_free(NULL, mark);
    return status;
}

void adcgs_members_clean(adcgs_track *t, const adcgs_layers *l)
{
    for (uint32_t i = 0; i < t->model.n; i++)
        t->model.more[i].seen = t->model.more[i].agreed = 0;
    for (int m = 0; m < l->n; m++)
        if (t->known[m])
            count(t, l, m, NULL);
    drop(&t->model, 1);
}
