/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Static points, moving points and bodies of splats over time. */
#include "config.h"

#include "init/splats/splat_motion.h"

#include "init/splats/splat_bodies.h"
#include "init/splats/splat_tracks.h"
#include "scene/splat_views.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define STILL 0.002      /* scene units: largest movement of a static splat, about a pixel of a view */
#define STILL_SHARE 0.95 /* share of the frames in which a static splat is visible */
#define PIXEL 0.002      /* scene units of a pixel; geometry: 2 tan(25 degrees) / 400 at distance 1 */

/** Kinds of tracks; definition. MOVES: also splats that stand and fade. */
enum { STANDS, MOVES, HIDDEN };

int adcgs_splat_motion_applies(const adcgs_scene *scene)
{
    return scene->splats && scene->splats->dynamic && scene->n_times > 1;
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

/** Lists the static tracks, evenly thinned to `most`. */
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
    return ADCGS_OK;
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
    if (o->bodies)
        ADCGS_TRY(adcgs_splat_bodies_find(out, body, t, kind, MOVES, t->frames / 2, o->bodies, error));
    ADCGS_TRY(list_static(out, t, kind, o->still, error));
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
