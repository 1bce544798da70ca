/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Static points, moving points, and free space. */
#include "init/stereo.h"

#include "init/fuse.h"
#include "init/hull.h"
#include "init/lifetimes.h"
#include "init/monocular.h"
#include "init/pose_error.h"
#include "init/pose_outlier.h"
#include "init/rigid/body_search.h"
#include "init/thin.h"
#include "init/velocities.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    REFERENCES = 4,    /* maximum number of views matched per frame */
    MOVING_LEAST = 24, /* minimum number of moving pixels in a view that is matched */
    MARGIN = 4         /* pixels around the moving ones that are matched, too */
};
/* Measured on rods and four scenes (doc/log/matching.md, "Thin structures are matched"). */
enum {
    MOST = 5, /* differing pixels of a 3x3 window that make its centre moving */
    LINE = 3  /* the same if the centre itself differs */
};
/* Chosen by hand, not measured. */
#define AXES_ALIKE 0.6  /* cosine: minimum alignment of the axes of matched views */
#define APART 0.005     /* scene units: minimum distance between views, for depth */
#define CAMERAS_AGREE 2 /* cameras that must show a static surface at a place */

struct adcgs_stereo_maps {
    int n;
    adcgs_stereo_view view[ADCGS_STEREO_CAMERAS];
    adcgs_depths depths[ADCGS_STEREO_CAMERAS];
    const uint8_t *unstable[ADCGS_STEREO_CAMERAS]; /* [h][w] of the rig, valid while the rig exists */
};

/* ---- Neighbours ---- */

/** The nearest views with a similar viewing direction. */
static void choose_sources(adcgs_sweep *s, const adcgs_stereo_view *views, int n, int own)
{
    double best[ADCGS_SWEEP_SOURCES];
    s->view = &views[own];
    s->n_sources = 0;
    for (int i = 0; i < n; i++) {
        const double d = adcgs_stereo_baseline(&views[own], &views[i]);
        if (i == own || d < APART || adcgs_stereo_axes_dot(&views[own], &views[i]) < AXES_ALIKE)
            continue;
        int k = s->n_sources;
        if (k == ADCGS_SWEEP_SOURCES && d >= best[k - 1])
            continue;
        if (k < ADCGS_SWEEP_SOURCES)
            s->n_sources++;
        else
            k--;
        for (; k > 0 && best[k - 1] > d; k--) {
            best[k] = best[k - 1];
            s->source[k] = s->source[k - 1];
        }
        best[k] = d;
        s->source[k] = &views[i];
    }
}

/* ---- Matching of simultaneous views ---- */

/** Views, the parts to match, and the results. */
typedef struct match {
    int n;
    adcgs_stereo_view *views;
    const int (*parts)[4]; /* [n] x, y, w, h; w 0: none */
    double nearest, farthest;
    adcgs_depths *depths; /* [n] */
    adcgs_error error[ADCGS_STEREO_CAMERAS];
} match;

static void match_one(void *arg, int i, int thread)
{
    match *m = arg;
    adcgs_sweep s = {.x = m->parts[i][0], .y = m->parts[i][1], .w = m->parts[i][2], .h = m->parts[i][3]};
    (void)thread;
    m->depths[i].view = &m->views[i];
    choose_sources(&s, m->views, m->n, i);
    if (!s.w || !s.n_sources)
        return;
    adcgs_sweep_set_planes(&s, m->nearest, m->farthest);
    (void)adcgs_depths_find(&m->depths[i], &s, &m->error[i]);
}

static adcgs_status match_all(match *m, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_pool_run(pool, match_one, m, m->n);
    return adcgs_stereo_first_failure(m->error, m->n, error);
}

/* ---- Static points ---- */

