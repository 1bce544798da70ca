/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Detection of cameras with a wrong pose. */
#include "init/pose_outlier.h"

#include "init/correspondence.h"
#include "init/resect.h"
#include "system/sort_values.h"

#include <math.h>

/*
 * Origin: chosen by hand, and checked on 40 generated scenes and four others without errors, in which no camera is reported, and
 * on scenes with one wrong camera: table "One camera" in doc/log/stability.md.
 */
enum { SOURCES = 6 };                          /* maximum number of source cameras per camera, the nearest first */
enum { SEARCH_RADIUS_PX = 12 };                /* pixels: search radius around a point's expected position */
enum { FULL_SEARCH_POINTS = 640 };             /* approximate number of points for the search over the whole image */
enum { INLIERS_TO_CHECK = 6 };                 /* minimum number of correspondences to check a given pose */
enum { INLIERS_TO_REPORT = 16 };               /* minimum number of correspondences to report another pose */
enum { CONFIRMED_MIN = 4 };                    /* minimum number of cameras whose pose is confirmed */
#define CONFIRMED_SHARE_MIN 0.6                /* minimum share of them among all cameras; else no single camera is at fault */
#define AXES_COSINE_MIN 0.6                    /* cosine: minimum alignment of the axes of compared cameras */
#define BASELINE_MIN 0.005                     /* scene units: minimum distance between them */
#define INLIER_ERROR_MAX_PX 1.0                /* pixels: maximum reprojection error of an inlier */
#define POSE_ERROR_MIN_PX 0.7                  /* pixels: minimum pose error of an outlier, images of 28,000 pixels */
#define POSE_ERROR_RATIO_MIN 4.0               /* minimum ratio of the pose error to the median over cameras */
#define INLIER_RATIO_MIN 2.0                   /* minimum ratio of inliers under the fitted pose to those under the given pose */
#define DEGREES (180 / 3.14159265358979323846) /* per radian; geometry */

/** State of a camera. */
typedef struct camera_residual {
    uint32_t view;         /* index of its first training view */
    adcgs_stereo_view fit; /* the fitted pose */
    int given, fitted;     /* inliers of the given pose and of the fitted pose */
    double off;            /* pixels: median distance between the inliers' positions under the two poses; NaN: unknown */
    double distance;       /* median distance of these points */
    int trusted;           /* 1: serves as a source for others */
    int reported;
} camera_residual;

typedef struct pose_check {
    int n, anywhere; /* number of cameras; 1: points are searched in the whole image */
    adcgs_stereo_view given[ADCGS_STEREO_CAMERAS];
    adcgs_patch_image image[ADCGS_STEREO_CAMERAS];
    camera_residual camera[ADCGS_STEREO_CAMERAS];
    int queried[ADCGS_STEREO_CAMERAS], n_queried; /* the cameras to check */
    adcgs_error error[ADCGS_STEREO_CAMERAS];
} pose_check;

/* ---- One camera ---- */

/** Chooses the nearest trusted sources with a similar viewing direction to `pose`, a pose of camera c. */
static int choose_sources(const pose_check *r, int c, const adcgs_stereo_view *pose, int sources[SOURCES])
{
    double far[SOURCES];
    int n = 0;
    for (int i = 0; i < r->n; i++) {
        const double d = adcgs_stereo_baseline(pose, &r->given[i]);
        int k = n < SOURCES ? n : SOURCES - 1;
        if (i == c || !r->camera[i].trusted || d < BASELINE_MIN || adcgs_stereo_axes_dot(pose, &r->given[i]) < AXES_COSINE_MIN ||
            (n == SOURCES && d >= far[k]))
            continue;
        for (n = ADCGS_MIN(n + 1, SOURCES); k > 0 && far[k - 1] > d; k--) {
            far[k] = far[k - 1];
            sources[k] = sources[k - 1];
        }
        far[k] = d;
        sources[k] = i;
    }
    return n;
}

