/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Paths of single splats. */
#include "config.h"

#include "init/splats/splat_tracks.h"

#include "init/cloud.h"
#include "scene/splat_views.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define TRACKS_MAX 60000 /* tracks that begin in one frame */
#define CAPACITY 80000   /* tracks of all frames together */
#define VISIBLE 0.1f     /* opacity from which a splat counts, as in layouts/splat_file.c */
#define REACH 0.15       /* scene units between the expected and the found position */
#define TINT 0.3         /* scene units per unit of colour difference */
#define EDGE 0.05        /* scene units: edge of a cell of the grid */
#define SAME 1e-12       /* squared scene units: positions are those of one splat; arithmetic: rounding */

/** Seconds of the source at which the scene begins; a part of a scene begins later than its source. */
static double source_begin(const adcgs_scene *scene)
{
    const adcgs_scene_view *const view = &scene->views[ADCGS_SPLIT_TRAIN][0];
    return view->source_time - view->time;
}

static adcgs_status alloc_tracks(adcgs_splat_tracks *t, uint32_t capacity, uint32_t frames, adcgs_error *error)
{
    *t = (adcgs_splat_tracks){.capacity = capacity, .frames = frames};
    const size_t all = (size_t)capacity * frames;
    t->time = adcgs_alloc(NULL, frames, sizeof *t->time, error);
    t->x = adcgs_alloc(NULL, all, sizeof *t->x, error);
    t->is_visible = adcgs_alloc(NULL, all, sizeof *t->is_visible, error);
    t->rgb = adcgs_alloc(NULL, capacity, sizeof *t->rgb, error);
    t->extent = adcgs_alloc(NULL, capacity, sizeof *t->extent, error);
    return t->time && t->x && t->is_visible && t->rgb && t->extent ? ADCGS_OK : adcgs_alloc_status(error);
}

void adcgs_splat_tracks_clear(adcgs_splat_tracks *t)
{
    adcgs_free(NULL, t->time);
    adcgs_free(NULL, t->x);
    adcgs_free(NULL, t->is_visible);
    adcgs_free(NULL, t->rgb);
    adcgs_free(NULL, t->extent);
    *t = (adcgs_splat_tracks){.n = 0};
}

/** Position of a splat in scene units. */
static void place_of(double x[3], const adcgs_splats *s, uint32_t i, const adcgs_stereo_options *o)
{
    for (int a = 0; a < 3; a++)
        x[a] = (s->offset[a] + (double)s->mean[a][i] - o->origin[a]) / o->scale;
}

/** Standard deviations of a splat along the axes, in units of the scene. */
static void extent_of(float extent[3], const adcgs_splats *s, uint32_t i, double scale)
{
    const double w = (double)s->rotation[0][i], x = (double)s->rotation[1][i], y = (double)s->rotation[2][i];
    const double z = (double)s->rotation[3][i], length = w * w + x * x + y * y + z * z, unit = length > 0.0 ? 2.0 / length : 0.0;
    const double turn[3][3] = {{1 - unit * (y * y + z * z), unit * (x * y - w * z), unit * (x * z + w * y)},
                               {unit * (x * y + w * z), 1 - unit * (x * x + z * z), unit * (y * z - w * x)},
                               {unit * (x * z - w * y), unit * (y * z + w * x), 1 - unit * (x * x + y * y)}};
    for (int a = 0; a < 3; a++) {
        double square = 0.0;
        for (int c = 0; c < 3; c++)
            square += pow(turn[a][c] * (double)s->scale[c][i], 2);
        extent[a] = (float)(sqrt(square) / scale);
    }
}

/** Records splat i as the place of a track in a frame. */
static void record(adcgs_splat_tracks *t, uint32_t track, uint32_t frame, const adcgs_splats *s, uint32_t i,
                   const adcgs_stereo_options *o)
{
    const size_t at = (size_t)track * t->frames + frame;
    double x[3];
    place_of(x, s, i, o);
    for (int a = 0; a < 3; a++)
        t->x[at][a] = (float)x[a];
    t->is_visible[at] = s->opacity[i] >= VISIBLE;
    if (!t->is_visible[at] && t->extent[track][0] > 0.0f)
        return;
    for (int a = 0; a < 3; a++)
        t->rgb[track][a] = s->colour[a][i];
    extent_of(t->extent[track], s, i, o->scale);
}

