/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rigid objects of a .4dgs file: tracks of poses that move the splats of an object. */
#include "config.h"

#include "media/dynamic/fourdgs.h"

#include <math.h>
#include <stdlib.h>

/* Origin: definition (.4dgs). */
#define POSE 64         /* bytes of a pose: time, rotation, translation */
#define TRACKS_FIRST 16 /* entries of the first table; chosen by hand, not measured */
#define PARALLEL \
    1e-9 /* 1 - cosine of half the angle, below which two rotations are mixed linearly; chosen by hand, not measured */

/** A pose at a time, rotation w x y z of length 1. */
typedef struct pose {
    double rotation[4], shift[3];
} pose;

static double pose_number(const adcgs_fourdgs_track *t, uint32_t i, int k)
{
    return adcgs_bits_double(adcgs_load_le64(t->poses + (size_t)POSE * i + 8 * (size_t)k));
}

/* ---- Records ---- */

static adcgs_status check_poses(const adcgs_fourdgs *f, const adcgs_fourdgs_track *t, adcgs_error *error)
{
    for (uint32_t i = 0; i < t->n; i++) {
        double square = 0.0;
        int finite = 1;
        for (int k = 0; k < 8; k++)
            finite &= isfinite(pose_number(t, i, k));
        for (int k = 1; k < 5; k++)
            square += pow(pose_number(t, i, k), 2);
        if (!finite || !(square > 0.0) || !isfinite(square))
            return adcgs_fail(error, ADCGS_ERR_DATA,
                              "%s: .4dgs: pose %u of object %u is not finite, or its rotation has length 0", f->path, i,
                              t->object);
        if (i && !(pose_number(t, i, 0) > pose_number(t, i - 1, 0)))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: pose %u of object %u at %g seconds, expected more than %g",
                              f->path, i, t->object, pose_number(t, i, 0), pose_number(t, i - 1, 0));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_fourdgs_read_track(adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor c, adcgs_error *error)
{
    adcgs_fourdgs_track t = {.object = adcgs_cursor_u32(&c)};
    const int interpolation = adcgs_cursor_u8(&c);
    const uint32_t n = f->n_tracks;
    t.is_step = interpolation == 1;
    t.n = adcgs_cursor_u32(&c);
    t.poses = adcgs_cursor_bytes(&c, (uint64_t)t.n * POSE);
    if (c.failed)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: the track of an object at byte %llu ends early", f->path,
                          (unsigned long long)offset);
    if (!t.object || interpolation > 1)
        return adcgs_fail(error, t.object ? ADCGS_ERR_UNSUPPORTED : ADCGS_ERR_DATA,
                          "%s: .4dgs: a track of object %u with interpolation %d, expected 0 or 1", f->path, t.object,
                          interpolation);
    if (!t.n)
        return ADCGS_OK;
    ADCGS_TRY(check_poses(f, &t, error));
    if ((n & (n - 1)) == 0 && (n >= TRACKS_FIRST || !n)) { /* full */
        adcgs_fourdgs_track *const more = realloc(f->tracks, (n ? 2 * (size_t)n : TRACKS_FIRST) * sizeof *more);
        if (!more)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", f->path);
        f->tracks = more;
    }
    f->tracks[f->n_tracks++] = t;
    return ADCGS_OK;
}

static int compare_tracks(const void *a, const void *b)
{
    const uint32_t x = ((const adcgs_fourdgs_track *)a)->object, y = ((const adcgs_fourdgs_track *)b)->object;
    return (x > y) - (x < y);
}

adcgs_status adcgs_fourdgs_sort_tracks(adcgs_fourdgs *f, adcgs_error *error)
{
    if (f->n_tracks)
        qsort(f->tracks, f->n_tracks, sizeof *f->tracks, compare_tracks);
    for (uint32_t i = 1; i < f->n_tracks; i++)
        if (f->tracks[i].object == f->tracks[i - 1].object)
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: .4dgs: two tracks of object %u", f->path, f->tracks[i].object);
    return ADCGS_OK;
}

/* ---- Poses ---- */

static void get_rotation(double q[4], const adcgs_fourdgs_track *t, uint32_t i)
{
    double square = 0.0;
    for (int k = 0; k < 4; k++)
        square += pow(pose_number(t, i, k + 1), 2);
    for (int k = 0; k < 4; k++)
        q[(k + 1) % 4] = pose_number(t, i, k + 1) / sqrt(square);
}