static void match_near_pose(const pose_check *r, int c, const adcgs_stereo_view *pose, adcgs_correspondences *s, float *alike)
{
    int sources[SOURCES];
    const int n = choose_sources(r, c, pose, sources);
    s->n = 0;
    for (int k = 0; k < n; k++)
        adcgs_correspondences_add(s, &r->image[c], pose, &r->image[sources[k]], sources[k], 1, SEARCH_RADIUS_PX, alike);
}

static void match_whole_image(const pose_check *r, int c, adcgs_correspondences *s, float *alike)
{
    int keypoints = 0;
    for (int i = 0; i < r->n; i++)
        keypoints += r->camera[i].trusted ? r->image[i].n_keypoints : 0;
    s->n = 0;
    for (int i = 0; i < r->n; i++)
        if (i != c && r->camera[i].trusted)
            adcgs_correspondences_add(s, &r->image[c], &r->given[c], &r->image[i], i, keypoints / FULL_SEARCH_POINTS + 1, 0,
                                      alike);
}

static double median(double *values, int n)
{
    adcgs_sort(values, (size_t)n);
    return n ? values[n / 2] : (double)NAN;
}

/** Distance in pixels between the positions of a point in two views. View b shows the point. */
static double displacement(const adcgs_stereo_view *a, const adcgs_stereo_view *b, const double x[3])
{
    double depth, at[2];
    adcgs_correspondence there;
    adcgs_stereo_rig_project(b, x, at, &depth);
    memcpy(there.at, at, sizeof at);
    memcpy(there.x, x, sizeof there.x);
    return adcgs_reprojection_error(a, &there);
}

/** Compares the given pose with the fitted pose on the correspondences. */
static void compare_poses(camera_residual *c, const adcgs_stereo_view *given, const adcgs_correspondences *s)
{
    double offs[ADCGS_CORRESPONDENCES_MAX], far[ADCGS_CORRESPONDENCES_MAX];
    int n = 0;
    c->given = adcgs_correspondences_count_inliers(given, s, INLIER_ERROR_MAX_PX);
    c->fitted = adcgs_correspondences_count_inliers(&c->fit, s, INLIER_ERROR_MAX_PX);
    for (int i = 0; i < s->n; i++)
        if (adcgs_reprojection_error(&c->fit, &s->match[i]) < INLIER_ERROR_MAX_PX) {
            double square = 0;
            for (int a = 0; a < 3; a++)
                square += pow(s->match[i].x[a] - c->fit.centre[a], 2);
            offs[n] = displacement(given, &c->fit, s->match[i].x);
            far[n++] = sqrt(square);
        }
    c->distance = median(far, n);
    c->off = n >= INLIERS_TO_CHECK ? median(offs, n) : (double)NAN;
}

static void judge_one(void *arg, int index, int thread)
{
    pose_check *r = arg;
    const int c = r->queried[index];
    const adcgs_stereo_view *const given = &r->given[c];
    camera_residual *const camera = &r->camera[c];
    adcgs_correspondences *s = adcgs_alloc(NULL, 1, sizeof *s, &r->error[c]);
    float *alike = adcgs_alloc(NULL, (size_t)given->w * (size_t)given->h, sizeof *alike, &r->error[c]);
    (void)thread;
    if (s && alike) {
        camera->fit = *given;
        if (r->anywhere) {
            match_whole_image(r, c, s, alike);
            adcgs_resect_anywhere(&camera->fit, s, r->given, (uint64_t)c);
        }
        for (int again = 0; again < 2; again++) {
            match_near_pose(r, c, &camera->fit, s, alike);
            adcgs_resect(&camera->fit, s, SEARCH_RADIUS_PX);
        }
        compare_poses(camera, given, s);
    }
    adcgs_free(NULL, s);
    adcgs_free(NULL, alike);
}

/* ---- All cameras ---- */

