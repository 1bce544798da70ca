/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Check whether camera poses follow the expected axis convention. */
#include "check/axes.h"

#include "geometry/rotation.h"
#include "init/pose_error.h"
#include "scene/pose_check.h"

#include <math.h>

/*
 * Median error of correct poses on test scenes: 0.06 pixels, with few distant cameras 0.17. With pose errors of 1 pixel: 1. FITS
 * is calibrated on generated scenes with and without such errors and on four others (doc/log/stability.md, "Warning about errors
 * common to all poses"). The other constants are chosen by hand, not measured. They are checked on cameras around a ball, in a
 * room, and in a row (tests/unit/check/test_axes).
 */
#define FITS 0.4      /* pixels: median error of poses that fit the images */
#define FITS_WELL 0.2 /* pixels: median error below which no other reading is tried */
enum {
    POINTS_LEAST = 100, /* minimum number of points for a test */
    POINTS_MOST = 4000, /* maximum number of points that are tested */
    VIEWS_MOST = 200    /* maximum number of views that are tested */
};
#define SEEN_WELL 0.2    /* share of the points that a camera sees on average, from which the given poses are accepted */
#define SEEN_ENOUGH 0.05 /* share that confirms the given poses; low, since a camera in a room sees few points of it */
#define SEEN_BETTER 3.0  /* minimum ratio of the share under another reading to the share as given */
#define SEEN_MORE 0.3    /* minimum increase of that share */
enum { FRAMES = 12 };    /* maximum number of frames whose images are compared */
#define MOST_OF 0.9      /* share of the cameras that must face the common point */
#define AROUND 0.9       /* length of the mean axis; above it, all cameras look in nearly one direction and share no target */
#define CROSSED 0.2      /* mean distance of the axes from the common point, relative to the mean distance of the cameras */
#define ONE_PLACE 0.02   /* spread of the camera centres, relative to the distance of the point that they would look at */

/* ---- Readings ---- */

/** Copies the scene with the poses of its training views converted from `reading`. The caller frees the views. */
static adcgs_status read_as(adcgs_scene *out, const adcgs_scene *scene, adcgs_axes_reading reading, adcgs_error *error)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    adcgs_scene_view *views = adcgs_alloc(NULL, n, sizeof *views, error);
    *out = *scene;
    out->views[ADCGS_SPLIT_TRAIN] = views;
    if (!views)
        return adcgs_alloc_status(error);
    memcpy(views, scene->views[ADCGS_SPLIT_TRAIN], n * sizeof *views);
    for (uint32_t i = 0; i < n; i++) {
        double *const pose = views[i].camera.cam_to_world;
        if (reading == ADCGS_READ_TURNED || reading == ADCGS_READ_INVERSE_OPENGL)
            adcgs_pose_other_axes(pose);
        if (reading == ADCGS_READ_INVERSE || reading == ADCGS_READ_INVERSE_OPENGL)
            adcgs_pose_invert(pose);
        if (reading == ADCGS_READ_INVERSE_OPENGL)
            adcgs_pose_other_axes(pose);
    }
    return ADCGS_OK;
}

/* ---- Points ---- */

/** Mean share of the points that a camera sees. */
static double share_seen(const adcgs_scene *scene)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN], views = ADCGS_MIN(n, VIEWS_MOST);
    const uint32_t points = ADCGS_MIN(scene->points.n, POINTS_MOST);
    uint64_t seen = 0;
    for (uint32_t i = 0; i < views; i++)
        for (uint32_t k = 0; k < points; k++) {
            const double *const point = scene->points.position[(uint64_t)k * scene->points.n / points];
            double at[2];
            seen += (uint64_t)adcgs_camera_sees(&scene->views[ADCGS_SPLIT_TRAIN][(uint64_t)i * n / views].camera, point, 0.0, at);
        }
    return (double)seen / ((double)views * points);
}

/* ---- Camera placement ---- */

