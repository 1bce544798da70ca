/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Search for points of other cameras in a camera's image. */
#include "init/correspondence.h"

#include "init/match_window.h"

#include <math.h>

/* Pixels: window, definition of match_window.h. */
enum { SIDE = ADCGS_WINDOW_SIDE, RADIUS = SIDE / 2, WINDOW = ADCGS_WINDOW };
/* Chosen by hand, not measured one by one; checked with the pose outliers on 44 scenes (pose_outlier.c). */
enum { CELL = 3 };   /* pixels between candidate keypoints */
enum { BESIDE = 2 }; /* pixels: radius around a match; a similar window outside it makes the match ambiguous */
#define ALIKE 0.88f  /* minimum correlation of a match */
#define SHARP 0.04f  /* minimum decrease of the correlation one pixel away */
#define UNIQUE 0.06f /* minimum lead over all windows outside the radius */
#define SMALLEST 0.5 /* minimum scale between the windows in the two images */
#define LARGEST 2.0  /* maximum scale between them */

/* ---- Windows ---- */

/** Inverse norm of the window around a pixel, after subtraction of its mean. */
static float over_of(const float *grey, const uint8_t *known, int w, int x, int y)
{
    float sum = 0, square = 0;
    for (int j = y - RADIUS; j <= y + RADIUS; j++)
        for (int i = x - RADIUS; i <= x + RADIUS; i++) {
            if (!known[j * w + i])
                return 0;
            sum += grey[j * w + i];
            square += grey[j * w + i] * grey[j * w + i];
        }
    square -= sum * sum * (1.0f / WINDOW);
    return square > WINDOW * ADCGS_WINDOW_TEXTURE ? 1 / sqrtf(square) : 0;
}

/** Correlations of a window, of mean 0 and norm 1, with the windows around n consecutive pixels of a row. */
static void compare_row(const adcgs_patch_image *o, const float own[WINDOW], int x, int y, int n, float *alike)
{
    const int w = o->view->w;
    for (int i = 0; i < n; i++)
        alike[i] = 0;
    for (int b = 0; b < SIDE; b++)
        for (int a = 0; a < SIDE; a++) {
            const float weight = own[b * SIDE + a], *const grey = o->grey + (y + b - RADIUS) * w + x + a - RADIUS;
            for (int i = 0; i < n; i++)
                alike[i] += weight * grey[i];
        }
    for (int i = 0; i < n; i++)
        alike[i] *= o->over[y * w + x + i];
}

/** True if the correlation decreases to all sides. */
static int is_peak(const float *alike, int w)
{
    const float least = alike[0] - SHARP;
    return alike[-1] < least && alike[1] < least && alike[-w] < least && alike[w] < least;
}

/** True if a pixel is a keypoint: no adjacent window is similar. */
static int is_keypoint(const adcgs_patch_image *o, int x, int y)
{
    float own[WINDOW], alike[9];
    const double at[2] = {x + 0.5, y + 0.5};
    if (!(o->over[y * o->view->w + x] > 0) ||
        !(adcgs_window_sample(own, o->view, at, (const double[]){1, 0}, (const double[]){0, 1}) > ADCGS_WINDOW_TEXTURE))
        return 0;
    for (int j = 0; j < 3; j++)
        compare_row(o, own, x - 1, y + j - 1, 3, alike + 3 * j);
    return is_peak(alike + 4, 3);
}

/** Chooses an even subset of the candidates, at most ADCGS_KEYPOINTS_MAX. */
static void choose_keypoints(adcgs_patch_image *o, const adcgs_depths *d)
{
    const int w = o->view->w, h = o->view->h;
    int all = 0;
    for (int pass = 0, seen = 0; pass < 2; pass++)
        for (int y = RADIUS + 1; y < h - RADIUS - 1; y += CELL)
            for (int x = RADIUS + 1; x < w - RADIUS - 1; x += CELL) {
                const int i = (y - d->y) * d->w + x - d->x;
                if (x < d->x || y < d->y || x >= d->x + d->w || y >= d->y + d->h || d->quality[i] == ADCGS_DEPTH_NONE ||
                    !is_keypoint(o, x, y))
                    continue;
                all += !pass;
                if (pass && (int64_t)seen++ * ADCGS_KEYPOINTS_MAX / ADCGS_MAX(all, ADCGS_KEYPOINTS_MAX) >= o->n_keypoints)
                    o->keypoint[o->n_keypoints++] = (adcgs_keypoint){x, y, 1 / (double)d->inverse[i]};
            }
}

