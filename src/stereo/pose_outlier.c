/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Detection of cameras with a wrong pose. */
#include "stereo/pose_outlier.h"

#include "data/sort_values.h"
#include "stereo/correspondence.h"
#include "stereo/resect.h"

#include <math.h>

/*
 * Checked on 40 generated scenes and four others without errors, in which no camera is reported, and on scenes with one
 * wrong camera: table "One camera" in doc/log/stability.md.
 */
enum { SOURCES = 6 };        /* maximum number of source cameras per camera, the nearest first */
enum { REACH = 12 };         /* pixels: search radius around a point's expected position */
enum { ANYWHERE = 640 };     /* approximate number of points for the search over the whole image */
enum { SIGHTS_FEW = 6 };     /* minimum number of correspondences to check a given pose */
enum { SIGHTS_LEAST = 16 };  /* minimum number of correspondences to report another pose */
enum { WELL_LEAST = 4 };     /* minimum number of cameras whose pose is confirmed */
#define WELL_SHARE 0.6       /* minimum share of them among all cameras; else no single camera is at fault */
#define AXES_ALIKE 0.6       /* cosine: minimum alignment of the axes of compared cameras */
#define APART 0.005          /* scene units: minimum distance between them */
#define FITS 1.0             /* pixels: maximum reprojection error of an inlier */
#define OFF 0.7              /* pixels: minimum pose error of an outlier, images of 28,000 pixels */
#define TIMES_USUAL 4.0      /* minimum ratio of the pose error to the median over cameras */
#define BETTER 2.0           /* minimum ratio of inliers under the fitted pose to those under the given pose */
#define DEGREES (180 / 3.14159265358979323846)

/** State of a camera. */
typedef struct standing {
    uint32_t view;          /* index of its first training view */
    adcgs_stereo_view fit;  /* the fitted pose */
    int given, fitted;      /* inliers of the given pose and of the fitted pose */
    double off;             /* pixels: median distance between the inliers' positions under the two poses; NaN: unknown */
    double distance;        /* median distance of these points */
    int trusted;            /* 1: serves as a source for others */
    int named;
} standing;

typedef struct panel {
    int n, anywhere;        /* number of cameras; 1: points are searched in the whole image */
    adcgs_stereo_view given[ADCGS_STEREO_CAMERAS];
    adcgs_outlook look[ADCGS_STEREO_CAMERAS];
    standing camera[ADCGS_STEREO_CAMERAS];
    int asked[ADCGS_STEREO_CAMERAS], n_asked; /* the cameras to check */
    adcgs_error error[ADCGS_STEREO_CAMERAS];
} panel;

/* ---- One camera ---- */

