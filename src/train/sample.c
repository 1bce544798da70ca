/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The loss of a sample of training views, by which decisions are made. */
#include "train/trainer.h"

adcgs_status adcgs_trainer_sample_loss(adcgs_trainer *t, uint32_t most, int own_time, double *loss, adcgs_error *error)
{
    const uint32_t n = ADCGS_MIN(t->n_views, most);
    *loss = 0;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t picked = (uint32_t)((uint64_t)i * t->n_views / n);
        const adcgs_train_view *v = &t->views[picked];
        adcgs_loss_value value;
        adcgs_pass_forward(t->pass, t->f, own_time ? v->t : 0.5f, &(adcgs_pass_mode){ .deform = ADCGS_DEFORM_ALL });
        ADCGS_TRY(adcgs_raster_forward(t->raster, &t->pass->primitives, &v->view, t->scene->background, 0.3f, t->image, 0,
                                       error));
        const float *target;
        ADCGS_TRY(adcgs_trainer_target(t, picked, NULL, &target, error));
        ADCGS_TRY(adcgs_trainer_loss(t, picked, target, &value, error));
        *loss += value.loss / n;
    }
    return ADCGS_OK;
}
