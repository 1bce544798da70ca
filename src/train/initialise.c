/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The first anchors. */
#include "train/initialise.h"

#include "fmodel/body_trajectories.h"
#include "geom/geom.h"
#include "init/rigid/body_pose.h"
#include "train/density/spacing.h"
#include "train/start_points.h"

#include <math.h>

static const double ALONE = 0.1; /* scene units: size of a single anchor; chosen by hand, not measured */
/* Scene units: minimum half edge of the cube around the points; chosen by hand, not measured. */
#define CUBE_LEAST 0.5
#define CUBE_MOST 8 /* scene units: its maximum; chosen by hand, not measured */
/* Half edge of the cube / distance of the farthest point, so that anchors can grow; chosen by hand, not measured. */
#define CUBE_MARGIN 1.25

/** Half edge of a cube around the points, scene units. */
static double cube_half(const adcgs_start_points *c)
{
    double half = CUBE_LEAST;
    for (uint32_t i = 0; i < c->n; i++)
        for (int a = 0; a < 3; a++)
            half = fmax(half, CUBE_MARGIN * fabs(c->x[i][a]));
    return fmin(half, CUBE_MOST);
}

void adcgs_set_lifetime(adcgs_fmodel *f, uint32_t i, const adcgs_stereo_point *p)
{
    *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, ADCGS_SPAN_MIDDLE) = 8 * (p->t + p->shift - 0.5f);
    *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, ADCGS_SPAN_PACE) = -logf(p->life);
    for (int a = 0; a < 3; a++)
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, ADCGS_SPAN_VELOCITY + a) = p->body ? 0 : 8 * p->velocity[a] * p->life;
}

/** spacing: mean distance to the nearest anchors, in voxels; 0 if there are none. */
static void set_anchor(adcgs_fmodel *f, uint32_t i, const double rgb[3], double spacing)
{
    const double d = fmin(fmax(f->n > 1 ? spacing * (double)f->voxel : ALONE, 2 * (double)f->voxel), 1.0);
    for (int a = 0; a < 3; a++) {
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, a) = (float)log(d);
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, 3 + a) = (float)log(d);
        *adcgs_fmodel_at(f, ADCGS_P_COLOUR, i, a) = (float)rgb[a];
    }
}

/** Extents of offsets and base scales from the splats that the point stands for; the sigmoid of the scales begins at one half. */
static void set_extents(adcgs_fmodel *f, uint32_t i, const adcgs_stereo_point *p)
{
    for (int a = 0; a < 3; a++) {
        if (p->spread[a] > 0)
            *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, a) = logf(fminf(fmaxf(p->spread[a], f->voxel), 1));
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, 3 + a) = logf(fminf(fmaxf(2 * p->extent[a], f->voxel), 1));
    }
}

/** Makes one anchor per occupied voxel, in Morton order. order[i]: the source point of anchor i. *anchors: their number. */
static adcgs_status voxelise(const adcgs_start_points *c, double half, int depth, uint32_t (*pos)[3], uint32_t *order,
                             uint32_t *anchors, adcgs_error *error)
{
    const double voxel = 2 * half / (double)(1u << depth);
    for (uint32_t i = 0; i < c->n; i++)
        for (int a = 0; a < 3; a++) {
            const double v = floor((c->x[i][a] + half) / voxel);
            pos[i][a] = (uint32_t)fmin(fmax(v, 0), (double)(1u << depth) - 1);
        }
    const int sorted = adcgs_morton_sort(&pos[0][0], c->n, order, error);
    if (sorted < 0)
        return (adcgs_status)sorted;
    uint32_t n = 0;
    for (uint32_t i = 0; i < c->n; i++) {
        if (n && !memcmp(pos[n - 1], pos[i], sizeof pos[i]))
            continue;
        memmove(pos[n], pos[i], sizeof pos[i]);
        order[n++] = order[i];
    }
    *anchors = n;
    return ADCGS_OK;
}

/**
 * Sets the lifetime from matching. Static points do not move. Points of a body live as long as the body. For other moving points,
 * neighbours live at other times.
 */
static void set_life(adcgs_fmodel *f, uint32_t i, const adcgs_stereo_point *p, float half)
{
    f->moving[i] = p->moves;
    f->body[i] = p->body;
    if (!p->moves || p->body)
        return;
    for (int a = 0; a < 6; a++)
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, i, a) -= 0.5f * logf(fminf(2 * half, 1));
    adcgs_set_lifetime(f, i, p);
}

static adcgs_status make_anchors(adcgs_fmodel **out, const adcgs_start_points *c, const adcgs_train_config *config,
                                 float half_life, adcgs_error *error)
{
    const double half = cube_half(c);
    const float origin[3] = {(float)-half, (float)-half, (float)-half};
    const float voxel = (float)(2 * half / (double)(1u << config->shape.depth));
    uint32_t(*pos)[3] = adcgs_alloc(NULL, c->n, sizeof *pos, error);
    uint32_t *order = adcgs_alloc(NULL, c->n, sizeof *order, error);
    double *spacing = adcgs_alloc(NULL, c->n, sizeof *spacing, error);
    uint32_t n = 0;
    adcgs_status status =
        pos && order && spacing ? voxelise(c, half, config->shape.depth, pos, order, &n, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        status = adcgs_spacings((const uint32_t(*)[3])pos, n, spacing, error);
    if (status == ADCGS_OK)
        status = adcgs_fmodel_create(out, &config->params, &config->shape, origin, voxel, (const uint32_t(*)[3])pos, n,
                                     config->seed, error);
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++) {
        set_anchor(*out, i, c->rgb[order[i]], spacing[i]);
        if (c->matched[order[i]] && c->matched[order[i]]->extent[0] > 0)
            set_extents(*out, i, c->matched[order[i]]);
        if (config->params.spans && c->matched[order[i]])
            set_life(*out, i, c->matched[order[i]], half_life);
    }
    adcgs_free(NULL, pos);
    adcgs_free(NULL, order);
    adcgs_free(NULL, spacing);
    return status;
}

void adcgs_set_poses(adcgs_fmodel *f, const adcgs_stereo *found)
{
    const int rows = f->params.time_rows;
    adcgs_bodies_recentre(f);
    for (int b = 1; b <= (int)found->n_bodies; b++) /* others, which only other segments have, stay at rest */
        for (int row = 0; found->body[b - 1].pose && row < rows; row++) {
            const float t = rows > 1 ? (float)row / (float)(rows - 1) : 0;
            const adcgs_stereo_pose pose = adcgs_stereo_pose_at(found, (uint32_t)b - 1, t);
            adcgs_bodies_set_pose(f, b, row, pose.q, found->body[b - 1].pivot, pose.way);
        }
}

adcgs_status adcgs_initialise(adcgs_fmodel **out, const adcgs_scene *scene, const adcgs_train_config *config,
                              const adcgs_stereo *found, adcgs_error *error)
{
    adcgs_start_points points;
    adcgs_status status = adcgs_start_points_find(&points, scene, config, found, error);
    if (status == ADCGS_OK)
        status = make_anchors(out, &points, config, adcgs_half_lifetime(config, found), error);
    if (status == ADCGS_OK)
        adcgs_set_poses(*out, found);
    adcgs_start_points_clear(&points);
    return status;
}