/** Positions and directions of the cameras. */
typedef struct places {
    double before;   /**< share of the cameras that face the point common to all axes */
    double axis;     /**< length of the mean axis; 1 if all cameras look in the same direction */
    double distance; /**< mean distance of the cameras from that point */
    double crossed;  /**< mean distance of the axes from that point, relative to `distance` */
    double apart;    /**< mean distance of the cameras from their centroid */
} places;

static places find_places(const adcgs_scene *scene)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    const adcgs_scene_view *const views = scene->views[ADCGS_SPLIT_TRAIN];
    double centre[3], middle[3] = {0.0}, axis[3] = {0.0};
    places p = {.before = 0.0};
    adcgs_pose_centre(views, n, centre);
    for (uint32_t v = 0; v < n; v++)
        for (int a = 0; a < 3; a++) {
            middle[a] += views[v].camera.cam_to_world[4 * a + 3] / n;
            axis[a] += views[v].camera.cam_to_world[4 * a + 2] / n;
        }
    for (uint32_t v = 0; v < n; v++) {
        const double *m = views[v].camera.cam_to_world;
        double along = 0.0, square = 0.0, off = 0.0;
        for (int a = 0; a < 3; a++) {
            const double way = centre[a] - m[4 * a + 3];
            along += way * m[4 * a + 2];
            square += way * way;
            off += (m[4 * a + 3] - middle[a]) * (m[4 * a + 3] - middle[a]);
        }
        p.before += (along > 0.0) / (double)n;
        p.distance += sqrt(square) / n;
        p.crossed += sqrt(fmax(square - along * along, 0.0)) / n;
        p.apart += sqrt(off) / n;
    }
    p.crossed /= fmax(p.distance, 1e-300);
    p.axis = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    return p;
}

/** True if the cameras surround a point that they look at. */
static int look_in(const places *p)
{
    return p->before >= MOST_OF && p->axis < AROUND && p->crossed < CROSSED;
}

static adcgs_axes_reading judge_places(const places p[ADCGS_READINGS])
{
    if (look_in(&p[ADCGS_READ_TURNED]) && !look_in(&p[ADCGS_READ_AS_GIVEN]))
        return ADCGS_READ_TURNED;
    /* For cameras on a circle around the world origin, the world-to-camera translation is the same for all. */
    for (int r = ADCGS_READ_INVERSE; r < ADCGS_READINGS; r++)
        if (look_in(&p[r]) && p[ADCGS_READ_AS_GIVEN].apart < ONE_PLACE * p[r].distance)
            return (adcgs_axes_reading)r;
    return ADCGS_READ_AS_GIVEN;
}

/* ---- Images ---- */

int adcgs_stereo_poses_fit(const adcgs_stereo_pose_error *off)
{
    return off->pairs >= ADCGS_STEREO_PAIRS && off->median < FITS;
}

/** True if more cameras fit where the old poses do not fit, or as many cameras fit with less than half the error. */
static int is_better(const adcgs_stereo_pose_error *off, const adcgs_stereo_pose_error *than)
{
    if (!adcgs_stereo_poses_fit(than))
        return adcgs_stereo_poses_fit(off) && off->pairs > than->pairs;
    return off->pairs >= than->pairs && off->median < 0.5 * than->median;
}

/** Measures pose errors from the images of a few frames. */
static adcgs_status match_pairs(adcgs_stereo_pose_error *out, const adcgs_scene *scene, const places *p, adcgs_pool *pool,
                                adcgs_error *error)
{
    adcgs_stereo_options options = {.frames = FRAMES, .scale = fmax(p->distance, 1e-300)};
    adcgs_stereo_rig *rig = adcgs_alloc(NULL, 1, sizeof *rig, error);
    *out = (adcgs_stereo_pose_error){.pairs = 0};
    if (!rig)
        return adcgs_alloc_status(error);
    adcgs_pose_centre(scene->views[ADCGS_SPLIT_TRAIN], scene->n_views[ADCGS_SPLIT_TRAIN], options.origin);
    adcgs_status status = adcgs_stereo_rig_init(rig, scene, &options, error);
    if (status == ADCGS_OK)
        status = adcgs_stereo_measure_pose_error(rig, out, pool, error);
    adcgs_stereo_rig_clear(rig);
    adcgs_free(NULL, rig);
    return status;
}

