/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Training views. */
#include "train/train_views.h"

#include "camera/path.h"
#include "grad/random.h"
#include "render/render.h"
#include "train/retime_duplicates.h"

#include <math.h>

static adcgs_status load_pictures(adcgs_trainer *t, int divide, adcgs_error *error)
{
    adcgs_thumbnail *own = NULL;
    if (t->config.retime_duplicates && !t->views.thumbnails && !(own = adcgs_alloc(NULL, t->views.n, sizeof *own, error)))
        return adcgs_alloc_status(error);
    adcgs_thumbnail *const thumbnails = own ? own : t->views.thumbnails;
    const adcgs_image_store_config config = {.split = ADCGS_SPLIT_TRAIN,
                                             .divide = divide,
                                             .memory = t->views.memory,
                                             .progress = t->views.loading,
                                             .user = t->views.loading_user,
                                             .thumbnails = thumbnails};
    adcgs_status status = adcgs_image_store_load(&t->views.store, t->scene, &config, t->pool, error);
    if (status == ADCGS_OK && t->config.retime_duplicates)
        status = adcgs_retime_duplicates(t, thumbnails, error);
    adcgs_free(NULL, own);
    return status;
}

adcgs_status adcgs_trainer_load_views(adcgs_trainer *t, int divide, adcgs_error *error)
{
    size_t most = 0;
    adcgs_views_unload(t);
    ADCGS_TRY(load_pictures(t, divide, error));
    for (uint32_t i = 0; i < t->views.n; i++) {
        const adcgs_camera *camera = adcgs_image_store_camera(t->views.store, i);
        const adcgs_status status = adcgs_view_init(&t->views.list[i].view, camera, t->origin, t->scale, error);
        ADCGS_TRY(adcgs_camera_path_rendered(camera, status, error));
        most = ADCGS_MAX(most, (size_t)camera->width * (size_t)camera->height);
    }
    t->image = adcgs_alloc(NULL, most * 3, sizeof(float), error);
    t->grad = adcgs_alloc(NULL, most * 3, sizeof(float), error);
    t->taken = adcgs_alloc(NULL, most * 3, sizeof(float), error);
    t->views.divide = divide;
    return t->image && t->grad && t->taken ? ADCGS_OK : adcgs_alloc_status(error);
}

adcgs_status adcgs_trainer_target(adcgs_trainer *t, uint32_t view, adcgs_exposure_sums *sums, const float **target,
                                  adcgs_error *error)
{
    const adcgs_view *v = &t->views.list[view].view;
    const size_t plane = (size_t)v->width * (size_t)v->height;
    ADCGS_TRY(adcgs_image_store_get(t->views.store, view, t->taken, error));
    if (t->exposure.n && sums)
        adcgs_exposure_sum(&t->exposure, view, t->image, t->taken, plane, sums);
    if (t->exposure.n) {
        adcgs_exposure_even(&t->exposure, view, t->taken, t->taken, plane);
        adcgs_exposure_allow_burnt(&t->exposure, view, t->image, t->scene->has_alpha ? t->scene->background : NULL, t->taken,
                                   plane);
    }
    const uint8_t *const hidden = adcgs_image_store_mask(t->views.store, view);
    for (size_t i = 0; hidden && i < plane; i++)
        for (size_t c = 0; hidden[i] && c < 3; c++)
            t->taken[c * plane + i] = t->image[c * plane + i];
    *target = t->taken;
    return ADCGS_OK;
}

adcgs_status adcgs_trainer_loss(adcgs_trainer *t, uint32_t view, const float *target, adcgs_loss_value *value, adcgs_error *error)
{
    const adcgs_view *v = &t->views.list[view].view;
    const size_t plane = (size_t)v->width * (size_t)v->height;
    const uint8_t *const hidden = adcgs_image_store_mask(t->views.store, view);
    const adcgs_loss_shares shares = {t->config.ssim_weight, t->config.l2_share};
    size_t known = plane;
    ADCGS_TRY(adcgs_loss_image(t->loss, t->image, target, v->width, v->height, &shares, t->grad, value, error));
    for (size_t i = 0; hidden && i < plane; i++) {
        known -= hidden[i];
        for (size_t c = 0; hidden[i] && c < 3; c++)
            t->grad[c * plane + i] = 0;
    }
    value->loss *= known ? (double)plane / (double)known : 0;
    value->mse *= known ? (double)plane / (double)known : 0;
    return ADCGS_OK;
}

