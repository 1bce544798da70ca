/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats over time as pieces: chooses their number and their opacities. */
#include "config.h"

#include "media/dynamic/splat_paths.h"

#include "media/dynamic/piece_fit.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define POSITION_MOST 0.25  /* tolerated error of a position, in units of the splat's middle scale */
#define TOLERATED 1.0       /* error of a path that needs no more pieces */
#define GAIN 0.8            /* factor of the error that pays for more pieces */
#define DISTANCE_MIN 2      /* frames between pieces, at least */
#define OPAQUE 0.5          /* mean opacity above which pieces are wide */
#define NARROW 0.6          /* standard deviation of a piece, of the distance of pieces */
#define WIDE 0.9            /* the same for opaque splats */
#define STEPS 4             /* of the fit of opacities */
#define OPACITY_MOST 0.99   /* upper bound of a piece's opacity */
#define OPACITY_LEAST 0.004 /* pieces below it are left out: 1/255 */
#define REACH 2  /* pieces to each side of a frame and its two that count there; arithmetic: others weigh 0.02 or less */
#define BESIDE 2 /* frames beyond those in which a splat exists, in which it should not be seen */

static adcgs_status reserve(adcgs_pieces *p, size_t more, const char *path, adcgs_error *error)
{
    if (more > ADCGS_SPLATS_MAX - (size_t)p->n)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: more than %u splats: give a shorter --time", path, ADCGS_SPLATS_MAX);
    if (p->n + more <= p->capacity)
        return ADCGS_OK;
    const size_t capacity = ADCGS_MIN(ADCGS_MAX(2 * (size_t)p->capacity, p->n + more + 1024), ADCGS_SPLATS_MAX);
    adcgs_piece *const piece = realloc(p->piece, capacity * sizeof *piece);
    if (!piece)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %zu splats", path, capacity);
    p->piece = piece;
    p->capacity = (uint32_t)capacity;
    return ADCGS_OK;
}

/** Optical depth of an opacity, which adds up where splats overlap. */
static double depth_of(double opacity)
{
    return -log1p(-fmin(opacity, 0.995));
}

/** Sum of the optical depths of the pieces around a frame; pieces have equal distances. */
static double depth_at(const adcgs_piece_trial *trial, int t)
{
    const adcgs_piece *const p = trial->piece;
    const double d = trial->n > 1 ? (double)(p[1].centre - p[0].centre) : INFINITY;
    const int near_by = (int)floor((t - (double)p[0].centre) / d);
    double depth = 0.0;
    for (int k = ADCGS_MAX(near_by - REACH, 0); k <= ADCGS_MIN(near_by + 1 + REACH, trial->n - 1); k++)
        depth += depth_of((double)p[k].opacity * adcgs_piece_weight(&p[k], t));
    return depth;
}

/** Scale the opacities of pieces until their sum in each frame is near that of the path. */
static void fit_opacities(adcgs_piece_trial *trial, const adcgs_piece_path *path)
{
    for (int step = 0; step < STEPS; step++) {
        for (int t = path->first; t < path->end; t++)
            trial->depth[t - path->first] = depth_at(trial, t);
        for (int k = 0; k < trial->n; k++) {
            adcgs_piece *const p = &trial->piece[k];
            const double range = ADCGS_MIN(3.0 * (double)p->sigma, (double)ADCGS_PIECE_FOREVER), c = (double)p->centre;
            double wanted = 0.0, found = 0.0;
            for (int t = ADCGS_MAX((int)(c - range), path->first); t < path->end && t <= c + range; t++) {
                const double w = adcgs_piece_weight(p, t);
                found += w * trial->depth[t - path->first];
                wanted += w * (t >= path->low && t <= path->high ? depth_of((double)path->sample[t].opacity) : 0.0);
            }
            if (found > 0.0)
                p->opacity = (float)fmin((double)p->opacity * wanted / found, OPACITY_MOST);
        }
    }
}

/** count pieces, and one beyond each open end; sigma is `width` distances. */
static void try_pieces(adcgs_piece_trial *trial, const adcgs_piece_path *path, int count, double width, double opacity)
{
    const double d = (path->high - path->low + 1.0) / count, start = path->low - 0.5;
    const int forever = count == 1 && path->is_open[0] && path->is_open[1];
    const double overlap = forever ? 1.0 : width * 2.5066; /* the sum of the weights: sqrt(2 pi) width */
    trial->n = 0;
    for (int k = forever ? 0 : -path->is_open[0]; k < count + (forever ? 0 : path->is_open[1]); k++) {
        adcgs_piece *const p = &trial->piece[trial->n++];
        *p = (adcgs_piece){.centre = (float)(start + (k + 0.5) * d),
                           .sigma = forever ? ADCGS_PIECE_FOREVER : (float)(width * d),
                           .opacity = (float)fmin(1.0 - exp(-depth_of(opacity) / overlap), OPACITY_MOST)};
        adcgs_piece_fit_motion(p, path);
    }
    fit_opacities(trial, path);
    adcgs_piece_judge(trial, path);
}