static adcgs_status state_at(adcgs_splats *out, const adcgs_scene *scene, const adcgs_splat_tracks *t, uint32_t frame,
                             adcgs_error *error)
{
    return adcgs_dynamic_at(scene->splats->dynamic, source_begin(scene) + (double)t->time[frame] * scene->duration, out, error);
}

/* ---- Splats with identity ---- */

/** A track for every step'th row. */
static adcgs_status follow_rows(adcgs_splat_tracks *t, const adcgs_scene *scene, const adcgs_stereo_options *o,
                                adcgs_error *error)
{
    const uint32_t rows = scene->splats->dynamic->n, step = rows / TRACKS_MAX + 1;
    t->n = (rows + step - 1) / step;
    for (uint32_t frame = 0; frame < t->frames; frame++) {
        adcgs_splats s;
        ADCGS_TRY(state_at(&s, scene, t, frame, error));
        for (uint32_t i = 0; i < t->n && i * step < s.n; i++)
            record(t, i, frame, &s, i * step, o);
        adcgs_splats_free(&s);
    }
    return ADCGS_OK;
}

/* ---- Splats without identity ---- */

/** The visible splats of a frame in a grid. */
typedef struct frame_grid {
    adcgs_splats s;
    uint32_t n;
    adcgs_stereo_point *p; /**< [n] */
    uint32_t *row;         /**< [n] row of each point */
    uint32_t *track;       /**< [n] its track, from 1; 0: none */
    adcgs_cloud cloud;
} frame_grid;

static void grid_clear(frame_grid *g)
{
    adcgs_cloud_clear(&g->cloud);
    adcgs_splats_free(&g->s);
    adcgs_free(NULL, g->p);
    adcgs_free(NULL, g->row);
    adcgs_free(NULL, g->track);
    *g = (frame_grid){.n = 0};
}

static adcgs_status grid_make(frame_grid *g, const adcgs_scene *scene, const adcgs_splat_tracks *t, uint32_t frame,
                              const adcgs_stereo_options *o, adcgs_error *error)
{
    *g = (frame_grid){.n = 0};
    ADCGS_TRY(state_at(&g->s, scene, t, frame, error));
    g->p = adcgs_alloc(NULL, (size_t)g->s.n + 1, sizeof *g->p, error);
    g->row = adcgs_alloc(NULL, (size_t)g->s.n + 1, sizeof *g->row, error);
    g->track = adcgs_alloc(NULL, (size_t)g->s.n + 1, sizeof *g->track, error);
    if (!g->p || !g->row || !g->track)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < g->s.n; i++) {
        if (g->s.opacity[i] < VISIBLE)
            continue;
        place_of(g->p[g->n].x, &g->s, i, o);
        for (int a = 0; a < 3; a++)
            g->p[g->n].rgb[a] = g->s.colour[a][i];
        g->row[g->n++] = i;
    }
    return adcgs_cloud_init(&g->cloud, g->p, g->n, 1, EDGE, error);
}

/** The expected position in the next frame: the last motion goes on. */
static void expect_at(double x[3], const adcgs_splat_tracks *t, uint32_t track, uint32_t frame)
{
    const float *const now = adcgs_splat_track_at(t, track, frame);
    const int known = frame > 0 && adcgs_splat_track_is_visible(t, track, frame - 1);
    for (int a = 0; a < 3; a++)
        x[a] = (double)now[a] + (known ? (double)now[a] - (double)adcgs_splat_track_at(t, track, frame - 1)[a] : 0.0);
}

/** Continues tracks from one frame to the next, where the match back finds the same splat. */
static void match(adcgs_splat_tracks *t, uint32_t frame, const frame_grid *from, frame_grid *to, const adcgs_stereo_options *o)
{
    for (uint32_t i = 0; i < from->n; i++) {
        double x[3], back[3];
        uint32_t found, again;
        if (!from->track[i])
            continue;
        const uint32_t track = from->track[i] - 1;
        expect_at(x, t, track, frame);
        if (adcgs_cloud_nearest(&to->cloud, x, from->p[i].rgb, REACH, TINT, &found) < 0.0 || to->track[found])
            continue;
        for (int a = 0; a < 3; a++)
            back[a] = to->p[found].x[a] - (x[a] - from->p[i].x[a]);
        if (adcgs_cloud_nearest(&from->cloud, back, to->p[found].rgb, REACH, TINT, &again) < 0.0)
            continue;
        double square = 0.0;
        for (int a = 0; a < 3; a++)
            square += pow(from->p[again].x[a] - from->p[i].x[a], 2);
        if (square > SAME)
            continue;
        to->track[found] = from->track[i];
        record(t, track, frame + 1, &to->s, to->row[found], o);
    }
}