static adcgs_status find_still(adcgs_stereo *out, adcgs_stereo_list *list, const adcgs_stereo_rig *rig, adcgs_pool *pool,
                               adcgs_error *error)
{
    adcgs_stereo_maps *maps = out->maps;
    const uint8_t *wanted[ADCGS_STEREO_CAMERAS];
    uint8_t *still[ADCGS_STEREO_CAMERAS] = {NULL};
    int parts[ADCGS_STEREO_CAMERAS][4];
    adcgs_status status = ADCGS_OK;
    for (int c = 0; c < rig->n_cameras && status == ADCGS_OK; c++) {
        const adcgs_stereo_camera *camera = &rig->camera[c];
        if (!camera->background)
            continue;
        const size_t plane = (size_t)camera->view.w * (size_t)camera->view.h;
        const int i = maps->n++;
        maps->view[i] = camera->view;
        maps->unstable[i] = camera->unstable;
        memcpy(parts[i], (const int[]){0, 0, camera->view.w, camera->view.h}, sizeof parts[i]);
        wanted[i] = still[i] = adcgs_alloc(NULL, plane, 1, error);
        status = still[i] ? ADCGS_OK : adcgs_alloc_status(error);
        for (size_t k = 0; still[i] && k < plane; k++)
            still[i][k] = !camera->unstable[k];
    }
    match m = {.n = maps->n,
               .views = maps->view,
               .parts = (const int(*)[4])parts,
               .nearest = rig->nearest,
               .farthest = rig->farthest,
               .depths = maps->depths};
    const adcgs_stereo_point like = {.t = 0.5f};
    if (status == ADCGS_OK)
        status = match_all(&m, pool, error);
    if (status == ADCGS_OK)
        status = adcgs_fuse(list, maps->depths, maps->n, wanted, &like, error);
    for (int i = 0; i < maps->n; i++)
        adcgs_free(NULL, still[i]);
    return status;
}

/* ---- Moving points ---- */

/**
 * Marks moving pixels: most of the window, or a line through a differing pixel, differs from the background. Also marks pixels
 * whose window shows only background.
 */
static void mark(const adcgs_stereo_camera *c, int frame, uint8_t *off, uint8_t *moves, uint8_t *still, int part[4])
{
    const int w = c->view.w, h = c->view.h;
    int left = w, right = -1, top = h, bottom = -1, n = 0;
    for (int i = 0; i < w * h; i++)
        off[i] = (uint8_t)(c->frame[frame][4 * i + 3] && adcgs_stereo_rig_differs(c, frame, i));
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            int sum = 0;
            for (int b = ADCGS_MAX(y - 1, 0); b <= ADCGS_MIN(y + 1, h - 1); b++)
                for (int a = ADCGS_MAX(x - 1, 0); a <= ADCGS_MIN(x + 1, w - 1); a++)
                    sum += off[b * w + a];
            moves[y * w + x] = sum >= MOST || (off[y * w + x] && sum >= LINE);
            still[y * w + x] = !sum;
            if (!moves[y * w + x])
                continue;
            n++;
            left = ADCGS_MIN(left, x);
            right = ADCGS_MAX(right, x);
            top = ADCGS_MIN(top, y);
            bottom = ADCGS_MAX(bottom, y);
        }
    left = ADCGS_MAX(left - MARGIN, 0);
    top = ADCGS_MAX(top - MARGIN, 0);
    right = ADCGS_MIN(right + MARGIN, w - 1);
    bottom = ADCGS_MIN(bottom + MARGIN, h - 1);
    memcpy(part, (const int[]){left, top, n < MOVING_LEAST ? 0 : right - left + 1, bottom - top + 1}, 4 * sizeof *part);
}

/** Working memory of one frame. */
typedef struct frame_layer {
    adcgs_stereo_view view[ADCGS_STEREO_CAMERAS];
    int part[ADCGS_STEREO_CAMERAS][4];
    adcgs_depths depths[ADCGS_STEREO_CAMERAS];
    float *pixels[ADCGS_STEREO_CAMERAS];
    uint8_t *moves[ADCGS_STEREO_CAMERAS]; /* [3][h][w] the view's moves and still, and scratch */
    int n;
} frame_layer;

static adcgs_status read_frame(frame_layer *o, const adcgs_stereo_rig *rig, int m, adcgs_error *error)
{
    for (int c = 0; c < rig->n_cameras; c++) {
        const adcgs_stereo_camera *camera = &rig->camera[c];
        if (!camera->background || !camera->frame[m])
            continue;
        const size_t plane = (size_t)camera->view.w * (size_t)camera->view.h;
        const int i = o->n++;
        o->pixels[i] = adcgs_alloc(NULL, 4 * plane, sizeof(float), error);
        o->moves[i] = adcgs_alloc(NULL, 3 * plane, 1, error);
        if (!o->pixels[i] || !o->moves[i])
            return adcgs_alloc_status(error);
        adcgs_stereo_rig_get_frame(camera, m, o->pixels[i]);
        o->view[i] = camera->view;
        o->view[i].pixels = o->pixels[i];
        o->view[i].moves = o->moves[i];
        o->view[i].still = o->moves[i] + plane;
        mark(camera, m, o->moves[i] + 2 * plane, o->moves[i], o->moves[i] + plane, o->part[i]);
    }
    for (int i = 0; i < o->n; i++) /* matches at most REFERENCES of the views */
        if (o->n > REFERENCES && i * REFERENCES / o->n == (i + 1) * REFERENCES / o->n)
            o->part[i][2] = 0;
    return ADCGS_OK;
}

