/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Measurements on a sample of training views. */
#include "train/density/sample.h"

#include "grad/random.h"
#include "metric/metric.h"
#include "train/train_views.h"

#include <math.h>
#include <stdlib.h>

/**
 * Views for judging networks. At full size only a quarter of each view is used, because a search judges hundreds of times
 * (doc/log/speed.md, "Searches on samples"). Chosen by hand, not measured.
 */
enum { NETWORK_VIEWS = 16 };

/** Loss of a view whose primitives are in the pass, or of one of its quarters if quarter is 0 to 3. */
static adcgs_status view_loss(adcgs_trainer *t, uint32_t picked, int quarter, double *loss, adcgs_error *error)
{
    adcgs_view v = t->views.list[picked].view;
    adcgs_loss_value value;
    const float *target;
    const int whole = quarter < 0 || adcgs_image_store_mask(t->views.store, picked);
    if (!whole)
        adcgs_view_crop(&v, quarter & 1 ? v.width / 2 : 0, quarter & 2 ? v.height / 2 : 0, (v.width + 1) / 2, (v.height + 1) / 2);
    ADCGS_TRY(adcgs_view_render(t, &v, picked, t->image, 0, error));
    ADCGS_TRY(adcgs_trainer_target(t, picked, NULL, &target, error));
    if (whole)
        ADCGS_TRY(adcgs_trainer_loss(t, picked, target, &value, error));
    else
        ADCGS_TRY(adcgs_trainer_loss_crop(t, picked, &v, &value, error));
    *loss = value.loss;
    return ADCGS_OK;
}

static adcgs_status sample_loss(adcgs_trainer *t, uint32_t most, int own_time, int quarters, double *loss, adcgs_error *error)
{
    const uint32_t n = ADCGS_MIN(t->views.n, most);
    *loss = 0;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t picked = (uint32_t)((uint64_t)i * t->views.n / n);
        double one;
        adcgs_pass_forward(t->pass, t->f, own_time ? t->views.list[picked].t : 0.5f,
                           &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL, .other_time = i > 0});
        ADCGS_TRY(view_loss(t, picked, quarters ? (int)(i % 4) : -1, &one, error));
        *loss += one / n;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_sample_loss(adcgs_trainer *t, uint32_t most, int own_time, double *loss, adcgs_error *error)
{
    return sample_loss(t, most, own_time, 0, loss, error);
}

adcgs_status adcgs_sample_distortion(adcgs_trainer *t, int group, double *bits, adcgs_error *error)
{
    if (t->f->mlp[group].entropy) {
        adcgs_rate rate;
        adcgs_pass_rate(t->pass, t->f, &rate);
        *bits = rate.total;
        return ADCGS_OK;
    }
    double loss;
    ADCGS_TRY(sample_loss(t, NETWORK_VIEWS, 1, t->views.divide == t->config.scale, &loss, error));
    /* Without a price of bits only the loss decides, since no number of bits comes close to it. */
    *bits = loss / fmax(adcgs_cost_of_bit(t), 1e-30);
    return ADCGS_OK;
}

/** PSNR of a view's render, rounded as in a player, against the recorded image. */
static adcgs_status picture_psnr(adcgs_trainer *t, const adcgs_view *view, const float *taken, float *image, double *psnr,
                                 adcgs_error *error)
{
    const size_t values = 3 * (size_t)view->width * (size_t)view->height;
    ADCGS_TRY(adcgs_view_render(t, view, ADCGS_MEAN_LIGHT, image, 0, error));
    for (size_t i = 0; i < values; i++)
        image[i] = rintf(255 * fminf(fmaxf(image[i], 0), 1)) / 255;
    *psnr = adcgs_psnr(image, taken, values);
    return ADCGS_OK;
}

static adcgs_status loaded_psnr(adcgs_trainer *t, uint32_t index, double *psnr, adcgs_error *error)
{
    ADCGS_TRY(adcgs_image_store_get(t->views.store, index, t->taken, error));
    return picture_psnr(t, &t->views.list[index].view, t->taken, t->image, psnr, error);
}

/** The same for a view that is not loaded at full size. */
static adcgs_status full_psnr(adcgs_trainer *t, uint32_t index, double *psnr, adcgs_error *error)
{
    adcgs_camera camera;
    adcgs_view view;
    float *taken;
    ADCGS_TRY(adcgs_scene_image(t->scene, &t->scene->views[ADCGS_SPLIT_TRAIN][index], 1, &taken, &camera, error));
    float *image = adcgs_alloc(NULL, 3 * (size_t)camera.width * (size_t)camera.height, sizeof *image, error);
    adcgs_status status = image ? adcgs_view_init(&view, &camera, t->origin, t->scale, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        status = picture_psnr(t, &view, taken, image, psnr, error);
    adcgs_free(NULL, image);
    free(taken);
    return status;
}

adcgs_status adcgs_sample_psnr(adcgs_trainer *t, uint32_t most, double *psnr, adcgs_error *error)
{
    const uint32_t n = ADCGS_MIN(t->views.n, most);
    const adcgs_pass_mode mode = {.quant = t->stage.frozen     ? ADCGS_QUANT_NONE
                                           : t->stage.rounding ? ADCGS_QUANT_ROUND
                                                               : ADCGS_QUANT_NOISE,
                                  .deform = 1,
                                  .seed = (uint32_t)adcgs_random64(t->config.seed, 3001, 0)};
    *psnr = 0;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t index = (uint32_t)((uint64_t)i * t->views.n / n);
        double one;
        adcgs_pass_forward(t->pass, t->f, t->views.list[index].t, &mode);
        ADCGS_TRY(t->views.divide == 1 ? loaded_psnr(t, index, &one, error) : full_psnr(t, index, &one, error));
        *psnr += one / n;
    }
    return ADCGS_OK;
}
