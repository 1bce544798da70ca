/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Detection of anchors rendered where images never change. */
#include "train/static/unchanging.h"

#include "metric/changes.h"
#include "scene/group_views.h"
#include "train/density/anchor_set.h"
#include "train/train_views.h"

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    PICTURES_LEAST = 4, /* minimum number of images of a camera for a result */
    PICTURES_DRAWN = 4  /* number of images rendered per camera */
};
/* Invisible changes, in standard deviations of all images' values; chosen by hand, not measured. */
#define UNSEEN 0.2

/** Marks the pixels that change in the images of a camera: [height][width]. view: its n views in ascending time. */
static adcgs_status find_changing(const adcgs_trainer *t, const uint32_t *view, uint32_t n, uint8_t *region, adcgs_error *error)
{
    adcgs_changes *changes;
    ADCGS_TRY(adcgs_changes_create(&changes, t->views.list[view[0]].view.width, t->views.list[view[0]].view.height, error));
    adcgs_status status = ADCGS_OK;
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++) {
        status = adcgs_image_store_get(t->views.store, view[i], t->taken, error);
        if (status == ADCGS_OK)
            adcgs_changes_add(changes, t->taken);
    }
    if (status == ADCGS_OK)
        status = adcgs_changes_region(changes, adcgs_changes_least(changes, UNSEEN * t->rate.contrast, t->run.mean_mse), region,
                                      error);
    adcgs_changes_free(&changes);
    return status;
}

/**
 * Adds the weights of an image. The gradient of the red channel at changing pixels with respect to a primitive's red is its
 * weight there.
 */
static adcgs_status add_picture(adcgs_trainer *t, const adcgs_train_view *v, const uint8_t *region, float *drawn, float *changing,
                                adcgs_error *error)
{
    const size_t pixels = (size_t)v->view.width * (size_t)v->view.height;
    adcgs_raster_grads grads = t->pass->grads;
    grads.screen = NULL;
    adcgs_pass_forward(t->pass, t->f, v->t, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    ADCGS_TRY(adcgs_view_render(t, &v->view, ADCGS_MEAN_LIGHT, t->image, 1, error));
    memset(t->grad, 0, 3 * pixels * sizeof *t->grad);
    for (size_t i = 0; i < pixels; i++)
        t->grad[i] = region[i];
    ADCGS_TRY(adcgs_view_backward(t, &v->view, ADCGS_MEAN_LIGHT, &grads, error));
    for (uint32_t i = 0; i < t->pass->primitives.n; i++) {
        const uint32_t anchor = adcgs_anchor_of(t->f, i);
        if (anchor >= t->f->n)
            continue;
        drawn[anchor] += grads.weight[i];
        changing[anchor] += grads.colour[0][i];
    }
    return ADCGS_OK;
}

/** Adds some of a camera's n images, evenly chosen. */
static adcgs_status add_camera(adcgs_trainer *t, const uint32_t *view, uint32_t n, float *drawn, float *changing,
                               adcgs_error *error)
{
    const adcgs_view *const camera = &t->views.list[view[0]].view;
    uint8_t *const region = adcgs_alloc(NULL, (size_t)camera->width * (size_t)camera->height, 1, error);
    adcgs_status status = region ? find_changing(t, view, n, region, error) : adcgs_alloc_status(error);
    for (uint32_t i = 0; status == ADCGS_OK && i < n; i++)
        if (i * PICTURES_DRAWN / n != (i + 1) * PICTURES_DRAWN / n)
            status = add_picture(t, &t->views.list[view[i]], region, drawn, changing, error);
    adcgs_free(NULL, region);
    return status;
}

/** Adds all cameras with enough images. of, order: buffers of n_views. */
static adcgs_status add_cameras(adcgs_trainer *t, uint32_t *of, uint32_t *order, float *drawn, float *changing,
                                adcgs_error *error)
{
    uint32_t cameras, n;
    ADCGS_TRY(adcgs_group_views(t->scene->views[ADCGS_SPLIT_TRAIN], t->views.n, of, order, &cameras, error));
    for (uint32_t i = 0; i < t->views.n; i += n) {
        n = 1;
        while (i + n < t->views.n && of[order[i + n]] == of[order[i]])
            n++;
        if (n >= PICTURES_LEAST)
            ADCGS_TRY(add_camera(t, order + i, n, drawn, changing, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_changing_share(adcgs_trainer *t, float *share, adcgs_error *error)
{
    float *const drawn = adcgs_alloc(NULL, t->f->n, sizeof *drawn, error);
    uint32_t *const of = adcgs_alloc(NULL, 2 * (size_t)t->views.n, sizeof *of, error);
    memset(share, 0, t->f->n * sizeof *share);
    const adcgs_status status =
        drawn && of ? add_cameras(t, of, of + t->views.n, drawn, share, error) : adcgs_alloc_status(error);
    for (uint32_t i = 0; status == ADCGS_OK && i < t->f->n; i++)
        share[i] = drawn[i] > 0 ? share[i] / drawn[i] : -1;
    adcgs_free(NULL, drawn);
    adcgs_free(NULL, of);
    return status;
}
