/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The plane sweep. */
#include "init/plane_sweep.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    RADIUS = 2,            /* pixels: of a window */
    SIDE = 2 * RADIUS + 1, /* pixels */
    PLANES_LEAST = 24,     /* depths of a sweep, minimum */
    PLANES_MOST = 112      /* maximum; 320 are slower without gain on four scenes of five (doc/log/matching.md) */
};
#define WINDOW (SIDE * SIDE) /* pixels */
#define NOISE 1e-4f          /* variance of a window without texture, values of 0 to 1 */
/* Costs are shares of ADCGS_SWEEP_COST; chosen by hand, not measured. */
enum {
    UNLIKE_MOST = 120,                            /* maximum cost of uncorrelated windows */
    COLOUR_MOST = ADCGS_SWEEP_COST - UNLIKE_MOST, /* maximum cost of a colour difference */
    UNSEEN = 2 * ADCGS_SWEEP_COST                 /* cost of a position that a neighbour does not see */
};
enum { STILL_THERE = 100 }; /* cost where the view shows moving content and the neighbour shows background */
/* Maximum number of moving pixels in the window of a thin object; measured on rods and four scenes (doc/log/matching.md). */
enum { THIN = 12 };
#define SEEN_BY 2        /* neighbours; one alone is weak evidence if there are more */
#define COLOUR_OFF 0.15f /* colour difference of maximum cost, values of 0 to 1 */
/* Cost per unit of colour difference, summed over a window; arithmetic. */
#define COLOUR_SCALE (COLOUR_MOST / (3 * WINDOW * COLOUR_OFF))

/* ---- Planes ---- */

/** Mapping from a ray and inverse depth of one view to another image: (u, v, 1) ~ turn (ray, 1) + inverse * move. */
typedef struct passage {
    float turn[9], move[3];
    float fx, fy, cx, cy; /* for pixels counted from the centre of the first */
} passage;

static passage passage_of(const adcgs_stereo_view *from, const adcgs_stereo_view *to)
{
    passage p = {.fx = (float)to->fx, .fy = (float)to->fy, .cx = (float)(to->cx - 0.5), .cy = (float)(to->cy - 0.5)};
    for (int i = 0; i < 3; i++) {
        double move = 0;
        for (int j = 0; j < 3; j++) {
            double turn = 0;
            for (int k = 0; k < 3; k++)
                turn += to->rotation[3 * i + k] * from->rotation[3 * j + k];
            p.turn[3 * i + j] = (float)turn;
            move += to->rotation[3 * i + j] * (from->centre[j] - to->centre[j]);
        }
        p.move[i] = (float)move;
    }
    return p;
}

/** Distance in pixels between the positions of a pixel in another view at two depths; 0 if one is behind that camera. */
static double travel(const adcgs_stereo_view *v, const adcgs_stereo_view *to, int px, int py, double nearest, double farthest)
{
    double x[3], near_at[2] = {0, 0}, far_at[2] = {0, 0}, depth = 0;
    adcgs_stereo_rig_lift(v, px, py, nearest, x);
    const int sees_near = adcgs_stereo_rig_project(to, x, near_at, &depth) || depth > 1e-6;
    adcgs_stereo_rig_lift(v, px, py, farthest, x);
    const int sees_far = adcgs_stereo_rig_project(to, x, far_at, &depth) || depth > 1e-6;
    return sees_near && sees_far ? hypot(near_at[0] - far_at[0], near_at[1] - far_at[1]) : 0;
}

void adcgs_sweep_set_planes(adcgs_sweep *s, double nearest, double farthest)
{
    double most = 0;
    for (int i = 0; i < s->n_sources; i++)
        most = fmax(most, travel(s->view, s->source[i], s->view->w / 2, s->view->h / 2, nearest, farthest));
    s->planes = (int)fmin(fmax(ceil(most), PLANES_LEAST), PLANES_MOST);
    s->first = 1 / farthest;
    s->step = (1 / nearest - 1 / farthest) / (s->planes - 1);
}

