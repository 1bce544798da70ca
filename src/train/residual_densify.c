/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What is missing. */
#include "train/residual_densify.h"

#include "train/views.h"

#include <math.h>
#include <stdlib.h>

enum { VIEWS_MOST = 32, VIEWS_LEAST = 3, PIXELS_MOST = 256, DEPTHS = 256 };
#define DIFFERENCE 0.08f /* of a pixel that is followed */
#define NEAREST 0.25f    /* of a ray, scene units */
#define FARTHEST 8.0f
#define AGREES 0.4f      /* share of the pixel's difference that another camera has to show */

typedef struct look {
    const adcgs_train_view *view;
    int w, h;
    float *off;   /* [h][w] taken - drawn, mean of the channels */
    float *more;  /* [h][w] the most of it about a pixel */
    float *taken; /* [3][h][w] as the mean camera would have taken it */
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

/** The most that is missing about each pixel: rays are followed in steps of several. */
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
    const adcgs_train_view *v = &t->views[index];
    const int w = l->w = v->view.width, h = l->h = v->view.height;
    const size_t plane = (size_t)w * (size_t)h;
    l->view = v;
    l->off = adcgs_alloc(NULL, 5 * plane, sizeof *l->off, error);
    if (!l->off)
        return adcgs_alloc_status(error);
    l->more = l->off + plane;
    l->taken = l->more + plane;
    ADCGS_TRY(adcgs_view_draw(t, &v->view, t->image, 0, error));
    const float *target;
    ADCGS_TRY(adcgs_trainer_target(t, index, NULL, &target, error));
    memcpy(l->taken, target, 3 * plane * sizeof *l->taken);
    for (size_t i = 0; i < plane; i++)
        l->off[i] = ((l->taken[i] + l->taken[plane + i] + l->taken[2 * plane + i]) -
                     (t->image[i] + t->image[plane + i] + t->image[2 * plane + i])) / 3;
    spread(l);
    return ADCGS_OK;
}

/** Where along a pixel's ray the other cameras agree the most that something is missing. 0 if too few do. */
static int place_of(const look *looks, int n, int own, pixel p, adcgs_residual *place)
{
    const look *l = &looks[own];
    const adcgs_view *v = &l->view->view;
    const float ray[2] = { ((float)(p.at % l->w) + 0.5f - v->cx) / v->fx, ((float)(p.at / l->w) + 0.5f - v->cy) / v->fy };
    place->score = 0;
    for (int step = 0; step < DEPTHS; step++) {
        const float share = (float)step / (DEPTHS - 1), d = 1 / (1 / NEAREST + share * (1 / FARTHEST - 1 / NEAREST));
        const float c[3] = { ray[0] * d - v->translation[0], ray[1] * d - v->translation[1], d - v->translation[2] };
        float x[3], sum = 0;
        int seen = 0, agree = 0;
        for (int a = 0; a < 3; a++)
            x[a] = v->rotation[a] * c[0] + v->rotation[3 + a] * c[1] + v->rotation[6 + a] * c[2];
        for (int i = 0; i < n; i++) {
            size_t at;
            if (i == own || !adcgs_view_pixel(&looks[i].view->view, x, &at))
                continue;
            const float off = looks[i].more[at];
            seen++;
            agree += off >= AGREES * p.off;
            sum += fminf(off, p.off);
        }
        if (agree < VIEWS_LEAST - 1 || 4 * agree < 3 * seen || sum <= place->score)
            continue;
        memcpy(place->x, x, sizeof x);
        place->score = sum;
        place->size = d / v->fx;
    }
    return place->score > 0;
}

static adcgs_status follow(const look *looks, int n, int own, adcgs_residual *places, uint32_t most, uint32_t *total,
                           adcgs_error *error)
{
    const look *l = &looks[own];
    pixel *list = adcgs_alloc(NULL, (size_t)l->w * (size_t)l->h, sizeof *list, error);
    uint32_t count = 0, found = 0;
    if (!list)
        return adcgs_alloc_status(error);
    for (int i = 0; i < l->w * l->h; i++)
        if (l->more[i] > DIFFERENCE && l->off[i] == l->more[i])
            list[count++] = (pixel){ l->more[i], i };
    qsort(list, count, sizeof *list, by_difference);
    for (uint32_t i = 0; i < ADCGS_MIN(count, PIXELS_MOST) && found < most; i++) {
        if (!place_of(looks, n, own, list[i], &places[found]))
            continue;
        for (int c = 0; c < 3; c++)
            places[found].rgb[c] = l->taken[(size_t)c * (size_t)l->w * (size_t)l->h + (size_t)list[i].at];
        found++;
    }
    adcgs_free(NULL, list);
    *total += found;
    return ADCGS_OK;
}

/**
 * Whether a view, the index-th of so many at a moment, is one of the VIEWS_MOST that are looked at: spread evenly over all, and
 * others each time.
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
    look looks[VIEWS_MOST] = { { NULL, 0, 0, NULL, NULL, NULL } };
    const float moment = t->views[t->curriculum.views[t->iteration % t->curriculum.n].index].t;
    int count = 0;
    adcgs_status status = ADCGS_OK;
    *n = 0;
    adcgs_pass_forward(t->pass, t->f, moment, &(adcgs_pass_mode){ .deform = ADCGS_DEFORM_COARSE });
    uint32_t there = 0, seen = 0;
    for (uint32_t i = 0; i < t->n_views; i++)
        there += t->views[i].t == moment;
    for (uint32_t i = 0; i < t->n_views && status == ADCGS_OK; i++)
        if (t->views[i].t == moment && is_taken(seen++, there, t->iteration))
            status = draw(t, &looks[count++], i, error);
    for (int i = 0; status == ADCGS_OK && count >= VIEWS_LEAST && i < count; i++)
        status = follow(looks, count, i, places + *n, ADCGS_MIN(most - *n, most / (uint32_t)count), n, error);
    qsort(places, *n, sizeof *places, by_score);
    for (int i = 0; i < count; i++)
        adcgs_free(NULL, looks[i].off);
    return status;
}
