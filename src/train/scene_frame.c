/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Coordinate system of the scene. */
#include "train/scene_frame.h"

#include "geometry/rotation.h"
#include "scene/extent.h"
#include "system/median.h"
#include "system/sort_values.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    CAMERAS_MOST = 64,  /* maximum number of training cameras whose median depth is used */
    POINTS_MOST = 2000, /* maximum number of points tested per camera */
    SEEN_LEAST = 8      /* minimum number of visible points for a median depth */
};
static const double
    /* Minimum share of the training cameras that have the focus of their axes in front; chosen by hand, not measured. */
    IN_FRONT = 0.75,
    /*
     * Bounds of the focus's depth relative to the median depth of the points that a camera sees, median over cameras. Five
     * inward captures, on which these are calibrated, have 1.04 to 1.21.
     */
    NEAR = 0.4, FAR = 2.5;
/*
 * Cameras that look outwards are closer to their focus than to anything else. So the unit is at least this share of the depth;
 * chosen by hand, not measured.
 */
static const double UNIT_LEAST = 0.4;
/* Length of the mean of unit vectors above which cameras share a viewing direction; chosen by hand, not measured. */
static const double SAME_WAY = 0.3;

/** Median depth along the axis of the points that each camera sees. */
typedef struct gaze {
    uint32_t n; /**< cameras that see points */
    uint32_t view[CAMERAS_MOST];
    double depth[CAMERAS_MOST]; /**< world units, > 0 */
} gaze;

/** Solves the symmetric 3x3 system a x = b by Cramer's rule. Returns 0 if it is singular. */
static int solve3(const double a[9], const double b[3], double x[3])
{
    const double c0 = a[4] * a[8] - a[5] * a[7], c1 = a[5] * a[6] - a[3] * a[8], c2 = a[3] * a[7] - a[4] * a[6];
    const double det = a[0] * c0 + a[1] * c1 + a[2] * c2;
    if (fabs(det) < 1e-9)
        return 0;
    x[0] = (b[0] * c0 + b[1] * (a[2] * a[7] - a[1] * a[8]) + b[2] * (a[1] * a[5] - a[2] * a[4])) / det;
    x[1] = (b[0] * c1 + b[1] * (a[0] * a[8] - a[2] * a[6]) + b[2] * (a[2] * a[3] - a[0] * a[5])) / det;
    x[2] = (b[0] * c2 + b[1] * (a[1] * a[6] - a[0] * a[7]) + b[2] * (a[0] * a[4] - a[1] * a[3])) / det;
    return 1;
}

/** The point nearest to all optical axes in the least-squares sense. Returns 0 if the axes are parallel. */
static int nearest_to_axes(const adcgs_scene *scene, double focus[3])
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    double a[9] = {0}, b[3] = {0};
    for (uint32_t v = 0; v < n; v++) {
        const double *m = scene->views[ADCGS_SPLIT_TRAIN][v].camera.cam_to_world;
        const double d[3] = {m[2], m[6], m[10]}, c[3] = {m[3], m[7], m[11]};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                const double p = (i == j) - d[i] * d[j];
                a[i * 3 + j] += p / n;
                b[i] += p * c[j] / n;
            }
    }
    return solve3(a, b, focus);
}

/** Depth of a point along the axis of a training camera. */
static double depth_of(const adcgs_scene *scene, uint32_t view, const double x[3])
{
    const double *m = scene->views[ADCGS_SPLIT_TRAIN][view].camera.cam_to_world;
    return (x[0] - m[3]) * m[2] + (x[1] - m[7]) * m[6] + (x[2] - m[11]) * m[10];
}

/** Median depth of the scene's points that a training camera sees; 0 if it sees too few. room: for POINTS_MOST values. */
static double median_depth(const adcgs_scene *scene, uint32_t view, double *room)
{
    const adcgs_camera *camera = &scene->views[ADCGS_SPLIT_TRAIN][view].camera;
    const uint32_t all = scene->points.n, n = ADCGS_MIN(all, POINTS_MOST);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < n; i++) {
        const uint64_t from = (uint64_t)i * all / n;
        double x[3], at[2];
        for (int a = 0; a < 3; a++)
            x[a] = (double)scene->points.position[from][a];
        if (adcgs_camera_sees(camera, x, camera->near_plane, at))
            room[seen++] = depth_of(scene, view, x);
    }
    adcgs_sort(room, seen);
    return seen >= SEEN_LEAST ? room[seen / 2] : 0;
}