/** Mean opacity of the frames that show a path. */
static double mean_opacity(const adcgs_piece_path *path)
{
    double sum = 0.0;
    for (int t = path->low; t <= path->high; t++)
        sum += (double)path->sample[t].opacity;
    return sum / (path->high - path->low + 1);
}

/** Keeps the best trial in `best`; the other one is for work. Opaque splats need wider pieces: opacities do not just add up. */
static void fit_path(adcgs_piece_trial *best, adcgs_piece_trial *other, const adcgs_piece_path *path)
{
    const double opacity = mean_opacity(path), width = opacity > OPAQUE ? WIDE : NARROW;
    const int most = ADCGS_MAX((path->high - path->low + 1) / DISTANCE_MIN, 1);
    best->error = INFINITY;
    best->n = 0;
    for (int count = 1; count <= most && best->error > TOLERATED; count *= 2) {
        try_pieces(other, path, count, width, opacity);
        if (other->error < best->error * GAIN) {
            const adcgs_piece_trial kept = *best;
            *best = *other;
            *other = kept;
        }
    }
}

/** Middle of three. */
static double middle(const float v[3])
{
    return (double)fmaxf(fminf(v[0], v[1]), fminf(fmaxf(v[0], v[1]), v[2]));
}

/** Prepares a path. \return 0 if it is never visible */
static int begin_path(adcgs_piece_path *out, adcgs_path_sample *s, const adcgs_splat_paths *paths, adcgs_piece_form form)
{
    const int frames = (int)paths->frames, first = (int)paths->first, clip = (int)paths->clip;
    const adcgs_path_sample *last = NULL;
    *out = (adcgs_piece_path){.sample = s, .frames = frames, .form = form};
    for (int t = 0; t < frames; t++) {
        double dot = 0.0;
        if (!(s[t].opacity > 0.0f)) {
            if (last) { /* a gap is fitted with the values before it */
                s[t] = *last;
                s[t].opacity = 0.0f;
            }
            continue;
        }
        out->low = last ? out->low : t;
        out->high = t;
        for (int a = 0; a < 4; a++)
            dot += last ? (double)s[t].rotation[a] * (double)last->rotation[a] : 1.0;
        for (int a = 0; a < 4 && dot < 0.0; a++)
            s[t].rotation[a] = -s[t].rotation[a];
        last = &s[t];
    }
    if (!last)
        return 0;
    out->size = fmax(POSITION_MOST * middle(s[out->low].scale), paths->tolerance);
    out->is_open[0] = first + out->low == 0;
    out->is_open[1] = first + out->high == clip - 1;
    out->first = ADCGS_MAX(out->low - BESIDE, -first);
    out->end = ADCGS_MIN(out->high + BESIDE, clip - 1 - first) + 1;
    return 1;
}

/** Appends the pieces that can be seen, with the clip's times. */
static void take(adcgs_pieces *pieces, const adcgs_piece_trial *best, uint32_t first)
{
    for (int k = 0; k < best->n; k++) {
        if ((double)best->piece[k].opacity < OPACITY_LEAST)
            continue;
        pieces->piece[pieces->n] = best->piece[k];
        pieces->piece[pieces->n++].centre += (float)first;
    }
    pieces->worst = fmax(pieces->worst, best->error);
    pieces->above += best->error > TOLERATED;
}

adcgs_status adcgs_pieces_add(adcgs_pieces *pieces, const adcgs_splat_paths *paths, adcgs_piece_form form, const char *path,
                              adcgs_error *error)
{
    const size_t most = 2 * (size_t)paths->frames + 2 * BESIDE + 4; /* counts are at most 4/3 of the frames */
    adcgs_piece *const memory = malloc(2 * most * sizeof *memory);
    double *const depth = malloc(most * sizeof *depth);
    adcgs_piece_trial best = {.piece = memory, .depth = depth}, other = {.piece = memory ? memory + most : NULL, .depth = depth};
    adcgs_status status = memory && depth ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    pieces->clip = paths->clip;
    for (uint32_t i = 0; i < paths->n && status == ADCGS_OK; i++) {
        adcgs_piece_path one;
        if (!begin_path(&one, paths->sample + (size_t)i * paths->frames, paths, form))
            continue;
        fit_path(&best, &other, &one);
        status = reserve(pieces, (size_t)best.n, path, error);
        if (status == ADCGS_OK)
            take(pieces, &best, paths->first);
    }
    free(memory);
    free(depth);
    return status;
}
