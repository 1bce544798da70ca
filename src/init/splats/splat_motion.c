/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Static points, moving points and bodies of splats over time. */
#include "config.h"

#include "init/splats/splat_motion.h"

#include "init/cloud.h"
#include "init/splats/splat_bodies.h"
#include "init/splats/splat_tracks.h"
#include "scene/splat_views.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define STILL 0.002       /* scene units: largest movement of a static splat, about a pixel of a view */
#define STILL_SHARE 0.95  /* share of the frames in which a static splat is visible */
#define STATIC_SHARE 0.72 /* of the points, beside moving ones: train/start_points.c uses so many */
#define NEAR 0.3          /* scene units between a static splat and the point that stands for it */
#define TINT 0.1          /* scene units per unit of colour difference: the nearest point has a like colour */
#define CELL 0.05         /* scene units: edge of a cell of the grid */
#define PIXEL 0.002       /* scene units of a pixel; geometry: 2 tan(25 degrees) / 400 at distance 1 */

/** Kinds of tracks; definition. MOVES: also splats that stand and fade. */
enum { STANDS, MOVES, HIDDEN };

int adcgs_splat_motion_applies(const adcgs_scene *scene)
{
    return scene->splats && (scene->splats->dynamic ? scene->n_times > 1 : scene->splats->gives_points);
}

/** The first frame in which a track is visible; -1: none. */
static int first_frame(const adcgs_splat_tracks *t, uint32_t i)
{
    for (uint32_t f = 0; f < t->frames; f++)
        if (adcgs_splat_track_is_visible(t, i, f))
            return (int)f;
    return -1;
}

/** True if the splat stands and is visible in nearly all frames. */
static int is_static(const adcgs_splat_tracks *t, uint32_t i)
{
    const int first = first_frame(t, i);
    uint32_t visible = 0;
    for (uint32_t f = 0; first >= 0 && f < t->frames; f++) {
        if (!adcgs_splat_track_is_visible(t, i, f))
            continue;
        double square = 0.0;
        for (int a = 0; a < 3; a++)
            square += pow((double)adcgs_splat_track_at(t, i, f)[a] - (double)adcgs_splat_track_at(t, i, (uint32_t)first)[a], 2);
        if (square > STILL * STILL)
            return 0;
        visible++;
    }
    return visible >= STILL_SHARE * t->frames;
}

static void set_point(adcgs_stereo_point *p, const adcgs_splat_tracks *t, uint32_t i, uint32_t frame)
{
    const float *const x = adcgs_splat_track_at(t, i, frame);
    for (int a = 0; a < 3; a++) {
        p->x[a] = (double)x[a];
        p->rgb[a] = fminf(fmaxf(t->rgb[i][a], 0.0f), 1.0f);
    }
    p->size = PIXEL;
}

/** Velocity by the adjacent frames in which the splat is visible. */
static void set_velocity(adcgs_stereo_point *p, const adcgs_splat_tracks *t, uint32_t i, uint32_t frame)
{
    const uint32_t before = frame > 0 && adcgs_splat_track_is_visible(t, i, frame - 1) ? frame - 1 : frame;
    const uint32_t behind = frame + 1 < t->frames && adcgs_splat_track_is_visible(t, i, frame + 1) ? frame + 1 : frame;
    for (int a = 0; a < 3 && behind > before; a++)
        p->velocity[a] =
            (adcgs_splat_track_at(t, i, behind)[a] - adcgs_splat_track_at(t, i, before)[a]) / (t->time[behind] - t->time[before]);
}

/** The ends of the lifetime: the splat is visible until half a frame before the next frame in which it is not. */
static void set_ends(adcgs_stereo_point *p, const adcgs_splat_tracks *t, uint32_t i, uint32_t frame)
{
    const float half = 0.5f / (float)(t->frames - 1);
    uint32_t begin = frame, end = frame;
    while (begin > 0 && adcgs_splat_track_is_visible(t, i, begin - 1))
        begin--;
    while (end + 1 < t->frames && adcgs_splat_track_is_visible(t, i, end + 1))
        end++;
    p->end[0] = begin > 0 ? t->time[frame] - t->time[begin] + half : 0.0f;
    p->end[1] = end + 1 < t->frames ? t->time[end] - t->time[frame] + half : 0.0f;
}

/** Weighted sums over the static tracks nearest to a point. */
typedef struct sums {
    double weight, x[3], square[3], rgb[3], extent[3];
} sums;

static void add(sums *to, const float x[3], const float rgb[3], const float extent[3])
{
    const double weight = (double)(extent[0] * extent[1] + extent[1] * extent[2] + extent[2] * extent[0]);
    to->weight += weight;
    for (int a = 0; a < 3; a++) {
        to->x[a] += weight * (double)x[a];
        to->square[a] += weight * (double)x[a] * (double)x[a];
        to->rgb[a] += weight * (double)rgb[a];
        to->extent[a] += weight * (double)(extent[a] * extent[a]);
    }
}

/** Gives a point the mean position, colour and extents of the tracks that it stands for. */
static void set_mean(adcgs_stereo_point *p, const sums *s)
{
    for (int a = 0; a < 3 && s->weight > 0.0; a++) {
        p->x[a] = s->x[a] / s->weight;
        p->rgb[a] = (float)fmin(fmax(s->rgb[a] / s->weight, 0.0), 1.0);
        p->extent[a] = (float)sqrt(s->extent[a] / s->weight);
        p->spread[a] = fmaxf((float)sqrt(fmax(s->square[a] / s->weight - p->x[a] * p->x[a], 0.0)), p->extent[a]);
    }
}