/** Begins tracks at splats that have none, evenly over the frame. */
static void begin_tracks(adcgs_splat_tracks *t, uint32_t frame, frame_grid *g, const adcgs_stereo_options *o)
{
    const uint32_t step = g->n / TRACKS_MAX + 1;
    for (uint32_t i = 0; i < g->n && t->n < t->capacity; i += step)
        if (!g->track[i]) {
            record(t, t->n, frame, &g->s, g->row[i], o);
            g->track[i] = ++t->n;
        }
}

static adcgs_status match_frames(adcgs_splat_tracks *t, const adcgs_scene *scene, const adcgs_stereo_options *o,
                                 adcgs_error *error)
{
    frame_grid now = {.n = 0}, next = {.n = 0};
    adcgs_status status = grid_make(&now, scene, t, 0, o, error);
    if (status == ADCGS_OK)
        begin_tracks(t, 0, &now, o);
    for (uint32_t frame = 0; status == ADCGS_OK && frame + 1 < t->frames; frame++) {
        status = grid_make(&next, scene, t, frame + 1, o, error);
        if (status == ADCGS_OK) {
            match(t, frame, &now, &next, o);
            begin_tracks(t, frame + 1, &next, o);
            grid_clear(&now);
            now = next;
            now.cloud.p = now.p;
            next = (frame_grid){.n = 0};
        }
    }
    grid_clear(&now);
    grid_clear(&next);
    return status;
}

/* ---- Static splats ---- */

/** A track of one frame for every step'th splat, which the scene keeps in units of its radius, from its centre. */
static adcgs_status stand(adcgs_splat_tracks *t, const adcgs_scene *scene, const adcgs_stereo_options *options,
                          adcgs_error *error)
{
    const adcgs_splat_scene *const from = scene->splats;
    const uint32_t step = from->splats.n / TRACKS_MAX + 1;
    adcgs_stereo_options o = {.scale = options->scale / from->radius};
    for (int a = 0; a < 3; a++)
        o.origin[a] = (options->origin[a] - from->centre[a]) / from->radius;
    ADCGS_TRY(alloc_tracks(t, (from->splats.n + step - 1) / step + 1, 1, error));
    for (uint32_t i = 0; i < from->splats.n; i += step)
        record(t, t->n++, 0, &from->splats, i, &o);
    return ADCGS_OK;
}

/* ---- All of them ---- */

static adcgs_status follow(adcgs_splat_tracks *t, const adcgs_scene *scene, const adcgs_stereo_options *o, adcgs_error *error)
{
    const int known = scene->splats->dynamic->has_identity;
    const uint32_t most = o->frames ? ADCGS_MIN(o->frames, ADCGS_MATCHING_FRAMES_MAX) : ADCGS_MATCHING_FRAMES_MAX;
    const uint32_t frames = ADCGS_MAX(2, ADCGS_MIN(scene->n_times, known ? most : ADCGS_MATCHING_FRAMES_MAX));
    ADCGS_TRY(alloc_tracks(t, known ? TRACKS_MAX : CAPACITY, frames, error));
    for (uint32_t i = 0; i < frames; i++)
        t->time[i] = (float)i / (float)(frames - 1);
    return known ? follow_rows(t, scene, o, error) : match_frames(t, scene, o, error);
}

adcgs_status adcgs_splat_tracks_find(adcgs_splat_tracks *t, const adcgs_scene *scene, const adcgs_stereo_options *o,
                                     adcgs_error *error)
{
    const adcgs_status status = scene->splats->dynamic ? follow(t, scene, o, error) : stand(t, scene, o, error);
    if (status != ADCGS_OK)
        adcgs_splat_tracks_clear(t);
    return status;
}
