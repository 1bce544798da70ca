/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The pinhole camera for a lens: the rectangle of its pixels that the image covers. */
#include "config.h"

#include "scene/lens_model.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define MOVES_LEAST 0.01  /* pixels; smaller displacements do not justify resampling */
#define CORNER_SLACK 1e-6 /* pixels, for rounding at the image's edge */
#define PROBES 32         /* intervals along a side of the image; the lens is evaluated at their ends */
#define RASTER 128        /* cells along the longer side, in the search for the rectangle */
#define LEAST_SHARE 10    /* at least one in this many pixels must be left */
/* Tan of 60 degrees, geometry: further out, a pinhole's pixels resolve little. */
#define FISHEYE_REACH 1.7320508075688772
#define FOCAL_LEAST 1e-3 /* pixels: minimum focal length */
#define NUMBER_MOST 1e9  /* bound on focal lengths and pixel offsets: whole numbers of this size are exact */

/** A rectangle in the pinhole's image plane: whole numbers, in pixels, with the lens's principal point. */
typedef struct area {
    double side[4]; /**< left, top, right, bottom */
} area;

typedef struct search {
    const adcgs_lens *lens;
    double fold;
    double reach; /**< largest distance from the axis, to each side, that the pinhole may see */
    area box;     /**< bounds of everything that the image sees */
} search;

/** True if the image shows the direction that the pinhole sees at (u, v). */
static int is_covered(const search *s, double u, double v)
{
    const adcgs_lens *l = s->lens;
    const double x = (u - l->cx) / l->fx, y = (v - l->cy) / l->fy;
    double at[2];
    return fabs(x) <= s->reach && fabs(y) <= s->reach && adcgs_lens_see(l, s->fold, x, y, at) && at[0] >= -CORNER_SLACK &&
           at[1] >= -CORNER_SLACK && at[0] <= l->width + CORNER_SLACK && at[1] <= l->height + CORNER_SLACK;
}

/** True if the lens displaces any point of a grid over the image. */
static int moves(const adcgs_lens *lens)
{
    for (int j = 0; j <= PROBES; j++)
        for (int i = 0; i <= PROBES; i++) {
            const double u = (double)lens->width * i / PROBES, v = (double)lens->height * j / PROBES;
            double at[2];
            adcgs_lens_project(lens, (u - lens->cx) / lens->fx, (v - lens->cy) / lens->fy, at);
            if (!(fabs(at[0] - u) < MOVES_LEAST && fabs(at[1] - v) < MOVES_LEAST))
                return 1;
        }
    return 0;
}

/** Extends the box to a direction, clamped to the reach. */
static void widen(search *s, double x, double y)
{
    const adcgs_lens *l = s->lens;
    const double at[2] = {fmax(fmin(x, s->reach), -s->reach) * l->fx + l->cx, fmax(fmin(y, s->reach), -s->reach) * l->fy + l->cy};
    for (int axis = 0; axis < 2; axis++) {
        s->box.side[axis] = fmin(s->box.side[axis], floor(at[axis]));
        s->box.side[2 + axis] = fmax(s->box.side[2 + axis], ceil(at[axis]));
    }
}

