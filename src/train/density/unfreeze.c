/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Unfreezing of anchors. */
#include "train/density/unfreeze.h"

#include "train/density/anchor_set.h"
#include "train/train_views.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    TIMES = 3,        /* number of tests in a run */
    FRAMES_MAX = 16,  /* maximum number of frames that are tested */
    CAMERAS = 4,      /* maximum number of views of each */
    ANCHOR_BITS = 180 /* expected bits of an anchor that is sent again */
};
/*
 * Colour difference: minimum error of an anchor's contribution; calibrated on a turning box and a static scene
 * (doc/log/segments.md).
 */
#define VISIBLE 0.02f
/* Pixels: coverage over all views of a frame, below which they are ignored; chosen by hand, not measured. */
#define SEEN 2.0f
/* Ratio of the actual decrease of the loss to the decrease of squared errors; calibrated on the same scenes. */
#define WORTH 4.0

/** Residuals and coverage of each anchor in some frames, the earliest first. */
typedef struct frame_errors {
    uint32_t n; /* number of frames */
    size_t anchors;
    float views[FRAMES_MAX]; /* number of views used */
    float (*missing)[3];     /* [n][anchors] sums over pixels */
    float *pixels;           /* [n][anchors] */
} frame_errors;

static void frame_errors_clear(frame_errors *m)
{
    adcgs_free(NULL, m->missing);
    adcgs_free(NULL, m->pixels);
}

static adcgs_status frame_errors_init(frame_errors *m, const adcgs_fmodel *f, adcgs_error *error)
{
    m->n = 0;
    m->anchors = f->n;
    m->missing = adcgs_alloc(NULL, FRAMES_MAX * m->anchors, sizeof *m->missing, error);
    m->pixels = adcgs_alloc(NULL, FRAMES_MAX * m->anchors, sizeof *m->pixels, error);
    if (m->missing && m->pixels)
        return ADCGS_OK;
    frame_errors_clear(m);
    return adcgs_alloc_status(error);
}