/** Each static track belongs to the nearest of the points, which stand for all of them. */
static adcgs_status gather(adcgs_stereo *out, const adcgs_splat_tracks *t, const uint8_t *kind, adcgs_error *error)
{
    adcgs_cloud cloud = {.n = 0};
    sums *const sum = adcgs_alloc(NULL, (size_t)out->n_still + 1, sizeof *sum, error);
    adcgs_status status = sum ? adcgs_cloud_init(&cloud, out->still, out->n_still, 1, CELL, error) : adcgs_alloc_status(error);
    for (uint32_t i = 0; status == ADCGS_OK && i < t->n; i++) {
        if (kind[i] != STANDS)
            continue;
        const float *const place = adcgs_splat_track_at(t, i, (uint32_t)first_frame(t, i));
        const double x[3] = {(double)place[0], (double)place[1], (double)place[2]};
        uint32_t found;
        if (adcgs_cloud_nearest(&cloud, x, t->rgb[i], NEAR, TINT, &found) >= 0.0)
            add(&sum[found], place, t->rgb[i], t->extent[i]);
    }
    for (uint32_t i = 0; status == ADCGS_OK && i < out->n_still; i++)
        set_mean(&out->still[i], &sum[i]);
    adcgs_cloud_clear(&cloud);
    adcgs_free(NULL, sum);
    return status;
}

/** Lists points for the static tracks: all of them, or `most`, evenly picked. */
static adcgs_status list_static(adcgs_stereo *out, const adcgs_splat_tracks *t, const uint8_t *kind, uint32_t most,
                                adcgs_error *error)
{
    uint32_t there = 0, seen = 0;
    for (uint32_t i = 0; i < t->n; i++)
        there += kind[i] == STANDS;
    out->still = adcgs_alloc(NULL, (size_t)ADCGS_MIN(there, most) + 1, sizeof *out->still, error);
    if (!out->still)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < t->n && out->n_still < most; i++)
        if (kind[i] == STANDS && (uint64_t)seen++ * ADCGS_MIN(most, there) / there >= out->n_still) {
            adcgs_stereo_point *const p = &out->still[out->n_still++];
            set_point(p, t, i, (uint32_t)first_frame(t, i));
            p->t = 0.5f;
        }
    return gather(out, t, kind, error);
}

/** Lists moving tracks at each frame, at most `most` a frame; other tracks in other frames if there are more. */
static adcgs_status list_moving(adcgs_stereo *out, const adcgs_splat_tracks *t, const uint8_t *kind, const uint8_t *body,
                                uint32_t most, adcgs_error *error)
{
    uint32_t there = 0;
    for (uint32_t i = 0; i < t->n; i++)
        there += kind[i] == MOVES;
    const uint32_t step = there / ADCGS_MAX(most, 1) + 1;
    out->moving = adcgs_alloc(NULL, (size_t)(there / step + 1) * t->frames, sizeof *out->moving, error);
    if (!out->moving)
        return adcgs_alloc_status(error);
    for (uint32_t f = 0; f < t->frames; f++)
        for (uint32_t i = 0, seen = 0; i < t->n; i++) {
            if (kind[i] != MOVES || seen++ % step != f % step || !adcgs_splat_track_is_visible(t, i, f))
                continue;
            adcgs_stereo_point *const p = &out->moving[out->n_moving++];
            set_point(p, t, i, f);
            set_velocity(p, t, i, f);
            set_ends(p, t, i, f);
            p->t = t->time[f];
            p->moves = 1;
            memcpy(p->extent, t->extent[i], sizeof p->extent);
            p->body = body[i];
        }
    return ADCGS_OK;
}

static adcgs_status fill(adcgs_stereo *out, const adcgs_splat_tracks *t, const adcgs_stereo_options *o, uint8_t *kind,
                         uint8_t *body, adcgs_error *error)
{
    for (uint32_t i = 0; i < t->n; i++)
        kind[i] = first_frame(t, i) < 0 ? HIDDEN : is_static(t, i) ? STANDS : MOVES;
    out->n_frames = t->frames;
    out->frame_time = adcgs_alloc(NULL, t->frames, sizeof *out->frame_time, error);
    if (!out->frame_time)
        return adcgs_alloc_status(error);
    memcpy(out->frame_time, t->time, t->frames * sizeof *out->frame_time);
    if (o->bodies && t->frames > 1)
        ADCGS_TRY(adcgs_splat_bodies_find(out, body, t, kind, MOVES, t->frames / 2, o->bodies, error));
    uint32_t moving = 0;
    for (uint32_t i = 0; i < t->n; i++)
        moving += kind[i] == MOVES;
    ADCGS_TRY(list_static(out, t, kind, moving ? (uint32_t)(STATIC_SHARE * o->still) : o->still, error));
    return list_moving(out, t, kind, body, o->moving, error);
}

adcgs_status adcgs_splat_motion_find(adcgs_stereo *out, const adcgs_scene *scene, const adcgs_stereo_options *options,
                                     adcgs_error *error)
{
    adcgs_splat_tracks tracks = {.n = 0};
    ADCGS_TRY(adcgs_splat_tracks_find(&tracks, scene, options, error));
    uint8_t *const kind = adcgs_alloc(NULL, (size_t)tracks.n + 1, 1, error);
    uint8_t *const body = adcgs_alloc(NULL, (size_t)tracks.n + 1, 1, error);
    adcgs_status status = kind && body ? fill(out, &tracks, options, kind, body, error) : adcgs_alloc_status(error);
    adcgs_free(NULL, kind);
    adcgs_free(NULL, body);
    adcgs_splat_tracks_clear(&tracks);
    return status;
}