static void frame_free(frame_layer *o)
{
    for (int i = 0; o && i < o->n; i++) {
        adcgs_free(NULL, o->pixels[i]);
        adcgs_free(NULL, o->moves[i]);
        adcgs_depths_clear(&o->depths[i]);
    }
    adcgs_free(NULL, o);
}

/** Tests if two cameras have a background surface at a position, and if it is visible most of the time. */
static adcgs_stereo_in_place in_place(const adcgs_stereo_maps *maps, const double x[3])
{
    double there[3], at[2] = {0, 0}, depth;
    int same = 0, still = 0;
    for (int k = 0; k < maps->n && still < CAMERAS_AGREE; k++) {
        const adcgs_stereo_view *v = &maps->view[k];
        if (adcgs_depths_judge(&maps->depths[k], x, there) != ADCGS_VERDICT_SAME)
            continue;
        adcgs_stereo_rig_project(v, x, at, &depth);
        same++;
        still += !maps->unstable[k][(int)at[1] * v->w + (int)at[0]];
    }
    return still >= CAMERAS_AGREE ? ADCGS_PLACE_STILL : same >= CAMERAS_AGREE ? ADCGS_PLACE_COMMON : ADCGS_PLACE_OWN;
}

/** True if no view has a source for matching. */
static int all_stand_apart(const frame_layer *o)
{
    adcgs_sweep s = {.n_sources = 0};
    for (int i = 0; i < o->n && !s.n_sources; i++)
        choose_sources(&s, o->view, o->n, i);
    return !s.n_sources;
}

/** Matches a frame. Cameras that are too far apart for matching use silhouettes. */
static adcgs_status match_moment(adcgs_stereo_list *found, const adcgs_stereo_rig *rig, int m, adcgs_pool *pool,
                                 adcgs_error *error)
{
    frame_layer *o = adcgs_alloc(NULL, 1, sizeof *o, error);
    if (!o)
        return adcgs_alloc_status(error);
    adcgs_status status = read_frame(o, rig, m, error);
    match job = {.n = o->n,
                 .views = o->view,
                 .parts = (const int(*)[4])o->part,
                 .nearest = rig->nearest,
                 .farthest = rig->farthest,
                 .depths = o->depths};
    const adcgs_stereo_point like = {.t = rig->frame_time[m], .moves = 1};
    if (status == ADCGS_OK)
        status = match_all(&job, pool, error);
    if (status == ADCGS_OK)
        status = adcgs_fuse(found, o->depths, o->n, (const uint8_t *const *)o->moves, &like, error);
    if (status == ADCGS_OK && all_stand_apart(o))
        status = adcgs_hull_find(found, o->view, (const uint8_t *const *)o->moves, o->n, &like, error);
    frame_free(o);
    return status;
}

static adcgs_status find_moving(adcgs_stereo_list *list, const adcgs_stereo_rig *rig, const adcgs_stereo_maps *maps, int m,
                                uint32_t most, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_stereo_list found = {0, 0, NULL};
    adcgs_status status = rig->monocular ? adcgs_monocular_find_moving(&found, rig, maps->depths, m, error)
                                         : match_moment(&found, rig, m, pool, error);
    for (size_t i = 0; i < found.n; i++)
        found.point[i].in_place = (uint8_t)in_place(maps, found.point[i].x);
    if (status == ADCGS_OK)
        status = adcgs_stereo_thin(&found, most, error);
    for (size_t i = 0; i < found.n && status == ADCGS_OK; i++)
        status = adcgs_stereo_list_add(list, &found.point[i], error);
    adcgs_stereo_list_clear(&found);
    return status;
}

/* ---- All points ---- */