/* ---- Decision ---- */

static void judge_points(adcgs_axes_check *out, const double seen[ADCGS_READINGS])
{
    adcgs_axes_reading best = ADCGS_READ_AS_GIVEN;
    for (int r = ADCGS_READ_TURNED; r < ADCGS_READINGS; r++)
        best = seen[r] > seen[best] ? (adcgs_axes_reading)r : best;
    if (seen[ADCGS_READ_AS_GIVEN] < SEEN_WELL && seen[best] >= SEEN_BETTER * seen[ADCGS_READ_AS_GIVEN] &&
        seen[best] >= seen[ADCGS_READ_AS_GIVEN] + SEEN_MORE)
        *out = (adcgs_axes_check){best, ADCGS_BY_POINTS, seen[ADCGS_READ_AS_GIVEN], seen[best]};
}

static adcgs_status judge_pictures(adcgs_axes_check *out, const adcgs_scene readings[ADCGS_READINGS], const places *p,
                                   const adcgs_stereo_pose_error *given, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_stereo_pose_error best = *given;
    for (int r = ADCGS_READ_TURNED; r < ADCGS_READINGS; r++) {
        adcgs_stereo_pose_error off;
        ADCGS_TRY(match_pairs(&off, &readings[r], &p[r], pool, error));
        if (!is_better(&off, &best))
            continue;
        *out = (adcgs_axes_check){.meant = (adcgs_axes_reading)r, .by = ADCGS_BY_IMAGES};
        best = off;
    }
    return ADCGS_OK;
}

static adcgs_status judge(adcgs_axes_check *out, const adcgs_scene readings[ADCGS_READINGS], const adcgs_stereo *found,
                          adcgs_pool *pool, adcgs_error *error)
{
    const adcgs_stereo_pose_error *const off = &found->poses;
    double seen[ADCGS_READINGS] = {0.0};
    places p[ADCGS_READINGS];
    for (int r = 0; r < ADCGS_READINGS && readings->points.n >= POINTS_LEAST; r++)
        seen[r] = share_seen(&readings[r]);
    judge_points(out, seen);
    const int vouched = seen[ADCGS_READ_AS_GIVEN] >= SEEN_ENOUGH && off->pairs < ADCGS_STEREO_PAIRS; /* and no image objects */
    if (out->meant != ADCGS_READ_AS_GIVEN || vouched ||
        (found->n_frames && adcgs_stereo_poses_fit(off) && off->median < FITS_WELL))
        return ADCGS_OK;
    for (int r = 0; r < ADCGS_READINGS; r++)
        p[r] = find_places(&readings[r]);
    if (found->n_frames)
        ADCGS_TRY(judge_pictures(out, readings, p, off, pool, error));
    if (out->meant == ADCGS_READ_AS_GIVEN && seen[ADCGS_READ_AS_GIVEN] < SEEN_ENOUGH && !adcgs_stereo_poses_fit(off))
        *out = (adcgs_axes_check){.meant = judge_places(p), .by = ADCGS_BY_PLACES};
    return ADCGS_OK;
}

adcgs_status adcgs_axes_check_run(adcgs_axes_check *out, const adcgs_scene *scene, const adcgs_stereo *found, adcgs_pool *pool,
                                  adcgs_error *error)
{
    adcgs_scene readings[ADCGS_READINGS] = {{.directory = NULL}};
    adcgs_status status = ADCGS_OK;
    *out = (adcgs_axes_check){.meant = ADCGS_READ_AS_GIVEN};
    for (int r = 0; r < ADCGS_READINGS && status == ADCGS_OK; r++)
        status = read_as(&readings[r], scene, (adcgs_axes_reading)r, error);
    if (status == ADCGS_OK && scene->n_views[ADCGS_SPLIT_TRAIN])
        status = judge(out, readings, found, pool, error);
    for (int r = 0; r < ADCGS_READINGS; r++)
        adcgs_free(NULL, readings[r].views[ADCGS_SPLIT_TRAIN]);
    return status;
}