/* ---- One neighbour, one plane ---- */

/** Statistics of the view's windows: of all pixels, or of the moving pixels in windows centred on one. */
typedef struct windows {
    float *over;          /* [s->h][s->w] 1 / number of pixels that count; 0: no window */
    float *mean, *spread; /* [s->h][s->w] */
} windows;

/** Arrays over the part with a margin of RADIUS, filled by repetition at the image border. */
typedef struct field {
    const adcgs_sweep *s;
    int w, h;          /* including the margin */
    float *ray[2];     /* [w], [h] of the view's pixels */
    float *own;        /* [h][w][4] pixels of the view */
    float *grey;       /* [h][w] of the view */
    windows window[2]; /* all pixels; moving pixels of thin objects */
    float *mask;       /* [h][w] 1: a pixel of the view counts in the latter */
    float *at[2];      /* [w] position of a row of pixels in the neighbour */
    float *other;      /* [w][4] colour there */
    uint8_t *inside;   /* [w] 1: inside the image */
    uint8_t *still;    /* [w] 1: background only */
    float *sum[4];     /* [h][w] neighbour's grey, its square, its product with the view's, difference of colour */
    float *down;       /* [s->h][w] sums of columns */
    float *total[4];   /* [s->h][s->w] sums of windows */
    uint8_t *seen;     /* [s->h][s->w] */
    uint8_t *against;  /* [s->h][s->w] 1: the view shows moving content, the neighbour background */
    int16_t *cost;     /* [n_sources][s->h][s->w] */
} field;

static inline float grey_of(const float *pixel)
{
    return (pixel[0] + pixel[1] + pixel[2]) * (1.0f / 3);
}

/** Sums over windows. */
static void add_windows(const field *f, const float *values, float *total)
{
    for (int y = 0; y < f->s->h; y++)
        for (int x = 0; x < f->w; x++) {
            const float *from = values + (size_t)y * (size_t)f->w + x;
            const size_t row = (size_t)f->w;
            f->down[y * f->w + x] = from[0] + from[row] + from[2 * row] + from[3 * row] + from[4 * row];
        }
    for (int y = 0; y < f->s->h; y++)
        for (int x = 0; x < f->s->w; x++) {
            const float *from = f->down + (size_t)y * (size_t)f->w + x;
            total[y * f->s->w + x] = from[0] + from[1] + from[2] + from[3] + from[4];
        }
}

static void project_row(const field *f, const passage *p, float inverse, int y)
{
    const float ry = f->ray[1][y];
    const float first[3] = {p->turn[1] * ry + p->turn[2] + inverse * p->move[0],
                            p->turn[4] * ry + p->turn[5] + inverse * p->move[1],
                            p->turn[7] * ry + p->turn[8] + inverse * p->move[2]};
    for (int x = 0; x < f->w; x++) {
        const float rx = f->ray[0][x], z = first[2] + p->turn[6] * rx, over = 1 / (z > 1e-4f ? z : -1e-4f);
        f->at[0][x] = (first[0] + p->turn[0] * rx) * over * p->fx + p->cx;
        f->at[1][x] = over < 0 ? -1 : (first[1] + p->turn[3] * rx) * over * p->fy + p->cy;
    }
}

/** Samples the neighbour at the positions of a row; outside the image, at its nearest pixels. */
static void sample_row(const field *f, const adcgs_stereo_view *v)
{
    const float most_u = (float)(v->w - 1), most_v = (float)(v->h - 1);
    const size_t row = 4 * (size_t)v->w;
    for (int x = 0; x < f->w; x++) {
        float u = f->at[0][x], w = f->at[1][x];
        const int inside = u >= 0 && w >= 0 && u <= most_u && w <= most_v;
        u = u > 0 ? ADCGS_MIN(u, most_u - 0.001f) : 0; /* also maps NaN to 0 */
        w = w > 0 ? ADCGS_MIN(w, most_v - 0.001f) : 0;
        const int iu = (int)u, iv = (int)w;
        const float a = u - (float)iu, b = w - (float)iv, *p = v->pixels + (size_t)iv * row + 4 * (size_t)iu, *q = p + row;
        const float p0 = (1 - a) * (1 - b), p1 = a * (1 - b), q0 = (1 - a) * b, q1 = a * b;
        float value[4]; /* a local copy without aliasing, so that compilers can vectorise */
        for (int c = 0; c < 4; c++)
            value[c] = p0 * p[c] + p1 * p[4 + c] + q0 * q[c] + q1 * q[4 + c];
        memcpy(f->other + 4 * x, value, sizeof value);
        f->inside[x] = (uint8_t)inside;
        f->still[x] = v->still && v->still[(int)(w + 0.5f) * v->w + (int)(u + 0.5f)];
    }
}