/** Chooses the nearest trusted sources with a similar viewing direction to `pose`, a pose of camera c. */
static int choose_sources(const panel *r, int c, const adcgs_stereo_view *pose, int sources[SOURCES])
{
    double far[SOURCES];
    int n = 0;
    for (int i = 0; i < r->n; i++) {
        const double d = adcgs_stereo_apart(pose, &r->given[i]);
        int k = n < SOURCES ? n : SOURCES - 1;
        if (i == c || !r->camera[i].trusted || d < APART || adcgs_stereo_axes_dot(pose, &r->given[i]) < AXES_ALIKE ||
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

static void look_about(const panel *r, int c, const adcgs_stereo_view *pose, adcgs_sights *s, float *alike)
{
    int sources[SOURCES];
    const int n = choose_sources(r, c, pose, sources);
    s->n = 0;
    for (int k = 0; k < n; k++)
        adcgs_sights_add(s, &r->look[c], pose, &r->look[sources[k]], sources[k], 1, REACH, alike);
}

static void look_anywhere(const panel *r, int c, adcgs_sights *s, float *alike)
{
    int marks = 0;
    for (int i = 0; i < r->n; i++)
        marks += r->camera[i].trusted ? r->look[i].n_marks : 0;
    s->n = 0;
    for (int i = 0; i < r->n; i++)
        if (i != c && r->camera[i].trusted)
            adcgs_sights_add(s, &r->look[c], &r->given[c], &r->look[i], i, marks / ANYWHERE + 1, 0, alike);
}

static double middle(double *values, int n)
{
    adcgs_sort(values, (size_t)n);
    return n ? values[n / 2] : (double)NAN;
}

/** Distance in pixels between the positions of a point in two views. View b shows the point. */
static double between(const adcgs_stereo_view *a, const adcgs_stereo_view *b, const double x[3])
{
    double depth, at[2];
    adcgs_sight there;
    adcgs_stereo_rig_project(b, x, at, &depth);
    memcpy(there.at, at, sizeof at);
    memcpy(there.x, x, sizeof there.x);
    return adcgs_sight_off(a, &there);
}

/** Compares the given pose with the fitted pose on the correspondences. */
static void judge(standing *c, const adcgs_stereo_view *given, const adcgs_sights *s)
{
    double offs[ADCGS_SIGHTS], far[ADCGS_SIGHTS];
    int n = 0;
    c->given = adcgs_sights_near(given, s, FITS);
    c->fitted = adcgs_sights_near(&c->fit, s, FITS);
    for (int i = 0; i < s->n; i++)
        if (adcgs_sight_off(&c->fit, &s->sight[i]) < FITS) {
            double square = 0;
            for (int a = 0; a < 3; a++)
                square += pow(s->sight[i].x[a] - c->fit.centre[a], 2);
            offs[n] = between(given, &c->fit, s->sight[i].x);
            far[n++] = sqrt(square);
        }
    c->distance = middle(far, n);
    c->off = n >= SIGHTS_FEW ? middle(offs, n) : (double)NAN;
}

static void judge_one(void *arg, int index, int thread)
{
    panel *r = arg;
    const int c = r->asked[index];
    const adcgs_stereo_view *const given = &r->given[c];
    standing *const camera = &r->camera[c];
    adcgs_sights *s = adcgs_alloc(NULL, 1, sizeof *s, &r->error[c]);
    float *alike = adcgs_alloc(NULL, (size_t)given->w * (size_t)given->h, sizeof *alike, &r->error[c]);
    (void)thread;
    if (s && alike) {
        camera->fit = *given;
        if (r->anywhere) {
            look_anywhere(r, c, s, alike);
            adcgs_resect_anywhere(&camera->fit, s, r->given, (uint64_t)c);
        }
        for (int again = 0; again < 2; again++) {
            look_about(r, c, &camera->fit, s, alike);
            adcgs_resect(&camera->fit, s, REACH);
        }
        judge(camera, given, s);
    }
    adcgs_free(NULL, s);
    adcgs_free(NULL, alike);
}

/* ---- All cameras ---- */

/** Median pose error over cameras, in pixels; NaN if none is known. */
static double usual_off(const panel *r)
{
    double offs[ADCGS_STEREO_CAMERAS];
    int n = 0;
    for (int i = 0; i < r->n; i++)
        if (!isnan(r->camera[i].off))
            offs[n++] = r->camera[i].off;
    return middle(offs, n);
}

static int agrees(const standing *c, double usual)
{
    return c->off < fmax(OFF, TIMES_USUAL * usual);
}

/**
 * Selects the cameras that disagree for another check against the trusted cameras only. Returns 0 if all agree or too few are
 * trusted.
 */
static int ask_again(panel *r, double usual)
{
    int well = 0;
    r->n_asked = 0;
    for (int i = 0; i < r->n; i++) {
        r->camera[i].trusted = agrees(&r->camera[i], usual);
        well += r->camera[i].trusted;
        if (!r->camera[i].trusted && !r->camera[i].named)
            r->asked[r->n_asked++] = i;
    }
    return r->n_asked && well >= WELL_LEAST && well >= WELL_SHARE * r->n;
}

static adcgs_status run(panel *r, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_pool_run(pool, judge_one, r, r->n_asked);
    return adcgs_stereo_first_failure(r->error, r->n, error);
}

static void name_it(adcgs_stereo *out, panel *r, int c)
{
    standing *const s = &r->camera[c];
    const double moved = adcgs_stereo_apart(&s->fit, &r->given[c]) / s->distance;
    double trace = 0;
    if (out->n_odd == ADCGS_STEREO_ODD)
        return;
    s->named = 1;
    for (int k = 0; k < 9; k++)
        trace += s->fit.rotation[k] * r->given[c].rotation[k];
    const double turned = acos(fmin(fmax(0.5 * (trace - 1), -1), 1)) * DEGREES;
    out->odd[out->n_odd++] = (adcgs_stereo_odd){ s->view, s->off, turned, moved };
}

static adcgs_status find(adcgs_stereo *out, panel *r, adcgs_pool *pool, adcgs_error *error)
{
    for (int i = 0; i < r->n; i++) {
        r->camera[i].trusted = 1;
        r->asked[r->n_asked++] = i;
    }
    ADCGS_TRY(run(r, pool, error));
    const double usual = usual_off(r);
    for (r->anywhere = 0; r->anywhere < 2; r->anywhere++) {
        if (!ask_again(r, usual))
            return ADCGS_OK;
        ADCGS_TRY(run(r, pool, error));
        for (int k = 0; k < r->n_asked; k++) {
            const standing *const s = &r->camera[r->asked[k]];
            if (s->fitted >= SIGHTS_LEAST && s->fitted >= BETTER * s->given && !agrees(s, usual))
                name_it(out, r, r->asked[k]);
        }
    }
    return ADCGS_OK;
}

adcgs_status adcgs_stereo_find_odd(adcgs_stereo *out, const adcgs_stereo_rig *rig, const adcgs_depths *depths, adcgs_pool *pool,
                                   adcgs_error *error)
{
    panel *r = adcgs_alloc(NULL, 1, sizeof *r, error);
    adcgs_status status = r ? ADCGS_OK : adcgs_alloc_status(error);
    for (int c = 0; c < rig->n_cameras && status == ADCGS_OK; c++) {
        const adcgs_stereo_camera *const camera = &rig->camera[c];
        if (!camera->usual)
            continue;
        r->given[r->n] = camera->view;
        r->camera[r->n].view = camera->first;
        status = adcgs_outlook_init(&r->look[r->n], &camera->view, camera->changes, &depths[r->n], error);
        r->n++;
    }
    if (status == ADCGS_OK && r->n > WELL_LEAST)
        status = find(out, r, pool, error);
    for (int i = 0; r && i < r->n; i++)
        adcgs_outlook_clear(&r->look[i]);
    adcgs_free(NULL, r);
    return status;
}
