/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Moving content in front of a moving camera. */
#include "init/monocular.h"

#include "system/sort_values.h"

#include <math.h>

/*
 * Origin: chosen by hand, not measured one by one. Films as a whole are measured on four generated ones and nrnerf_hand
 * (doc/log/matching.md, "Films: matching of one moving camera").
 */
enum { SEEN_LEAST = 4 };   /* minimum number of other images for a background colour */
enum { ALIKE_MOST = 128 }; /* maximum number of velocities in a median */
#define ALIKE_REACH 0.15   /* scene units: radius of the velocity median */
enum {
    OFF_LEAST = 9,  /* minimum number of differing pixels in a 5x5 window */
    PART_LEAST = 24 /* pixels: minimum size of a moving part */
};
#define MOVED (22 / 255.0f) /* values of 0 to 1: minimum difference from all background colours nearby */
#define HIDDEN 1.08         /* relative to the depth of the surface; points farther away are hidden */

/* ---- Filling of static depths ---- */

/** Interpolates linearly between the nearest known inverse depths before and after i on a line; 0 if there are none. */
static float between(const float *line, size_t step, int n, int i)
{
    int a = i, b = i;
    while (a >= 0 && line[(size_t)a * step] <= 0)
        a--;
    while (b < n && line[(size_t)b * step] <= 0)
        b++;
    if (a < 0 && b >= n)
        return 0;
    if (a < 0 || b >= n)
        return line[(size_t)(a < 0 ? b : a) * step];
    const float u = b > a ? (float)(i - a) / (float)(b - a) : 0;
    return (1 - u) * line[(size_t)a * step] + u * line[(size_t)b * step];
}

/** Inverse depths of a whole image, [h][w]; 0 if no depth is known. */
static float *fill(const adcgs_stereo_view *v, const adcgs_depths *d, adcgs_error *error)
{
    const int w = v->w, h = v->h;
    const size_t plane = (size_t)w * (size_t)h;
    float *known = adcgs_alloc(NULL, 2 * plane, sizeof *known, error), *all = known ? known + plane : NULL;
    for (int i = 0; known && i < w * h; i++)
        known[i] = d->quality && d->quality[i] != ADCGS_DEPTH_NONE ? d->inverse[i] : 0;
    for (int y = 0; known && y < h; y++)
        for (int x = 0; x < w; x++) {
            const float across = between(known + (size_t)y * (size_t)w, 1, w, x);
            all[y * w + x] = across > 0 ? across : between(known + x, (size_t)w, h, y);
        }
    if (known)
        memcpy(known, all, plane * sizeof *known);
    return known;
}

/* ---- Background ---- */

typedef struct showing {
    adcgs_stereo_rig *rig;
    const adcgs_depths *depths;
    adcgs_error error[ADCGS_STEREO_CAMERAS];
} showing;

static double distance2(const double a[3], const double b[3])
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]);
}

/** Median colour of a point in the other images; 0 if too few of them see it. */
static int background_at(const showing *s, int own, const double x[3], float rgb[3])
{
    double values[3][ADCGS_STEREO_CAMERAS];
    int n = 0;
    for (int i = 0; i < s->rig->n_cameras; i++) {
        const adcgs_depths *d = &s->depths[i];
        const adcgs_stereo_camera *c = &s->rig->camera[i];
        double at[2], depth;
        if (i == own || !adcgs_stereo_rig_project(&c->view, x, at, &depth))
            continue;
        const int p = (int)at[1] * c->view.w + (int)at[0];
        if (d->quality && d->quality[p] != ADCGS_DEPTH_NONE && depth * (double)d->inverse[p] > HIDDEN)
            continue;
        if (!c->frame[i][4 * p + 3])
            continue;
        for (int k = 0; k < 3; k++)
            values[k][n] = (double)(c->frame[i][4 * p + k] * (1.0f / 255));
        n++;
    }
    for (int k = 0; k < 3 && n >= SEEN_LEAST; k++) {
        adcgs_sort(values[k], (size_t)n);
        rgb[k] = (float)values[k][n / 2];
    }
    return n >= SEEN_LEAST;
}

static void show_usual(void *arg, int i, int thread)
{
    showing *s = arg;
    adcgs_stereo_camera *c = &s->rig->camera[i];
    float *inverse = fill(&c->view, &s->depths[i], &s->error[i]);
    (void)thread;
    for (int y = 0; inverse && y < c->view.h; y++)
        for (int x = 0; x < c->view.w; x++) {
            const int p = y * c->view.w + x;
            double place[3];
            if (inverse[p] <= 0)
                continue;
            adcgs_stereo_rig_lift(&c->view, x, y, 1 / (double)inverse[p], place);
            background_at(s, i, place, c->background + 4 * (size_t)p);
        }
    adcgs_free(NULL, inverse);
}