/** Warps the neighbour to the view under the assumption that the scene is on the plane. */
static void fetch(const field *f, const adcgs_stereo_view *source, const passage *p, float inverse)
{
    for (int y = 0; y < f->h; y++) {
        const size_t row = (size_t)y * (size_t)f->w;
        const float *own = f->own + 4 * row, *other = f->other, *grey = f->grey + row;
        float *sum[4] = {f->sum[0] + row, f->sum[1] + row, f->sum[2] + row, f->sum[3] + row};
        project_row(f, p, inverse, y);
        sample_row(f, source);
        for (int x = 0; x < f->w; x++) {
            const float g = grey_of(other + 4 * x);
            sum[0][x] = g;
            sum[1][x] = g * g;
            sum[2][x] = g * grey[x];
            sum[3][x] = fabsf(other[4 * x] - own[4 * x]) + fabsf(other[4 * x + 1] - own[4 * x + 1]) +
                        fabsf(other[4 * x + 2] - own[4 * x + 2]);
        }
        for (int x = 0; y >= RADIUS && y < f->h - RADIUS && x < f->s->w; x++) {
            const int at = (y - RADIUS) * f->s->w + x;
            f->seen[at] = f->inside[x + RADIUS] && other[4 * (x + RADIUS) + 3] > ADCGS_STEREO_KNOWN &&
                          own[4 * (x + RADIUS) + 3] > ADCGS_STEREO_KNOWN;
            f->against[at] = f->mask[row + (size_t)x + RADIUS] > 0 && f->still[x + RADIUS];
        }
    }
}

/** Lowers the costs to those of the view's windows. Integers, because compilers vectorise their comparisons. */
static void compare_windows(const field *f, const windows *own, int16_t *cost)
{
    const int n = f->s->w * f->s->h;
    for (int k = 0; k < 4; k++)
        add_windows(f, f->sum[k], f->total[k]);
    for (int i = 0; i < n; i++) {
        const float over = own->over[i], mean = f->total[0][i] * over;
        const float spread = fabsf(f->total[1][i] * over - mean * mean); /* negative by rounding only */
        const float both = f->total[2][i] * over - mean * own->mean[i];
        const float alike = both / sqrtf((spread + NOISE) * (own->spread[i] + NOISE));
        const int unlike = (int)((1 - alike) * UNLIKE_MOST), off = (int)(f->total[3][i] * (over * WINDOW) * COLOUR_SCALE);
        const int value = ADCGS_MIN(unlike, UNLIKE_MOST) + ADCGS_MIN(off, COLOUR_MOST) + STILL_THERE * f->against[i];
        const int limited = f->seen[i] && over > 0 ? ADCGS_MIN(value, ADCGS_SWEEP_COST) : UNSEEN;
        cost[i] = (int16_t)ADCGS_MIN(cost[i], limited);
    }
}

/**
 * The window of a thin object shows mostly background, which has another position in the neighbour. So moving pixels are also
 * compared alone.
 */
static void compare(const field *f, int16_t *cost)
{
    for (int i = 0; i < f->s->w * f->s->h; i++)
        cost[i] = UNSEEN;
    compare_windows(f, &f->window[0], cost);
    if (!f->s->view->moves)
        return;
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < f->w * f->h; i++)
            f->sum[k][i] *= f->mask[i];
    compare_windows(f, &f->window[1], cost);
}