/** The shorter way between two rotations, at constant speed. */
static void mix_rotations(double q[4], const double p[4], double u)
{
    double dot = 0.0, square = 0.0;
    for (int k = 0; k < 4; k++)
        dot += q[k] * p[k];
    const double sign = dot < 0.0 ? -1.0 : 1.0, angle = acos(fmin(fabs(dot), 1.0));
    const int is_near = 1.0 - fabs(dot) < PARALLEL;
    const double from = is_near ? 1.0 - u : sin((1.0 - u) * angle) / sin(angle);
    const double to = is_near ? u : sin(u * angle) / sin(angle);
    for (int k = 0; k < 4; k++) {
        q[k] = from * q[k] + sign * to * p[k];
        square += q[k] * q[k];
    }
    for (int k = 0; k < 4; k++)
        q[k] /= sqrt(square);
}

/** Outside of its poses a track keeps the nearest one. */
static pose pose_at(const adcgs_fourdgs_track *t, double seconds)
{
    pose at;
    double next[4];
    uint32_t low = 0, high = t->n;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (pose_number(t, middle, 0) <= seconds)
            low = middle;
        else
            high = middle;
    }
    get_rotation(at.rotation, t, low);
    for (int a = 0; a < 3; a++)
        at.shift[a] = pose_number(t, low, 5 + a);
    const double begin = pose_number(t, low, 0);
    if (t->is_step || high == t->n || !(seconds > begin))
        return at;
    const double u = (seconds - begin) / (pose_number(t, high, 0) - begin);
    get_rotation(next, t, high);
    mix_rotations(at.rotation, next, u);
    for (int a = 0; a < 3; a++)
        at.shift[a] += u * (pose_number(t, high, 5 + a) - at.shift[a]);
    return at;
}

/* ---- Splats ---- */

/** Product of two rotations: b first, then a. */
static void multiply(double out[4], const double a[4], const double b[4])
{
    out[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    for (int k = 0; k < 3; k++) {
        const int x = 1 + k, y = 1 + (k + 1) % 3, z = 1 + (k + 2) % 3;
        out[x] = a[0] * b[x] + b[0] * a[x] + a[y] * b[z] - a[z] * b[y];
    }
}

static void move_splat(adcgs_splats *s, uint32_t i, const pose *p)
{
    const double inverse[4] = {p->rotation[0], -p->rotation[1], -p->rotation[2], -p->rotation[3]};
    double q[4], turned[4], half[4], place[4] = {0.0};
    int finite = 1;
    for (int a = 0; a < 4; a++)
        q[a] = (double)s->rotation[a][i];
    multiply(turned, p->rotation, q);
    for (int a = 0; a < 4; a++)
        s->rotation[a][i] = (float)turned[a];
    for (int a = 0; a < 3; a++)
        place[a + 1] = (double)s->mean[a][i] + s->offset[a];
    multiply(half, p->rotation, place);
    multiply(place, half, inverse);
    for (int a = 0; a < 3; a++)
        finite &= isfinite((float)(place[a + 1] + p->shift[a] - s->offset[a]));
    for (int a = 0; a < 3 && finite; a++)
        s->mean[a][i] = (float)(place[a + 1] + p->shift[a] - s->offset[a]);
    if (!finite)
        s->opacity[i] = 0.0f; /* beyond binary32 */
}

adcgs_status adcgs_fourdgs_move(adcgs_splats *s, const uint32_t *objects, const adcgs_fourdgs *f, double seconds,
                                adcgs_error *error)
{
    if (!f->n_tracks || !objects)
        return ADCGS_OK;
    pose *const poses = malloc(f->n_tracks * sizeof *poses);
    if (!poses)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u poses", f->path, f->n_tracks);
    for (uint32_t i = 0; i < f->n_tracks; i++)
        poses[i] = pose_at(&f->tracks[i], seconds);
    for (uint32_t i = 0; i < s->n; i++) {
        const adcgs_fourdgs_track key = {.object = objects[i]};
        const adcgs_fourdgs_track *const t =
            key.object ? bsearch(&key, f->tracks, f->n_tracks, sizeof key, compare_tracks) : NULL;
        if (t)
            move_splat(s, i, &poses[t - f->tracks]);
    }
    free(poses);
    return ADCGS_OK;
}
