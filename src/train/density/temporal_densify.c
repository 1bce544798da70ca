/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Densification in time. */
#include "train/density/temporal_densify.h"

#include "grad/random.h"
#include "train/density/anchor_set.h"
#include "train/train_views.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    FRAMES = 2,     /* frames per call */
    VIEWS_MOST = 8, /* maximum number of views of a frame */
    VIEWS_LEAST = 2 /* minimum number of views that contain a point */
};
#define GAIN_LEAST 0.04f /* minimum gain: reduction of the absolute error, mean over views and channels */

/** The points of a frame. */
typedef struct batch {
    const adcgs_stereo_point *point;
    uint32_t n;
    float *gain;    /* [n] sum over views */
    uint32_t *seen; /* [n] */
} batch;

static batch batch_of(const adcgs_stereo *s, float when)
{
    batch b = {.n = 0};
    for (uint32_t i = 0; i < s->n_moving; i++)
        if (s->moving[i].t >= when && s->moving[i].t <= when) {
            b.point = b.n++ ? b.point : &s->moving[i];
        }
    return b;
}

/** Adds a view's gain for each point: error of the render minus error of the point's colour. */
static adcgs_status ask_view(adcgs_trainer *t, batch *b, uint32_t index, adcgs_error *error)
{
    const adcgs_view *v = &t->views.list[index].view;
    const size_t plane = (size_t)v->width * (size_t)v->height;
    const float *taken;
    ADCGS_TRY(adcgs_view_render(t, v, index, t->image, 0, error));
    ADCGS_TRY(adcgs_trainer_target(t, index, NULL, &taken, error));
    for (uint32_t i = 0; i < b->n; i++) {
        const double *place = b->point[i].x;
        const float x[3] = {(float)place[0], (float)place[1], (float)place[2]};
        size_t at;
        if (!adcgs_view_pixel(v, x, &at))
            continue;
        float gain = 0;
        for (int c = 0; c < 3; c++, at += plane)
            gain += fabsf(t->image[at] - taken[at]) - fabsf(b->point[i].rgb[c] - taken[at]);
        b->gain[i] += gain / 3;
        b->seen[i]++;
    }
    return ADCGS_OK;
}

static adcgs_status measure_frame(adcgs_trainer *t, batch *b, float when, adcgs_error *error)
{
    uint32_t asked = 0;
    adcgs_pass_forward(t->pass, t->f, when, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    for (uint32_t i = 0; i < t->views.n && asked < VIEWS_MOST; i++)
        if (fabsf(t->views.list[i].t - when) < 1e-5f) {
            ADCGS_TRY(ask_view(t, b, i, error));
            asked++;
        }
    return ADCGS_OK;
}

static uint32_t choose(const batch *b, adcgs_ranked *list, const adcgs_stereo_point **points, uint32_t most)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < b->n; i++) {
        const float gain = b->seen[i] >= VIEWS_LEAST ? b->gain[i] / (float)b->seen[i] : 0;
        if (gain > GAIN_LEAST)
            list[n++] = (adcgs_ranked){gain, i};
    }
    adcgs_rank(list, n);
    n = ADCGS_MIN(n, most);
    for (uint32_t i = 0; i < n; i++)
        points[i] = &b->point[list[i].index];
    return n;
}

adcgs_status adcgs_temporal_densify_find(adcgs_trainer *t, const adcgs_stereo_point **points, uint32_t most, uint32_t *n,
                                         adcgs_error *error)
{
    const adcgs_stereo *s = &t->stereo;
    *n = 0;
    for (int turn = 0; turn < FRAMES && s->n_frames; turn++) {
        const float when = s->frame_time[adcgs_random64(t->config.seed, 4000 + (uint64_t)turn, t->run.iteration) % s->n_frames];
        batch b = batch_of(s, when);
        b.gain = adcgs_alloc(NULL, b.n + 1, sizeof *b.gain, error);
        b.seen = adcgs_alloc(NULL, b.n + 1, sizeof *b.seen, error);
        adcgs_ranked *list = adcgs_alloc(NULL, b.n + 1, sizeof *list, error);
        adcgs_status status = b.gain && b.seen && list ? ADCGS_OK : adcgs_alloc_status(error);
        if (status == ADCGS_OK && b.n)
            status = measure_frame(t, &b, when, error);
        if (status == ADCGS_OK)
            *n += choose(&b, list, points + *n, most / FRAMES);
        adcgs_free(NULL, b.gain);
        adcgs_free(NULL, b.seen);
        adcgs_free(NULL, list);
        ADCGS_TRY(status);
    }
    return ADCGS_OK;
}