/* ---- All neighbours ---- */

/** Mean of the better half of the neighbours that see a position. */
static int16_t better_half(const int16_t *cost, size_t stride, int n)
{
    int best[ADCGS_SWEEP_SOURCES], sum = 0, seen = 0;
    for (int i = 0; i < n; i++) {
        const int c = cost[(size_t)i * stride];
        int k = seen;
        if (c >= UNSEEN)
            continue;
        for (seen++; k > 0 && best[k - 1] > c; k--)
            best[k] = best[k - 1];
        best[k] = c;
    }
    if (seen < SEEN_BY && n >= SEEN_BY)
        return (int16_t)(seen ? (best[0] + ADCGS_SWEEP_COST) / 2 : ADCGS_SWEEP_COST);
    const int half = (seen + 1) / 2;
    for (int i = 0; i < half; i++)
        sum += best[i];
    return (int16_t)(half ? sum / half : ADCGS_SWEEP_COST);
}

static void field_free(field *f)
{
    for (int k = 0; k < 4; k++) {
        adcgs_free(NULL, f->sum[k]);
        adcgs_free(NULL, f->total[k]);
    }
    for (int k = 0; k < 2; k++) {
        adcgs_free(NULL, f->ray[k]);
        adcgs_free(NULL, f->at[k]);
    }
    adcgs_free(NULL, f->own);
    adcgs_free(NULL, f->other);
    adcgs_free(NULL, f->inside);
    adcgs_free(NULL, f->still);
    adcgs_free(NULL, f->grey);
    for (int k = 0; k < 2; k++) {
        adcgs_free(NULL, f->window[k].over);
        adcgs_free(NULL, f->window[k].mean);
        adcgs_free(NULL, f->window[k].spread);
    }
    adcgs_free(NULL, f->down);
    adcgs_free(NULL, f->mask);
    adcgs_free(NULL, f->seen);
    adcgs_free(NULL, f->against);
    adcgs_free(NULL, f->cost);
}

static adcgs_status field_alloc(field *f, const adcgs_sweep *s, adcgs_error *error)
{
    *f = (field){.s = s, .w = s->w + 2 * RADIUS, .h = s->h + 2 * RADIUS};
    const size_t whole = (size_t)f->w * (size_t)f->h, part = (size_t)s->w * (size_t)s->h;
    int good = 1;
    for (int k = 0; k < 4; k++) {
        good &= (f->sum[k] = adcgs_alloc(NULL, whole, sizeof(float), error)) != NULL;
        good &= (f->total[k] = adcgs_alloc(NULL, part, sizeof(float), error)) != NULL;
    }
    for (int k = 0; k < 2; k++) {
        good &= (f->ray[k] = adcgs_alloc(NULL, (size_t)(k ? f->h : f->w), sizeof(float), error)) != NULL;
        good &= (f->at[k] = adcgs_alloc(NULL, (size_t)f->w, sizeof(float), error)) != NULL;
    }
    good &= (f->own = adcgs_alloc(NULL, 4 * whole, sizeof *f->own, error)) != NULL;
    good &= (f->other = adcgs_alloc(NULL, 4 * (size_t)f->w, sizeof *f->other, error)) != NULL;
    good &= (f->inside = adcgs_alloc(NULL, (size_t)f->w, 1, error)) != NULL;
    good &= (f->still = adcgs_alloc(NULL, (size_t)f->w, 1, error)) != NULL;
    good &= (f->grey = adcgs_alloc(NULL, whole, sizeof *f->grey, error)) != NULL;
    for (int k = 0; k < 2; k++) {
        good &= (f->window[k].over = adcgs_alloc(NULL, part, sizeof(float), error)) != NULL;
        good &= (f->window[k].mean = adcgs_alloc(NULL, part, sizeof(float), error)) != NULL;
        good &= (f->window[k].spread = adcgs_alloc(NULL, part, sizeof(float), error)) != NULL;
    }
    good &= (f->down = adcgs_alloc(NULL, (size_t)s->h * (size_t)f->w, sizeof *f->down, error)) != NULL;
    good &= (f->mask = adcgs_alloc(NULL, whole, sizeof *f->mask, error)) != NULL;
    good &= (f->seen = adcgs_alloc(NULL, part, 1, error)) != NULL;
    good &= (f->against = adcgs_alloc(NULL, part, 1, error)) != NULL;
    good &= (f->cost = adcgs_alloc(NULL, part * (size_t)ADCGS_MAX(s->n_sources, 1), sizeof *f->cost, error)) != NULL;
    return good ? ADCGS_OK : adcgs_alloc_status(error);
}

