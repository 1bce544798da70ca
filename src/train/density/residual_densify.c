/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Densification from residuals. */
#include "train/density/residual_densify.h"

#include "train/train_views.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    VIEWS_MOST = 32,   /* maximum number of views of the frame */
    VIEWS_LEAST = 3,   /* minimum number of views of the frame */
    PIXELS_MOST = 256, /* maximum number of rays of a view */
    DEPTHS = 256       /* depth steps of a ray */
};
enum {
    SLACK = 3, /* depth steps within which neighbours agree */
    /*
     * Minimum number of agreeing neighbours if only one other camera sees the point; calibrated on zju
     * (doc/log/densification.md).
     */
    VOTES_LEAST = 3
};
#define DIFFERENCE 0.08f /* minimum residual of a pixel whose ray is searched */
#define NEAREST 0.25f    /* scene units: minimum depth of a ray */
#define FARTHEST 8.0f    /* scene units: maximum depth of a ray */
#define AGREES 0.4f      /* share of the pixel's residual that another camera must show */

typedef struct look {
    const adcgs_train_view *view;
    int w, h;
    float *off;   /* [h][w] recorded - rendered, mean of the channels */
    float *more;  /* [h][w] its maximum over the 3x3 window */
    float *taken; /* [3][h][w] recorded image as the mean camera would show it */
} look;

typedef struct pixel {
    float off;
    int at;
} pixel;

static int by_difference(const void *a, const void *b)
{
    const pixel *p = a, *q = b;
    return p->off != q->off ? (p->off < q->off) - (p->off > q->off) : (p->at > q->at) - (p->at < q->at);
}

static int by_score(const void *a, const void *b)
{
    const adcgs_residual *p = a, *q = b;
    return p->score != q->score ? (p->score < q->score) - (p->score > q->score) : memcmp(p->x, q->x, sizeof p->x);
}

/** Maximum residual around each pixel, because rays are sampled in steps of several pixels. */
static void spread(look *l)
{
    for (int y = 0; y < l->h; y++)
        for (int x = 0; x < l->w; x++) {
            float most = l->off[y * l->w + x];
            for (int b = ADCGS_MAX(y - 1, 0); b <= ADCGS_MIN(y + 1, l->h - 1); b++)
                for (int a = ADCGS_MAX(x - 1, 0); a <= ADCGS_MIN(x + 1, l->w - 1); a++)
                    most = fmaxf(most, l->off[b * l->w + a]);
            l->more[y * l->w + x] = most;
        }
}

static adcgs_status draw(adcgs_trainer *t, look *l, uint32_t index, adcgs_error *error)
{
    const adcgs_train_view *v = &t->views.list[index];
    const int w = l->w = v->view.width, h = l->h = v->view.height;
    const size_t plane = (size_t)w * (size_t)h;
    l->view = v;
    l->off = adcgs_alloc(NULL, 5 * plane, sizeof *l->off, error);
    if (!l->off)
        return adcgs_alloc_status(error);
    l->more = l->off + plane;
    l->taken = l->more + plane;
    ADCGS_TRY(adcgs_view_render(t, &v->view, index, t->image, 0, error));
    const float *target;
    ADCGS_TRY(adcgs_trainer_target(t, index, NULL, &target, error));
    memcpy(l->taken, target, 3 * plane * sizeof *l->taken);
    for (size_t i = 0; i < plane; i++)
        l->off[i] = ((l->taken[i] + l->taken[plane + i] + l->taken[2 * plane + i]) -
                     (t->image[i] + t->image[plane + i] + t->image[2 * plane + i])) /
                    3;
    spread(l);
    return ADCGS_OK;
}