static adcgs_status take_gaze(gaze *g, const adcgs_scene *scene, adcgs_error *error)
{
    const uint32_t all = scene->n_views[ADCGS_SPLIT_TRAIN], n = ADCGS_MIN(all, CAMERAS_MOST);
    g->n = 0;
    if (scene->points.n < SEEN_LEAST)
        return ADCGS_OK;
    double *room = adcgs_alloc(NULL, POINTS_MOST, sizeof *room, error);
    if (!room)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t view = (uint32_t)((uint64_t)i * all / n);
        const double depth = median_depth(scene, view, room);
        if (depth > 0) {
            g->view[g->n] = view;
            g->depth[g->n++] = depth;
        }
    }
    adcgs_free(NULL, room);
    return ADCGS_OK;
}

/** True if most training cameras have the point in front, at about the depth of the points that they see. */
static int is_looked_at(const adcgs_scene *scene, const gaze *g, const double x[3])
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    double ratio[CAMERAS_MOST];
    uint32_t in_front = 0;
    for (uint32_t v = 0; v < n; v++)
        in_front += depth_of(scene, v, x) > 0;
    if (in_front < IN_FRONT * n)
        return 0;
    for (uint32_t i = 0; i < g->n; i++)
        ratio[i] = depth_of(scene, g->view[i], x) / g->depth[i];
    const double usual = g->n ? adcgs_median(ratio, g->n) : 1;
    return usual >= NEAR && usual <= FAR;
}

/** Median per axis of the points at each camera's median depth. */
static void middle_of_gaze(const adcgs_scene *scene, const gaze *g, double focus[3])
{
    double at[CAMERAS_MOST];
    for (int a = 0; a < 3; a++) {
        for (uint32_t i = 0; i < g->n; i++) {
            const double *m = scene->views[ADCGS_SPLIT_TRAIN][g->view[i]].camera.cam_to_world;
            at[i] = m[4 * a + 3] + g->depth[i] * m[4 * a + 2];
        }
        focus[a] = adcgs_median(at, g->n);
    }
}

/** Focus in front of the mean camera. For cameras that look in all directions, it is their centroid. */
static void before_cameras(const adcgs_scene *scene, double extent, double focus[3])
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    double axis[3] = {0}, length = 0;
    for (int a = 0; a < 3; a++) {
        focus[a] = 0;
        for (uint32_t v = 0; v < n; v++) {
            const double *m = scene->views[ADCGS_SPLIT_TRAIN][v].camera.cam_to_world;
            axis[a] += m[4 * a + 2] / n;
            focus[a] += m[4 * a + 3] / n;
        }
        length += axis[a] * axis[a];
    }
    length = sqrt(length);
    for (int a = 0; length > SAME_WAY && a < 3; a++)
        focus[a] += extent * axis[a] / length;
}

/** Median distance of the training cameras from the origin, or UNIT_LEAST of the median depth if that is larger. */
static adcgs_status find_scale(const adcgs_scene *scene, gaze *g, double extent, const double origin[3], double *scale,
                               adcgs_error *error)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    double *distance = adcgs_alloc(NULL, n, sizeof *distance, error);
    if (!distance)
        return adcgs_alloc_status(error);
    for (uint32_t v = 0; v < n; v++) {
        const double *m = scene->views[ADCGS_SPLIT_TRAIN][v].camera.cam_to_world;
        const double d[3] = {m[3] - origin[0], m[7] - origin[1], m[11] - origin[2]};
        distance[v] = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    }
    const double usual = adcgs_median(distance, n), least = g->n ? UNIT_LEAST * adcgs_median(g->depth, g->n) : 0;
    adcgs_free(NULL, distance);
    *scale = usual > ADCGS_EXTENT_NOTHING * extent ? usual : extent; /* all cameras may be in one position */
    *scale = fmax(*scale, least);
    return ADCGS_OK;
}

adcgs_status adcgs_scene_frame(const adcgs_scene *part, double origin[3], double *scale, adcgs_error *error)
{
    const adcgs_scene *scene = part->whole ? part->whole : part;
    double extent;
    gaze g;
    if (scene->scale > 0) {
        memcpy(origin, scene->origin, sizeof scene->origin);
        *scale = scene->scale;
        return ADCGS_OK;
    }
    ADCGS_TRY(adcgs_scene_extent(scene, &extent, error));
    ADCGS_TRY(take_gaze(&g, scene, error));
    if (!nearest_to_axes(scene, origin) || !is_looked_at(scene, &g, origin)) {
        if (g.n)
            middle_of_gaze(scene, &g, origin);
        else
            before_cameras(scene, extent, origin);
    }
    return find_scale(scene, &g, extent, origin, scale, error);
}