adcgs_status adcgs_patch_image_init(adcgs_patch_image *o, const adcgs_stereo_view *view, const uint8_t *unstable,
                                    const adcgs_depths *depths, adcgs_error *error)
{
    const int w = view->w, h = view->h, n = w * h;
    uint8_t *known = adcgs_alloc(NULL, (size_t)n, 1, error);
    o->view = view;
    o->grey = adcgs_alloc(NULL, (size_t)n, sizeof *o->grey, error);
    o->over = adcgs_alloc(NULL, (size_t)n, sizeof *o->over, error);
    if (known && o->grey && o->over) {
        for (int i = 0; i < n; i++) {
            const float *const p = view->pixels + 4 * (size_t)i;
            o->grey[i] = (p[0] + p[1] + p[2]) * (1.0f / 3);
            known[i] = p[3] > ADCGS_STEREO_KNOWN && !unstable[i];
        }
        for (int y = RADIUS; y < h - RADIUS; y++)
            for (int x = RADIUS; x < w - RADIUS; x++)
                o->over[y * w + x] = over_of(o->grey, known, w, x, y);
        if (depths->quality)
            choose_keypoints(o, depths);
    }
    adcgs_free(NULL, known);
    return known && o->grey && o->over ? ADCGS_OK : adcgs_alloc_status(error);
}

void adcgs_patch_image_clear(adcgs_patch_image *o)
{
    adcgs_free(NULL, o->grey);
    adcgs_free(NULL, o->over);
    *o = (adcgs_patch_image){.n_keypoints = 0};
}

/* ---- Search ---- */

/** The rectangle to search: from x0, y0 up to, but not including, x1, y1. */
typedef struct field {
    int x0, y0, x1, y1;
} field;

static field field_about(const adcgs_stereo_view *v, const double at[2], int reach)
{
    field f = {RADIUS, RADIUS, v->w - RADIUS, v->h - RADIUS};
    if (reach) {
        const int x = (int)floor(at[0]), y = (int)floor(at[1]);
        f = (field){ADCGS_MAX(f.x0, x - reach), ADCGS_MAX(f.y0, y - reach), ADCGS_MIN(f.x1, x + reach + 1),
                    ADCGS_MIN(f.y1, y + reach + 1)};
    }
    return f;
}

/** Finds the unique pixel of the field with a similar window, to a fraction of a pixel. Returns 0 if there is none. */
static int find_match(const adcgs_patch_image *in, const float own[WINDOW], const field *f, float *alike, double at[2])
{
    const int w = f->x1 - f->x0, h = f->y1 - f->y0;
    int best = -1;
    for (int y = 0; y < h; y++)
        compare_row(in, own, f->x0, f->y0 + y, w, alike + y * w);
    for (int y = 1; y < h - 1; y++)
        for (int i = y * w + 1; i < y * w + w - 1; i++)
            if (alike[i] > (best < 0 ? ALIKE : alike[best]))
                best = i;
    if (best < 0 || !is_peak(alike + best, w))
        return 0;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            if (alike[y * w + x] > alike[best] - UNIQUE && (abs(x - best % w) > BESIDE || abs(y - best / w) > BESIDE))
                return 0;
    const float *const p = alike + best;
    at[0] = f->x0 + best % w + 0.5 + 0.5 * (double)((p[-1] - p[1]) / (p[-1] - 2 * p[0] + p[1]));
    at[1] = f->y0 + best / w + 0.5 + 0.5 * (double)((p[-w] - p[w]) / (p[-w] - 2 * p[0] + p[w]));
    return 1;
}

/** Inverts the derivatives of the mapping between the images. Returns 0 if the scale is out of range. */
static int turn_round(double right[2], double down[2])
{
    const double a = right[0], b = down[0], c = right[1], d = down[1], det = a * d - b * c;
    if (!(det > SMALLEST * SMALLEST && det < LARGEST * LARGEST && a * a + c * c < LARGEST * LARGEST &&
          b * b + d * d < LARGEST * LARGEST))
        return 0;
    right[0] = d / det;
    right[1] = -c / det;
    down[0] = -b / det;
    down[1] = a / det;
    return 1;
}

void adcgs_correspondences_add(adcgs_correspondences *s, const adcgs_patch_image *in, const adcgs_stereo_view *pose,
                               const adcgs_patch_image *other, int from, int every, int reach, float *alike)
{
    for (int i = 0; i < other->n_keypoints && s->n < ADCGS_CORRESPONDENCES_MAX; i += every) {
        const adcgs_keypoint *const m = &other->keypoint[i];
        const double own_at[2] = {m->px + 0.5, m->py + 0.5};
        double at[2] = {0, 0}, right[2] = {1, 0}, down[2] = {0, 1};
        float own[WINDOW];
        if (reach && (!adcgs_window_pass(other->view, pose, m->px, m->py, m->depth, at, right, down) ||
                      !turn_round(right, down) || !(at[0] >= 0 && at[1] >= 0 && at[0] < pose->w && at[1] < pose->h)))
            continue;
        const field f = field_about(in->view, at, reach);
        adcgs_correspondence *const match = &s->match[s->n];
        if (f.x1 - f.x0 < 3 || f.y1 - f.y0 < 3 ||
            !(adcgs_window_sample(own, other->view, own_at, right, down) > ADCGS_WINDOW_TEXTURE) ||
            !find_match(in, own, &f, alike, match->at))
            continue;
        adcgs_stereo_rig_lift(other->view, m->px, m->py, m->depth, match->x);
        match->from = from;
        s->n++;
    }
}
