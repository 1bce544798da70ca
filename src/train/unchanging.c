/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Where the pictures of a camera never change, and what is drawn there. */
#include "train/unchanging.h"

#include "metric/changes.h"
#include "train/anchor_set.h"
#include "train/views.h"

/* Fewer pictures of a camera say little; so many of each are drawn. */
enum { PICTURES_LEAST = 4, PICTURES_DRAWN = 4 };
/* Changes that nobody sees, in standard deviations of all pictures' values. */
#define UNSEEN 0.2

static int same_camera(const adcgs_view *a, const adcgs_view *b)
{
    return a->width == b->width && a->height == b->height && !memcmp(a->rotation, b->rotation, sizeof a->rotation) &&
           !memcmp(a->translation, b->translation, sizeof a->translation) && !memcmp(&a->fx, &b->fx, 4 * sizeof a->fx);
}

/** The next view of a view's camera; n_views if there is none. */
static uint32_t next_of_camera(const adcgs_trainer *t, uint32_t view)
{
    uint32_t i = view + 1;
    while (i < t->n_views && !same_camera(&t->views[i].view, &t->views[view].view))
        i++;
    return i;
}

/** Where the pictures of the camera of view `first` change: [height][width]. */
static adcgs_status find_changing(const adcgs_trainer *t, uint32_t first, uint8_t *region, adcgs_error *error)
{
    adcgs_changes *changes;
    ADCGS_TRY(adcgs_changes_create(&changes, t->views[first].view.width, t->views[first].view.height, error));
    adcgs_status status = ADCGS_OK;
    for (uint32_t i = first; status == ADCGS_OK && i < t->n_views; i = next_of_camera(t, i)) {
        status = adcgs_pictures_get(t->pictures, i, t->taken, error);
        if (status == ADCGS_OK)
            adcgs_changes_add(changes, t->taken);
    }
    if (status == ADCGS_OK)
        adcgs_changes_region(changes, adcgs_changes_least(changes, UNSEEN * t->contrast, t->mean_mse), region);
    adcgs_changes_free(&changes);
    return status;
}

/** Weights in a picture: the gradient of the red of pixels that change, by a primitive's red, is its weight there. */
static adcgs_status add_picture(adcgs_trainer *t, const adcgs_train_view *v, const uint8_t *region, float *drawn, float *changing,
                                adcgs_error *error)
{
    const size_t pixels = (size_t)v->view.width * (size_t)v->view.height;
    adcgs_raster_grads grads = t->pass->grads;
    grads.screen = NULL;
    adcgs_pass_forward(t->pass, t->f, v->t, &(adcgs_pass_mode){ .deform = ADCGS_DEFORM_ALL });
    ADCGS_TRY(adcgs_view_draw(t, &v->view, t->image, 1, error));
    memset(t->grad, 0, 3 * pixels * sizeof *t->grad);
    for (size_t i = 0; i < pixels; i++)
        t->grad[i] = region[i];
    ADCGS_TRY(adcgs_view_draw_back(t, &v->view, &grads, error));
    for (uint32_t i = 0; i < t->pass->primitives.n; i++) {
        const uint32_t anchor = adcgs_anchor_of(t->f, i);
        if (anchor >= t->f->n)
            continue;
        drawn[anchor] += grads.weight[i];
        changing[anchor] += grads.colour[0][i];
    }
    return ADCGS_OK;
}

/** Some of the n pictures of the camera of view `first`, evenly chosen. */
static adcgs_status add_camera(adcgs_trainer *t, uint32_t first, uint32_t n, float *drawn, float *changing, adcgs_error *error)
{
    const size_t pixels = (size_t)t->views[first].view.width * (size_t)t->views[first].view.height;
    uint8_t *const region = adcgs_alloc(NULL, pixels, 1, error);
    uint32_t seen = 0;
    adcgs_status status = region ? find_changing(t, first, region, error) : adcgs_alloc_status(error);
    for (uint32_t i = first; status == ADCGS_OK && i < t->n_views; i = next_of_camera(t, i), seen++)
        if (seen * PICTURES_DRAWN / n != (seen + 1) * PICTURES_DRAWN / n)
            status = add_picture(t, &t->views[i], region, drawn, changing, error);
    adcgs_free(NULL, region);
    return status;
}

adcgs_status adcgs_changing_share(adcgs_trainer *t, float *share, adcgs_error *error)
{
    float *const drawn = adcgs_alloc(NULL, t->f->n, sizeof *drawn, error);
    adcgs_status status = drawn ? ADCGS_OK : adcgs_alloc_status(error);
    memset(share, 0, t->f->n * sizeof *share);
    for (uint32_t i = 0; status == ADCGS_OK && i < t->n_views; i++) {
        uint32_t before = 0, n = 0;
        while (before < i && !same_camera(&t->views[before].view, &t->views[i].view))
            before++;
        for (uint32_t j = i; before == i && j < t->n_views; j = next_of_camera(t, j))
            n++;
        if (n >= PICTURES_LEAST)
            status = add_camera(t, i, n, drawn, share, error);
    }
    for (uint32_t i = 0; status == ADCGS_OK && i < t->f->n; i++)
        share[i] = drawn[i] > 0 ? share[i] / drawn[i] : -1;
    adcgs_free(NULL, drawn);
    return status;
}
