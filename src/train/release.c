/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Settled anchors that learn again. */
#include "train/release.h"

#include "train/anchor_set.h"
#include "train/views.h"

#include <math.h>
#include <stdlib.h>

enum { TIMES = 3, MOMENTS = 16, CAMERAS = 4 };
#define VISIBLE 0.02f /* of a colour: by so much an anchor's part of the picture is another than what it draws */
#define SEEN 2.0f     /* pixels of all views of a moment that an anchor makes up, below which these do not tell */

/** At each of some moments: what the views of it miss where an anchor is, and how many of their pixels it makes up. */
typedef struct moments {
    uint32_t n;            /* moments */
    size_t anchors;
    float (*missing)[3];   /* [n][anchors] sums over pixels */
    float *pixels;         /* [n][anchors] */
} moments;

static void moments_clear(moments *m)
{
    adcgs_free(NULL, m->missing);
    adcgs_free(NULL, m->pixels);
}

static adcgs_status moments_init(moments *m, const adcgs_fmodel *f, adcgs_error *error)
{
    m->n = 0;
    m->anchors = f->n;
    m->missing = adcgs_alloc(NULL, MOMENTS * m->anchors, sizeof *m->missing, error);
    m->pixels = adcgs_alloc(NULL, MOMENTS * m->anchors, sizeof *m->pixels, error);
    if (m->missing && m->pixels)
        return ADCGS_OK;
    moments_clear(m);
    return adcgs_alloc_status(error);
}

/** What is missing of a view, shared out among those who draw it. */
static adcgs_status add_view(adcgs_trainer *t, moments *m, uint32_t index, adcgs_error *error)
{
    const adcgs_train_view *v = &t->views[index];
    const size_t values = 3 * (size_t)v->view.width * (size_t)v->view.height;
    const adcgs_raster_grads *g = &t->pass->grads;
    const float *taken;
    ADCGS_TRY(adcgs_view_draw(t, &v->view, t->image, 1, error));
    ADCGS_TRY(adcgs_trainer_target(t, index, NULL, &taken, error));
    for (size_t i = 0; i < values; i++)
        t->grad[i] = taken[i] - t->image[i];
    ADCGS_TRY(adcgs_view_draw_back(t, &v->view, &t->pass->grads, error));
    float(*missing)[3] = m->missing + m->n * m->anchors;
    float *pixels = m->pixels + m->n * m->anchors;
    for (size_t i = 0; i < t->pass->primitives.n; i++) {
        const uint32_t anchor = adcgs_anchor_of(t->f, (uint32_t)i);
        if (anchor >= t->f->n)
            continue;
        pixels[anchor] += g->weight[i];
        for (int c = 0; c < 3; c++)
            missing[anchor][c] += g->colour[c][i];
    }
    return ADCGS_OK;
}

/** The views of a moment: some that show it. */
static adcgs_status add_moment(adcgs_trainer *t, moments *m, uint32_t index, adcgs_error *error)
{
    const float at = t->views[index].t;
    uint32_t asked = 0;
    adcgs_pass_forward(t->pass, t->f, at, &(adcgs_pass_mode){ .deform = ADCGS_DEFORM_ALL });
    for (uint32_t i = 0; i < t->n_views && asked < CAMERAS; i++)
        if (fabsf(t->views[(index + i) % t->n_views].t - at) < 1e-5f) {
            ADCGS_TRY(add_view(t, m, (index + i) % t->n_views, error));
            asked++;
        }
    m->n++;
    return ADCGS_OK;
}

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/** The mean that is missing of an anchor's pixels in the median moment of those that tell, in the channel that misses most. */
static float median_missing(const moments *m, uint32_t anchor)
{
    float off[MOMENTS];
    uint32_t n = 0;
    for (uint32_t i = 0; i < m->n; i++) {
        const size_t at = i * m->anchors + anchor;
        if (m->pixels[at] < SEEN)
            continue;
        off[n] = 0;
        for (int c = 0; c < 3; c++)
            off[n] = fmaxf(off[n], fabsf(m->missing[at][c]) / m->pixels[at]);
        n++;
    }
    qsort(off, n, sizeof *off, ascending);
    return n ? off[n / 2] : 0;
}

/** Those that stand still, or those that move. */
static adcgs_status release(adcgs_trainer *t, int moving, adcgs_error *error)
{
    adcgs_fmodel *f = t->f;
    const uint32_t n = t->n_views < MOMENTS ? t->n_views : MOMENTS;
    moments m;
    ADCGS_TRY(moments_init(&m, f, error));
    t->pass->pull = NULL;
    adcgs_status status = ADCGS_OK;
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++)
        status = add_moment(t, &m, (uint32_t)(((uint64_t)2 * i + 1) * t->n_views / (2 * n)), error);
    for (uint32_t i = 0; status == ADCGS_OK && i < f->n; i++)
        if (f->learns[i] == 0 && (f->moving[i] != 0) == moving && median_missing(&m, i) > VISIBLE)
            f->learns[i] = 1;
    moments_clear(&m);
    return status;
}

/** What stands still is asked before anything learns and so disturbs the picture; what moves, once motion has been followed. */
static double moment_of(const adcgs_train_config *c, int time)
{
    const double from = (double)c->curriculum_until, until = (double)c->densify_until;
    return time == 0 ? 0 : from + (until - from) * (time - 1) / (TIMES - 1);
}

adcgs_status adcgs_release_step(adcgs_trainer *t, double progress, adcgs_error *error)
{
    if (!t->f->follows || t->released >= TIMES || progress < moment_of(&t->config, t->released))
        return ADCGS_OK;
    return release(t, t->released++ > 0, error);
}