/** Sets the windows over the pixels of the mask, if they contain at most `most` of them. */
static void set_windows(field *f, windows *own, float most)
{
    for (int i = 0; i < f->w * f->h; i++) {
        f->sum[0][i] = f->mask[i] * f->grey[i];
        f->sum[1][i] = f->sum[0][i] * f->grey[i];
    }
    add_windows(f, f->mask, own->over);
    add_windows(f, f->sum[0], own->mean);
    add_windows(f, f->sum[1], own->spread);
    for (int y = 0; y < f->s->h; y++)
        for (int x = 0; x < f->s->w; x++) {
            const int i = y * f->s->w + x;
            const int is = f->mask[(y + RADIUS) * f->w + x + RADIUS] > 0 && own->over[i] <= most;
            own->over[i] = is ? 1 / own->over[i] : 0;
            own->mean[i] *= own->over[i];
            own->spread[i] = fmaxf(own->spread[i] * own->over[i] - own->mean[i] * own->mean[i], 0);
        }
}

/** Index of the view's pixel at a position of the field, clamped to the image. */
static int pixel_of(const field *f, int i)
{
    const adcgs_stereo_view *v = f->s->view;
    const int x = ADCGS_MIN(ADCGS_MAX(f->s->x + i % f->w - RADIUS, 0), v->w - 1);
    return ADCGS_MIN(ADCGS_MAX(f->s->y + i / f->w - RADIUS, 0), v->h - 1) * v->w + x;
}

static void field_fill(field *f)
{
    const adcgs_stereo_view *v = f->s->view;
    for (int i = 0; i < f->w * f->h; i++) {
        const int pixel = pixel_of(f, i), px = pixel % v->w, py = pixel / v->w;
        memcpy(f->own + 4 * i, v->pixels + 4 * pixel, 4 * sizeof *f->own);
        f->grey[i] = grey_of(f->own + 4 * i);
        f->mask[i] = 1;
        f->ray[0][i % f->w] = (float)((px + 0.5 - v->cx) / v->fx);
        f->ray[1][i / f->w] = (float)((py + 0.5 - v->cy) / v->fy);
    }
    set_windows(f, &f->window[0], WINDOW);
    if (!v->moves)
        return;
    for (int i = 0; i < f->w * f->h; i++)
        f->mask[i] = v->moves[pixel_of(f, i)];
    set_windows(f, &f->window[1], THIN);
}

adcgs_status adcgs_sweep_run(const adcgs_sweep *s, int16_t *cost, adcgs_error *error)
{
    field f;
    passage way[ADCGS_SWEEP_SOURCES];
    const size_t part = (size_t)s->w * (size_t)s->h;
    const adcgs_status status = field_alloc(&f, s, error);
    if (status == ADCGS_OK)
        field_fill(&f);
    for (int i = 0; i < s->n_sources; i++)
        way[i] = passage_of(s->view, s->source[i]);
    for (int k = 0; k < s->planes && status == ADCGS_OK; k++) {
        for (int i = 0; i < s->n_sources; i++) {
            fetch(&f, s->source[i], &way[i], (float)(s->first + k * s->step));
            compare(&f, f.cost + (size_t)i * part);
        }
        for (size_t i = 0; i < part; i++)
            cost[i * (size_t)s->planes + (size_t)k] = better_half(f.cost + i, part, s->n_sources);
    }
    field_free(&f);
    return status;
}