adcgs_status adcgs_monocular_set_background(adcgs_stereo_rig *rig, const adcgs_depths *depths, adcgs_pool *pool,
                                            adcgs_error *error)
{
    showing *s = adcgs_alloc(NULL, 1, sizeof *s, error);
    if (!s)
        return adcgs_alloc_status(error);
    s->rig = rig;
    s->depths = depths;
    adcgs_pool_run(pool, show_usual, s, rig->n_cameras);
    const adcgs_status status = adcgs_stereo_first_failure(s->error, rig->n_cameras, error);
    adcgs_free(NULL, s);
    return status;
}

/* ---- Moving parts ---- */

/** Difference of a pixel from the range of background colours in its 3x3 window, in the channel that differs most. */
static float background_difference(const adcgs_stereo_camera *c, const uint8_t *shown, int px, int py)
{
    float most = 0;
    for (int k = 0; k < 3; k++) {
        const float value = shown[4 * (py * c->view.w + px) + k] * (1.0f / 255);
        float low = 1, high = 0;
        for (int y = ADCGS_MAX(py - 1, 0); y <= ADCGS_MIN(py + 1, c->view.h - 1); y++)
            for (int x = ADCGS_MAX(px - 1, 0); x <= ADCGS_MIN(px + 1, c->view.w - 1); x++) {
                const float background = c->background[4 * (y * c->view.w + x) + k];
                low = fminf(low, background);
                high = fmaxf(high, background);
            }
        most = fmaxf(most, fmaxf(low - value, value - high));
    }
    return most;
}

/** Marks pixels where at least OFF_LEAST pixels of the 5x5 window differ from the background. off: buffer of [h][w]. */
static void mark(const adcgs_stereo_camera *c, const uint8_t *shown, uint8_t *off, uint32_t *part)
{
    const int w = c->view.w, h = c->view.h;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            off[y * w + x] = shown[4 * (y * w + x) + 3] && background_difference(c, shown, x, y) > MOVED;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            int sum = 0;
            for (int b = ADCGS_MAX(y - 2, 0); b <= ADCGS_MIN(y + 2, h - 1); b++)
                for (int a = ADCGS_MAX(x - 2, 0); a <= ADCGS_MIN(x + 2, w - 1); a++)
                    sum += off[b * w + a];
            part[y * w + x] = sum >= OFF_LEAST;
        }
}

/** Labels connected parts from 2; parts with too few pixels become 0. stack: [w h]. \return the next label. */
static uint32_t number_parts(uint32_t *part, int w, int h, int *stack)
{
    uint32_t next = 2;
    for (int i = 0; i < w * h; i++) {
        int n = 0, begin = 0;
        if (part[i] != 1)
            continue;
        stack[n++] = i;
        part[i] = next;
        while (begin < n) { /* visited pixels stay on the stack */
            const int p = stack[begin++], x = p % w, y = p / w;
            const int about[4] = {x > 0 ? p - 1 : -1, x < w - 1 ? p + 1 : -1, y > 0 ? p - w : -1, y < h - 1 ? p + w : -1};
            for (int k = 0; k < 4; k++)
                if (about[k] >= 0 && part[about[k]] == 1) {
                    part[about[k]] = next;
                    stack[n++] = about[k];
                }
        }
        if (n >= PART_LEAST)
            next++;
        for (int k = 0; n < PART_LEAST && k < n; k++)
            part[stack[k]] = 0;
    }
    return next;
}

/** Inverse depth of the surface below a part, on which it stands; 0 if the part reaches the image border. */
static float stands_on(const uint32_t *part, uint32_t number, const float *inverse, int w, int h)
{
    int low = -1, n = 0;
    float sum = 0;
    for (int i = w * h - 1; i >= 0 && low < 0; i--)
        low = part[i] == number ? i / w : -1;
    for (int y = low; y >= ADCGS_MAX(low - 2, 0); y--) /* the lowest rows of the part */
        for (int x = 0; x < w; x++)
            if (part[y * w + x] == number && y + 2 < h && part[(y + 1) * w + x] != number && inverse[(y + 2) * w + x] > 0) {
                sum += inverse[(y + 2) * w + x];
                n++;
            }
    return n ? sum / (float)n : 0;
}

