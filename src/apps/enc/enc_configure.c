/* SPDX-License-Identifier: BSD-2-Clause */
/** \file From the options of adcgs-enc to the configuration of training. */
#include "config.h"

#include "apps/enc/enc_configure.h"

#include "train/settings.h"

/**
 * Settings of --fixed: no decision on the model's size depends on the scene. Later decisions need these, so they are off as well.
 */
#define FIXED "detail_anchors=0,static_threshold=0,prune_at=2,prune_units_at=2"

adcgs_status adcgs_enc_configure(adcgs_train_config *c, const adcgs_enc_options *o, adcgs_cpu_level cpu, adcgs_error *error)
{
    if (o->bf16)
        ADCGS_TRY(adcgs_bf16_check(cpu, error));
    ADCGS_TRY(adcgs_train_preset(c, o->preset, error));
    if (o->fixed)
        ADCGS_TRY(adcgs_train_set(c, FIXED, error));
    if (o->set)
        ADCGS_TRY(adcgs_train_set(c, o->set, error));
    const struct {
        int given;
        const char *name;
        double value;
    } own[] = {{o->has_lambda, "lambda", o->lambda},   {o->has_iterations, "iterations", o->iterations},
               {o->has_scale, "scale", o->scale},      {o->has_k, "k", o->k},
               {o->has_seed, "seed", (double)o->seed}, {o->has_max_anchors, "max_anchors", o->max_anchors},
               {o->no_progression, "tiers", 1}};
    for (size_t i = 0; i < ADCGS_COUNTOF(own); i++)
        if (own[i].given)
            ADCGS_TRY(adcgs_train_set_value(c, own[i].name, own[i].value, error));
    c->time_limit = o->time_limit;
    c->bf16 = (uint8_t)o->bf16;
    if (o->has_size || o->has_psnr) {
        c->target = o->has_size ? ADCGS_TARGET_SIZE : ADCGS_TARGET_PSNR;
        c->target_value = o->has_size ? (double)o->size : o->psnr;
    }
    if (o->without)
        ADCGS_TRY(adcgs_train_leave_out(c, o->without, error));
    c->without_rate |= o->uncompressed != NULL;
    c->without_rounding |= o->uncompressed != NULL;
    ADCGS_TRY(adcgs_train_check(c, error));
    if (o->beginning && adcgs_train_lambda_from(c) >= 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--beginning: lambda has no effect in this run, so leave out --beginning");
    return ADCGS_OK;
}