/** Sets the box to the directions seen along the edge of the image. Returns 0 if the model folds there. */
static int find_box(search *s)
{
    const adcgs_lens *l = s->lens;
    s->box = (area){{HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    for (int i = 0; i <= PROBES; i++)
        for (int edge = 0; edge < 4; edge++) {
            const double along = (double)i / PROBES, u = edge < 2 ? along : edge - 2, v = edge < 2 ? edge : along;
            double at[2];
            if (adcgs_lens_invert(l, s->fold, l->width * u, l->height * v, at))
                widen(s, at[0], at[1]);
            else if (s->fold > 2.0 * s->reach * s->reach) { /* a fold beyond the reach is harmless: the pinhole sees nothing
                                                               there */
                widen(s, s->reach, s->reach);
                widen(s, -s->reach, -s->reach);
            } else
                return 0;
        }
    for (int axis = 0; axis < 2; axis++) {
        double *low = &s->box.side[axis], *high = &s->box.side[2 + axis];
        *low = fmax(*low, floor(0.5 * (*low + *high)) - ADCGS_IMAGE_MAX / 2);
        *high = fmin(*high, *low + ADCGS_IMAGE_MAX);
    }
    return 1;
}

/** Finds the largest rectangle below a row of column heights of covered points, in cells between points. Returns its size. */
static int largest_under(const int height[RASTER + 1], int n, int *left, int *right, int *depth)
{
    int best = 0;
    for (int i = 0; i < n; i++)
        for (int j = i, least = height[i]; j < n && (least = ADCGS_MIN(least, height[j])) > 1; j++)
            if ((j - i) * (least - 1) > best) {
                best = (j - i) * (least - 1);
                *left = i;
                *right = j;
                *depth = least - 1;
            }
    return best;
}

/** Finds the largest rectangle of raster points that are all covered. Returns its size, or 0 if there is none. */
static int search_raster(const search *s, double step, area *found)
{
    const double *box = s->box.side;
    const int n = (int)((box[2] - box[0]) / step) + 1, rows = (int)((box[3] - box[1]) / step) + 1;
    int height[RASTER + 1] = {0}, best = 0, left = 0, right = 0, depth = 0;
    for (int j = 0; j < rows; j++) {
        for (int i = 0; i < n; i++)
            height[i] = is_covered(s, box[0] + i * step, box[1] + j * step) ? height[i] + 1 : 0;
        const int size = largest_under(height, n, &left, &right, &depth);
        if (size > best) {
            best = size;
            *found = (area){{box[0] + left * step, box[1] + (j - depth) * step, box[0] + right * step, box[1] + j * step}};
        }
    }
    return best;
}

/** True if all pixel corners along a side are covered. */
static int is_side_covered(const search *s, const area *a, int side)
{
    const int across = side % 2; /* 0: left and right run down, 1: top and bottom run across */
    for (double t = a->side[1 - across]; t <= a->side[3 - across]; t++)
        if (!(across ? is_covered(s, t, a->side[side]) : is_covered(s, a->side[side], t)))
            return 0;
    return 1;
}

static int is_area_covered(const search *s, const area *a)
{
    return is_side_covered(s, a, 0) && is_side_covered(s, a, 1) && is_side_covered(s, a, 2) && is_side_covered(s, a, 3);
}

static int is_empty(const area *a)
{
    return a->side[2] - a->side[0] < 1.0 || a->side[3] - a->side[1] < 1.0;
}

/** Moves sides inwards where the raster has missed uncovered points. */
static void shrink(const search *s, area *a)
{
    for (int side = 0, good = 0; good < 4 && !is_empty(a); side = (side + 1) % 4)
        if (is_side_covered(s, a, side))
            good++;
        else {
            a->side[side] += side < 2 ? 1.0 : -1.0;
            good = 0;
        }
}

/** Moves sides outwards, by large steps and then by small ones, until none can move. */
static void widen_area(const search *s, double step, area *a)
{
    for (; step >= 1.0; step = floor(0.5 * step))
        for (int side = 0, stuck = 0; stuck < 4; side = (side + 1) % 4) {
            area larger = *a;
            larger.side[side] += side < 2 ? -step : step;
            const int axis = side % 2;
            if (larger.side[2 + axis] - larger.side[axis] <= ADCGS_IMAGE_MAX && is_area_covered(s, &larger)) {
                *a = larger;
                stuck = 0;
            } else
                stuck++;
        }
}

static adcgs_status find_area(search *s, area *a, const char *path, adcgs_error *error)
{
    const adcgs_lens *l = s->lens;
    if (!find_box(s))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: the lens folds inside the image of %dx%d pixels", path, l->width,
                          l->height);
    const double step = ceil(fmax(1.0, fmax(s->box.side[2] - s->box.side[0], s->box.side[3] - s->box.side[1]) / RASTER));
    *a = (area){{0.0, 0.0, 0.0, 0.0}};
    if (search_raster(s, step, a)) {
        shrink(s, a);
        if (!is_empty(a))
            widen_area(s, step, a);
    }
    const double width = a->side[2] - a->side[0], height = a->side[3] - a->side[1];
    if (is_empty(a) || width * height * LEAST_SHARE < (double)l->width * l->height)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%s: a pinhole sees %gx%g pixels of the distorted image, expected at least a "
                          "tenth of %dx%d",
                          path, fmax(width, 0.0), fmax(height, 0.0), l->width, l->height);
    return ADCGS_OK;
}

static int is_sane(const adcgs_lens *l)
{
    return l->fx >= FOCAL_LEAST && l->fx <= NUMBER_MOST && l->fy >= FOCAL_LEAST && l->fy <= NUMBER_MOST &&
           fabs(l->cx) <= NUMBER_MOST && fabs(l->cy) <= NUMBER_MOST && fabs(l->skew) <= NUMBER_MOST;
}

adcgs_status adcgs_lens_pinhole(adcgs_lens *lens, adcgs_camera *camera, const char *path, adcgs_error *error)
{
    area a = {{0.0, 0.0, lens->width, lens->height}};
    if (!is_sane(lens))
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%s: focal lengths %g %g, principal point %g %g, skew %g: expected at most %g, and focal lengths of "
                          "at least %g",
                          path, lens->fx, lens->fy, lens->cx, lens->cy, lens->skew, NUMBER_MOST, FOCAL_LEAST);
    const int bends = moves(lens);
    if (bends) {
        search s = {.lens = lens, .fold = adcgs_lens_fold(lens), .reach = lens->is_fisheye ? FISHEYE_REACH : HUGE_VAL};
        ADCGS_TRY(find_area(&s, &a, path, error));
    }
    camera->width = (int32_t)(a.side[2] - a.side[0]);
    camera->height = (int32_t)(a.side[3] - a.side[1]);
    camera->fx = lens->fx;
    camera->fy = lens->fy;
    camera->cx = lens->cx - a.side[0];
    camera->cy = lens->cy - a.side[1];
    if (!bends)
        lens->width = 0;
    return ADCGS_OK;
}