int adcgs_view_pixel(const adcgs_view *v, const float x[3], size_t *at)
{
    float p[3];
    for (int a = 0; a < 3; a++)
        p[a] = v->rotation[3 * a] * x[0] + v->rotation[3 * a + 1] * x[1] + v->rotation[3 * a + 2] * x[2] + v->translation[a];
    if (!(p[2] > v->near_plane))
        return 0;
    const float u = v->fx * p[0] / p[2] + v->cx, w = v->fy * p[1] / p[2] + v->cy;
    if (!(u >= 0 && w >= 0 && u < (float)v->width && w < (float)v->height))
        return 0;
    *at = (size_t)w * (size_t)v->width + (size_t)u;
    return 1;
}

void adcgs_view_crop(adcgs_view *v, int x, int y, int width, int height)
{
    v->cx -= (float)x;
    v->cy -= (float)y;
    v->width = width;
    v->height = height;
}

adcgs_status adcgs_trainer_loss_crop(adcgs_trainer *t, uint32_t view, const adcgs_view *crop, adcgs_loss_value *value,
                                     adcgs_error *error)
{
    const adcgs_view *v = &t->views.list[view].view;
    const size_t wide = (size_t)v->width, w = (size_t)crop->width, h = (size_t)crop->height;
    const size_t x = (size_t)lrintf(v->cx - crop->cx), y = (size_t)lrintf(v->cy - crop->cy);
    const adcgs_loss_shares shares = {t->config.ssim_weight, t->config.l2_share};
    for (size_t c = 0; c < 3; c++) /* in place: writes never pass the reads */
        for (size_t j = 0; j < h; j++)
            memmove(t->taken + (c * h + j) * w, t->taken + (c * (size_t)v->height + y + j) * wide + x, w * sizeof(float));
    return adcgs_loss_image(t->loss, t->image, t->taken, crop->width, crop->height, &shares, t->grad, value, error);
}

/** Background of a target. For images with alpha it is divided by the gain like the rest. */
static void backdrop_of(const adcgs_trainer *t, uint32_t of, float backdrop[3])
{
    memcpy(backdrop, t->scene->background, 3 * sizeof *backdrop);
    if (of != ADCGS_MEAN_LIGHT && t->exposure.n && t->scene->has_alpha)
        adcgs_exposure_even(&t->exposure, of, t->scene->background, backdrop, 1);
}

adcgs_status adcgs_view_render(adcgs_trainer *t, const adcgs_view *view, uint32_t of, float *image, int keep, adcgs_error *error)
{
    float backdrop[3];
    backdrop_of(t, of, backdrop);
    return adcgs_raster_forward(t->raster, &t->pass->primitives, view, backdrop, ADCGS_SCREEN_FILTER, image, keep, error);
}

adcgs_status adcgs_view_backward(adcgs_trainer *t, const adcgs_view *view, uint32_t of, adcgs_raster_grads *grads,
                                 adcgs_error *error)
{
    float backdrop[3];
    backdrop_of(t, of, backdrop);
    return adcgs_raster_backward(t->back, t->raster, &t->pass->primitives, view, backdrop, ADCGS_SCREEN_FILTER, t->image, t->grad,
                                 grads, error);
}

uint32_t adcgs_view_pick(const adcgs_trainer *t, uint32_t look)
{
    if (t->curriculum.n < t->views.n)
        return adcgs_curriculum_pick(&t->curriculum, t->config.seed, look);
    const uint32_t n = t->views.n, epoch = look / n;
    int half = 1;
    while ((uint64_t)1 << (2 * half) < n)
        half++;
    const uint32_t mask = (1u << half) - 1;
    uint32_t x = look % n;
    do {
        uint32_t l = x >> half, r = x & mask;
        for (uint32_t round = 0; round < 4; round++) {
            const uint32_t next = l ^ ((uint32_t)adcgs_random64(t->config.seed, 2000 + round, (uint64_t)epoch << 32 | r) & mask);
            l = r;
            r = next;
        }
        x = l << half | r;
    } while (x >= n);
    return x;
}