/** Median pose error over cameras, in pixels; NaN if none is known. */
static double typical_error(const pose_check *r)
{
    double offs[ADCGS_STEREO_CAMERAS];
    int n = 0;
    for (int i = 0; i < r->n; i++)
        if (!isnan(r->camera[i].off))
            offs[n++] = r->camera[i].off;
    return median(offs, n);
}

static int agrees(const camera_residual *c, double typical)
{
    return c->off < fmax(POSE_ERROR_MIN_PX, POSE_ERROR_RATIO_MIN * typical);
}

/**
 * Selects the cameras that disagree for another check against the trusted cameras only. Returns 0 if all agree or too few are
 * trusted.
 */
static int recheck(pose_check *r, double typical)
{
    int well = 0;
    r->n_queried = 0;
    for (int i = 0; i < r->n; i++) {
        r->camera[i].trusted = agrees(&r->camera[i], typical);
        well += r->camera[i].trusted;
        if (!r->camera[i].trusted && !r->camera[i].reported)
            r->queried[r->n_queried++] = i;
    }
    return r->n_queried && well >= CONFIRMED_MIN && well >= CONFIRMED_SHARE_MIN * r->n;
}

static adcgs_status run(pose_check *r, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_pool_run(pool, judge_one, r, r->n_queried);
    return adcgs_stereo_first_failure(r->error, r->n, error);
}

static void report_outlier(adcgs_stereo *out, pose_check *r, int c)
{
    camera_residual *const s = &r->camera[c];
    const double moved = adcgs_stereo_baseline(&s->fit, &r->given[c]) / s->distance;
    double trace = 0;
    if (out->n_outliers == ADCGS_POSE_OUTLIERS_MAX)
        return;
    s->reported = 1;
    for (int k = 0; k < 9; k++)
        trace += s->fit.rotation[k] * r->given[c].rotation[k];
    const double turned = acos(fmin(fmax(0.5 * (trace - 1), -1), 1)) * DEGREES;
    out->outlier[out->n_outliers++] = (adcgs_pose_outlier){s->view, s->off, turned, moved};
}

static adcgs_status find(adcgs_stereo *out, pose_check *r, adcgs_pool *pool, adcgs_error *error)
{
    for (int i = 0; i < r->n; i++) {
        r->camera[i].trusted = 1;
        r->queried[r->n_queried++] = i;
    }
    ADCGS_TRY(run(r, pool, error));
    const double typical = typical_error(r);
    for (r->anywhere = 0; r->anywhere < 2; r->anywhere++) {
        if (!recheck(r, typical))
            return ADCGS_OK;
        ADCGS_TRY(run(r, pool, error));
        for (int k = 0; k < r->n_queried; k++) {
            const camera_residual *const s = &r->camera[r->queried[k]];
            if (s->fitted >= INLIERS_TO_REPORT && s->fitted >= INLIER_RATIO_MIN * s->given && !agrees(s, typical))
                report_outlier(out, r, r->queried[k]);
        }
    }
    return ADCGS_OK;
}

adcgs_status adcgs_stereo_find_pose_outliers(adcgs_stereo *out, const adcgs_stereo_rig *rig, const adcgs_depths *depths,
                                             adcgs_pool *pool, adcgs_error *error)
{
    pose_check *r = adcgs_alloc(NULL, 1, sizeof *r, error);
    adcgs_status status = r ? ADCGS_OK : adcgs_alloc_status(error);
    for (int c = 0; c < rig->n_cameras && status == ADCGS_OK; c++) {
        const adcgs_stereo_camera *const camera = &rig->camera[c];
        if (!camera->background)
            continue;
        r->given[r->n] = camera->view;
        r->camera[r->n].view = camera->first;
        status = adcgs_patch_image_init(&r->image[r->n], &camera->view, camera->unstable, &depths[r->n], error);
        r->n++;
    }
    if (status == ADCGS_OK && r->n > CONFIRMED_MIN)
        status = find(out, r, pool, error);
    for (int i = 0; r && i < r->n; i++)
        adcgs_patch_image_clear(&r->image[i]);
    adcgs_free(NULL, r);
    return status;
}