static adcgs_status add_part(adcgs_stereo_list *list, const adcgs_stereo_view *view, const uint32_t *part, uint32_t number,
                             float inverse, float t, adcgs_error *error)
{
    for (int y = 0; y < view->h; y++)
        for (int x = 0; x < view->w; x++) {
            adcgs_stereo_point p = {.t = t, .moves = 1, .size = (float)(1 / ((double)inverse * view->fx))};
            if (part[y * view->w + x] != number)
                continue;
            adcgs_stereo_rig_lift(view, x, y, 1 / (double)inverse, p.x);
            memcpy(p.rgb, view->pixels + 4 * (y * view->w + x), sizeof p.rgb);
            p.detail = adcgs_stereo_detail(view, x, y);
            ADCGS_TRY(adcgs_stereo_list_add(list, &p, error));
        }
    return ADCGS_OK;
}

static adcgs_status add_parts(adcgs_stereo_list *list, const adcgs_stereo_view *view, const uint32_t *part, uint32_t parts,
                              const float *inverse, float t, adcgs_error *error)
{
    for (uint32_t i = 2; i < parts; i++) {
        const float at = stands_on(part, i, inverse, view->w, view->h);
        if (at > 0)
            ADCGS_TRY(add_part(list, view, part, i, at, t, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_monocular_find_moving(adcgs_stereo_list *list, const adcgs_stereo_rig *rig, const adcgs_depths *depths, int m,
                                         adcgs_error *error)
{
    const adcgs_stereo_camera *camera = &rig->camera[m];
    const int w = camera->view.w, h = camera->view.h;
    const size_t plane = (size_t)w * (size_t)h;
    adcgs_stereo_view view = camera->view;
    float *inverse = fill(&camera->view, &depths[m], error), *pixels = adcgs_alloc(NULL, 4 * plane, sizeof *pixels, error);
    uint8_t *off = adcgs_alloc(NULL, plane, 1, error);
    uint32_t *part = adcgs_alloc(NULL, plane, sizeof *part, error);
    int *stack = adcgs_alloc(NULL, plane, sizeof *stack, error);
    adcgs_status status = inverse && pixels && off && part && stack ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        adcgs_stereo_rig_get_frame(camera, m, pixels);
        view.pixels = pixels;
        mark(camera, camera->frame[m], off, part);
        status = add_parts(list, &view, part, number_parts(part, w, h, stack), inverse, rig->frame_time[m], error);
    }
    adcgs_free(NULL, inverse);
    adcgs_free(NULL, pixels);
    adcgs_free(NULL, off);
    adcgs_free(NULL, part);
    adcgs_free(NULL, stack);
    return status;
}

/* ---- Velocity ---- */

/** Range of the points of frames m - 1 to m + 1: points[*first .. *end - 1]. On entry, *first is the previous start. */
static void beside(const adcgs_stereo_point *points, uint32_t n, const adcgs_stereo_rig *rig, int m, uint32_t *first,
                   uint32_t *end)
{
    const float from = rig->frame_time[ADCGS_MAX(m - 1, 0)], to = rig->frame_time[ADCGS_MIN(m + 1, rig->n_frames - 1)];
    while (*first < n && points[*first].t < from)
        ++*first;
    for (*end = *first; *end < n && points[*end].t <= to; ++*end)
        ;
}

/** Median of the velocities near a position, per axis. */
static void middle_about(const adcgs_stereo_point *points, uint32_t n, const double x[3], float velocity[3])
{
    double values[3][ALIKE_MOST];
    uint32_t about = 0, taken = 0, stride;
    for (uint32_t i = 0; i < n; i++)
        about += distance2(points[i].x, x) < ALIKE_REACH * ALIKE_REACH;
    stride = about / ALIKE_MOST + 1;
    for (uint32_t i = 0, k = 0; i < n; i++)
        if (distance2(points[i].x, x) < ALIKE_REACH * ALIKE_REACH && k++ % stride == 0) {
            for (int a = 0; a < 3; a++)
                values[a][taken] = (double)points[i].velocity[a];
            taken++;
        }
    for (int a = 0; a < 3; a++) {
        adcgs_sort(values[a], taken);
        velocity[a] = (float)values[a][taken / 2];
    }
}

adcgs_status adcgs_monocular_smooth_velocities(adcgs_stereo_point *points, uint32_t n, const adcgs_stereo_rig *rig,
                                               adcgs_error *error)
{
    float(*even)[3] = adcgs_alloc(NULL, (size_t)n + 1, sizeof *even, error);
    uint32_t first = 0, end = 0, i = 0;
    if (!even)
        return adcgs_alloc_status(error);
    for (int m = 0; m < rig->n_frames; m++) {
        beside(points, n, rig, m, &first, &end);
        for (; i < n && points[i].t <= rig->frame_time[m]; i++)
            middle_about(points + first, end - first, points[i].x, even[i]);
    }
    for (i = 0; i < n; i++)
        memcpy(points[i].velocity, even[i], sizeof even[i]);
    adcgs_free(NULL, even);
    return ADCGS_OK;
}