/** Rays of a view's pixels with large residuals, and the residuals of other cameras along them. */
typedef struct rays {
    uint32_t n;
    pixel pixel[PIXELS_MOST];
    float agreed[PIXELS_MOST][DEPTHS];  /* sum of the other cameras' residuals; 0: less than 3/4 of those that see it agree */
    uint8_t alone[PIXELS_MOST][DEPTHS]; /* 1: only one other camera sees the point */
    uint8_t about[PIXELS_MOST][DEPTHS]; /* 1: the cameras agree near this depth */
} rays;

static float depth_of(int step)
{
    return 1 / (1 / FARTHEST + (float)step / (DEPTHS - 1) * (1 / NEAREST - 1 / FARTHEST));
}

/** The point at a depth on a pixel's ray. */
static void lift(const look *l, int at, float d, float x[3])
{
    const adcgs_view *v = &l->view->view;
    const float ray[2] = {((float)(at % l->w) + 0.5f - v->cx) / v->fx, ((float)(at / l->w) + 0.5f - v->cy) / v->fy};
    const float c[3] = {ray[0] * d - v->translation[0], ray[1] * d - v->translation[1], d - v->translation[2]};
    for (int a = 0; a < 3; a++)
        x[a] = v->rotation[a] * c[0] + v->rotation[3 + a] * c[1] + v->rotation[6 + a] * c[2];
}

/** Compares the residuals of the other cameras at points along a pixel's ray. */
static void ask(const look *looks, int n, int own, rays *r, uint32_t i)
{
    const pixel p = r->pixel[i];
    memset(r->about[i], 0, sizeof r->about[i]);
    for (int step = 0; step < DEPTHS; step++) {
        float x[3], sum = 0;
        int seen = 0, agree = 0;
        lift(&looks[own], p.at, depth_of(step), x);
        for (int k = 0; k < n; k++) {
            size_t at;
            if (k == own || !adcgs_view_pixel(&looks[k].view->view, x, &at))
                continue;
            seen++;
            agree += looks[k].more[at] >= AGREES * p.off;
            sum += fminf(looks[k].more[at], p.off);
        }
        r->alone[i][step] = seen == 1;
        r->agreed[i][step] = agree > 0 && (seen == 1 || agree > 1) && 4 * agree >= 3 * seen ? sum : 0;
        for (int d = ADCGS_MAX(step - SLACK, 0); r->agreed[i][step] > 0 && d <= ADCGS_MIN(step + SLACK, DEPTHS - 1); d++)
            r->about[i][d] = 1;
    }
}

/** Counts, for each depth, the rays of nearby pixels that also agree near it. \return the number of nearby pixels. */
static int count_near(const rays *r, uint32_t i, int w, int votes[DEPTHS])
{
    const int px = r->pixel[i].at % w, py = r->pixel[i].at / w;
    int n = 0;
    memset(votes, 0, DEPTHS * sizeof *votes);
    for (uint32_t k = 0; k < r->n; k++) {
        const int dx = r->pixel[k].at % w - px, dy = r->pixel[k].at / w - py;
        if (k == i || 64 * (dx * dx + dy * dy) > w * w)
            continue;
        n++;
        for (int step = 0; step < DEPTHS; step++)
            votes[step] += r->about[k][step];
    }
    return n;
}

/**
 * Finds the depth step of a residual on a pixel's ray, or -1. It is the step where the most cameras and the most nearby pixels
 * agree, because nearby pixels mostly have similar depths. A pair of cameras needs support from nearby pixels.
 */
static int settle(const rays *r, uint32_t i, int w, float *score)
{
    int votes[DEPTHS], first = -1, last = -1;
    const int near = count_near(r, i, w, votes);
    *score = 0;
    for (int step = 0; step < DEPTHS; step++) { /* the farthest first: a point that is too near occludes other cameras */
        const float s = r->agreed[i][step] * (float)(1 + votes[step]) / (float)(1 + near);
        if (r->alone[i][step] && (votes[step] < VOTES_LEAST || 2 * votes[step] < near))
            continue;
        if (s > *score) {
            *score = s;
            first = last = step;
        } else if (s >= *score && last == step - 1)
            last = step;
    }
    return *score > 0 ? (first + last) / 2 : -1;
}