/** Adds a view's residual, distributed over the anchors that contribute. */
static adcgs_status add_view(adcgs_trainer *t, frame_errors *m, uint32_t index, adcgs_error *error)
{
    const adcgs_train_view *v = &t->views.list[index];
    const size_t values = 3 * (size_t)v->view.width * (size_t)v->view.height;
    const adcgs_raster_grads *g = &t->pass->grads;
    const float *taken;
    ADCGS_TRY(adcgs_view_render(t, &v->view, index, t->image, 1, error));
    ADCGS_TRY(adcgs_trainer_target(t, index, NULL, &taken, error));
    for (size_t i = 0; i < values; i++)
        t->grad[i] = taken[i] - t->image[i];
    ADCGS_TRY(adcgs_view_backward(t, &v->view, index, &t->pass->grads, error));
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

/** Adds a frame, with some of its views. */
static adcgs_status add_frame(adcgs_trainer *t, frame_errors *m, uint32_t index, adcgs_error *error)
{
    const float at = t->views.list[index].t;
    uint32_t asked = 0;
    adcgs_pass_forward(t->pass, t->f, at, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    for (uint32_t i = 0; i < t->views.n && asked < CAMERAS; i++)
        if (fabsf(t->views.list[(index + i) % t->views.n].t - at) < 1e-5f) {
            ADCGS_TRY(add_view(t, m, (index + i) % t->views.n, error));
            asked++;
        }
    m->views[m->n++] = (float)asked;
    return ADCGS_OK;
}

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/** Residual at an anchor in a frame, in the channel where it is largest; 0 if coverage is too low. */
static float missing_at(const frame_errors *m, uint32_t frame, uint32_t anchor)
{
    const size_t at = frame * m->anchors + anchor;
    float off = 0;
    for (int c = 0; m->pixels[at] >= SEEN && c < 3; c++)
        off = fmaxf(off, fabsf(m->missing[at][c]) / m->pixels[at]);
    return off;
}

/** The same minus the residual in the earliest frame, which the previous segment has trained: its errors are not new. */
static float change_at(const frame_errors *m, uint32_t frame, uint32_t anchor)
{
    const size_t at = frame * m->anchors + anchor;
    float off = 0;
    if (m->pixels[anchor] < SEEN)
        return missing_at(m, frame, anchor);
    for (int c = 0; m->pixels[at] >= SEEN && c < 3; c++)
        off = fmaxf(off, fabsf(m->missing[at][c] / m->pixels[at] - m->missing[anchor][c] / m->pixels[anchor]));
    return off;
}

/** Residual of an anchor over frames, median and maximum, and its coverage in pixels per view. */
typedef struct verdict {
    float median, most, pixels;
} verdict;

/** For static anchors, a residual counts only if it was not present in the earliest frame. */
static verdict judge(const frame_errors *m, uint32_t anchor, int moves)
{
    verdict v = {0, 0, 0};
    float off[FRAMES_MAX];
    uint32_t n = 0;
    for (uint32_t i = 1; i < m->n; i++) {
        const float pixels = m->pixels[i * m->anchors + anchor], now = missing_at(m, i, anchor);
        if (pixels < SEEN)
            continue;
        off[n] = moves ? now : fminf(now, change_at(m, i, anchor));
        v.most = fmaxf(v.most, off[n++]);
        v.pixels += pixels / m->views[i];
    }
    qsort(off, n, sizeof *off, ascending);
    v.median = n ? off[n / 2] : 0;
    v.pixels /= n ? (float)n : 1;
    return v;
}

/** True if the residual is visible and worth the bits of a new anchor. */
static int is_worth(const adcgs_trainer *t, float missing, float pixels)
{
    const double area = (double)t->views.list[0].view.width * t->views.list[0].view.height;
    const double gain = WORTH * (double)missing * (double)missing * (double)pixels / area;
    return missing > VISIBLE && gain > ANCHOR_BITS * adcgs_cost_of_bit(t);
}

/** Unfreezes static or moving anchors. *idle: nothing moves, and nothing has changed in any frame. */
static void choose(adcgs_trainer *t, const frame_errors *m, int moving, int *idle)
{
    adcgs_fmodel *f = t->f;
    *idle = 1;
    for (uint32_t i = 0; i < f->n; i++) {
        const verdict v = judge(m, i, moving);
        *idle &= f->moving[i] == 0 && f->trainable[i] == 0 && !is_worth(t, v.most, v.pixels);
        if ((f->moving[i] != 0) == moving && is_worth(t, v.median, v.pixels))
            f->trainable[i] = 1;
    }
}

static uint32_t earliest(const adcgs_trainer *t)
{
    uint32_t first = 0;
    for (uint32_t i = 1; i < t->views.n; i++)
        first = t->views.list[i].t < t->views.list[first].t ? i : first;
    return first;
}

static adcgs_status release(adcgs_trainer *t, int moving, int *idle, adcgs_error *error)
{
    const uint32_t n = t->views.n < FRAMES_MAX ? t->views.n : FRAMES_MAX;
    frame_errors m;
    ADCGS_TRY(frame_errors_init(&m, t->f, error));
    t->pass->pull = NULL;
    adcgs_status status = add_frame(t, &m, earliest(t), error);
    for (uint32_t i = 1; status == ADCGS_OK && i < n; i++)
        status = add_frame(t, &m, (uint32_t)(((uint64_t)2 * i + 1) * t->views.n / (2 * n)), error);
    if (status == ADCGS_OK)
        choose(t, &m, moving, idle);
    frame_errors_clear(&m);
    return status;
}

/** Static anchors are tested before training disturbs the render; moving anchors, once motion has been tracked. */
static double test_progress(const adcgs_train_config *c, int time)
{
    const double from = (double)c->curriculum_until, until = (double)c->densify_until;
    return time == 0 ? 0 : from + (until - from) * (time - 1) / (TIMES - 1);
}

adcgs_status adcgs_unfreeze_step(adcgs_trainer *t, double progress, adcgs_error *error)
{
    int idle = 0;
    if (!t->f->follows || t->stage.unfreeze_tests >= TIMES || progress < test_progress(&t->config, t->stage.unfreeze_tests))
        return ADCGS_OK;
    ADCGS_TRY(release(t, t->stage.unfreeze_tests > 0, &idle, error));
    if (idle && t->stage.unfreeze_tests == 0) /* nothing to train: the run is finished */
        t->run.iteration = t->config.iterations;
    t->stage.unfreeze_tests++;
    return ADCGS_OK;
}