static adcgs_status find(adcgs_stereo *out, adcgs_stereo_rig *rig, const adcgs_stereo_options *options, adcgs_pool *pool,
                         adcgs_error *error)
{
    adcgs_stereo_list still = {0, 0, NULL}, moving = {0, 0, NULL};
    adcgs_status status = find_still(out, &still, rig, pool, error);
    if (status == ADCGS_OK && options->judges)
        status = adcgs_stereo_find_pose_outliers(out, rig, out->maps->depths, pool, error);
    if (status == ADCGS_OK)
        status = adcgs_stereo_thin(&still, options->still, error);
    if (status == ADCGS_OK && rig->monocular)
        status = adcgs_monocular_set_background(rig, out->maps->depths, pool, error);
    for (int m = 0; m < rig->n_frames && rig->n_frames > 1 && status == ADCGS_OK && options->moving; m++)
        status = find_moving(&moving, rig, out->maps, m, options->moving, pool, error);
    if (status == ADCGS_OK)
        status = adcgs_stereo_find_velocities(moving.point, (uint32_t)moving.n, error);
    if (status == ADCGS_OK && rig->monocular)
        status = adcgs_monocular_smooth_velocities(moving.point, (uint32_t)moving.n, rig, error);
    if (status == ADCGS_OK && !rig->monocular)
        adcgs_stereo_trim_lifetimes(moving.point, (uint32_t)moving.n, rig, out->maps->depths, pool);
    out->still = still.point;
    out->n_still = (uint32_t)still.n;
    out->moving = moving.point;
    out->n_moving = (uint32_t)moving.n;
    return status == ADCGS_OK && options->bodies ? adcgs_stereo_find_bodies(out, rig, options->bodies, pool, error) : status;
}

adcgs_status adcgs_stereo_find(adcgs_stereo *out, const adcgs_scene *scene, const adcgs_stereo_options *options, adcgs_pool *pool,
                               adcgs_error *error)
{
    adcgs_stereo_rig *rig = adcgs_alloc(NULL, 1, sizeof *rig, error);
    *out = (adcgs_stereo){.maps = adcgs_alloc(NULL, 1, sizeof *out->maps, error)};
    adcgs_status status = rig && out->maps ? adcgs_stereo_rig_init(rig, scene, options, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        out->frame_time = adcgs_alloc(NULL, (size_t)rig->n_frames, sizeof *out->frame_time, error);
        status = out->frame_time ? ADCGS_OK : adcgs_alloc_status(error);
    }
    if (status == ADCGS_OK) {
        out->n_frames = (uint32_t)rig->n_frames;
        out->monocular = rig->monocular;
        memcpy(out->frame_time, rig->frame_time, out->n_frames * sizeof *out->frame_time);
        if (options->judges)
            status = adcgs_stereo_measure_pose_error(rig, &out->poses, pool, error);
    }
    if (status == ADCGS_OK) {
        out->poses.pixels = (double)scene->views[ADCGS_SPLIT_TRAIN][0].camera.width / rig->camera[0].view.w;
        status = find(out, rig, options, pool, error);
    }
    for (int i = 0; out->maps && i < out->maps->n; i++) { /* the images are released with the rig */
        out->maps->view[i].pixels = NULL;
        out->maps->unstable[i] = NULL;
    }
    if (rig)
        adcgs_stereo_rig_clear(rig);
    adcgs_free(NULL, rig);
    if (status != ADCGS_OK)
        adcgs_stereo_clear(out);
    return status;
}

void adcgs_stereo_clear(adcgs_stereo *s)
{
    for (int i = 0; s->maps && i < s->maps->n; i++)
        adcgs_depths_clear(&s->maps->depths[i]);
    adcgs_free(NULL, s->maps);
    adcgs_free(NULL, s->still);
    adcgs_free(NULL, s->moving);
    adcgs_free(NULL, s->frame_time);
    for (uint32_t i = 0; i < s->n_bodies; i++)
        adcgs_free(NULL, s->body[i].pose);
    adcgs_free(NULL, s->body);
    memset(s, 0, sizeof *s);
}

int adcgs_stereo_is_known(const adcgs_stereo *s, const double x[3])
{
    int seen = 0, known = 0;
    for (int i = 0; s->maps && i < s->maps->n; i++) {
        const adcgs_depths *d = &s->maps->depths[i];
        double at[2], depth;
        if (!d->quality || !adcgs_stereo_rig_project(d->view, x, at, &depth))
            continue;
        seen++;
        known += d->quality[(int)at[1] * d->w + (int)at[0]] != ADCGS_DEPTH_NONE;
    }
    return 2 * known > seen;
}

int adcgs_stereo_floats(const adcgs_stereo *s, const double x[3])
{
    int cameras = 0, seen = 0, same = 0, through = 0;
    for (int i = 0; s->maps && i < s->maps->n; i++) {
        const adcgs_depths *d = &s->maps->depths[i];
        double at[2], depth, there[3];
        if (!d->quality)
            continue;
        cameras++;
        if (!adcgs_stereo_rig_project(d->view, x, at, &depth))
            continue;
        const adcgs_verdict verdict = adcgs_depths_judge(d, x, there);
        seen++;
        same += verdict == ADCGS_VERDICT_SAME;
        through += verdict == ADCGS_VERDICT_BEHIND;
    }
    return cameras && 3 * seen <= cameras && !same && (through || !seen);
}