/** Selects the pixels with the largest residuals of a view. */
static adcgs_status pick(rays *r, const look *l, adcgs_error *error)
{
    pixel *list = adcgs_alloc(NULL, (size_t)l->w * (size_t)l->h, sizeof *list, error);
    uint32_t count = 0;
    if (!list)
        return adcgs_alloc_status(error);
    for (int i = 0; i < l->w * l->h; i++)
        if (l->more[i] > DIFFERENCE && l->off[i] == l->more[i])
            list[count++] = (pixel){l->more[i], i};
    qsort(list, count, sizeof *list, by_difference);
    r->n = ADCGS_MIN(count, PIXELS_MOST);
    memcpy(r->pixel, list, r->n * sizeof *list);
    adcgs_free(NULL, list);
    return ADCGS_OK;
}

static adcgs_status follow(const look *looks, int n, int own, rays *r, adcgs_residual *places, uint32_t most, uint32_t *total,
                           adcgs_error *error)
{
    const look *l = &looks[own];
    const size_t plane = (size_t)l->w * (size_t)l->h;
    uint32_t found = 0;
    ADCGS_TRY(pick(r, l, error));
    for (uint32_t i = 0; i < r->n; i++)
        ask(looks, n, own, r, i);
    for (uint32_t i = 0; i < r->n && found < most; i++) {
        adcgs_residual *p = &places[found];
        const int step = settle(r, i, l->w, &p->score);
        if (step < 0)
            continue;
        found++;
        lift(l, r->pixel[i].at, depth_of(step), p->x);
        p->size = depth_of(step) / l->view->view.fx;
        for (int c = 0; c < 3; c++)
            p->rgb[c] = l->taken[(size_t)c * plane + (size_t)r->pixel[i].at];
    }
    *total += found;
    return ADCGS_OK;
}

/**
 * True if a view, given by its index in a frame of `views` views, is one of the VIEWS_MOST to use. They are evenly spread and
 * vary with `turn`.
 */
static int is_taken(uint32_t index, uint32_t views, uint32_t turn)
{
    if (views <= VIEWS_MOST)
        return 1;
    const uint64_t at = (index + turn) % views;
    return (at + 1) * VIEWS_MOST / views > at * VIEWS_MOST / views;
}

adcgs_status adcgs_residual_find(adcgs_trainer *t, adcgs_residual *places, uint32_t most, uint32_t *n, adcgs_error *error)
{
    look looks[VIEWS_MOST] = {{NULL, 0, 0, NULL, NULL, NULL}};
    const float when = t->views.list[t->curriculum.views[t->run.iteration % t->curriculum.n].index].t;
    int count = 0;
    adcgs_status status = ADCGS_OK;
    rays *r = adcgs_alloc(NULL, 1, sizeof *r, error);
    *n = 0;
    if (!r)
        return adcgs_alloc_status(error);
    adcgs_pass_forward(t->pass, t->f, when, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_COARSE});
    uint32_t there = 0, seen = 0;
    for (uint32_t i = 0; i < t->views.n; i++)
        there += t->views.list[i].t == when;
    for (uint32_t i = 0; i < t->views.n && status == ADCGS_OK; i++)
        if (t->views.list[i].t == when && is_taken(seen++, there, t->run.iteration))
            status = draw(t, &looks[count++], i, error);
    for (int i = 0; status == ADCGS_OK && count >= VIEWS_LEAST && i < count; i++)
        status = follow(looks, count, i, r, places + *n, ADCGS_MIN(most - *n, most / (uint32_t)count), n, error);
    qsort(places, *n, sizeof *places, by_score);
    for (int i = 0; i < count; i++)
        adcgs_free(NULL, looks[i].off);
    adcgs_free(NULL, r);
    return status;
}
