/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Presets and learning rates. */
#include "train/schedule.h"

const char *const adcgs_train_presets[] = { "draft", "fast", "medium", "slow", "paper", NULL };

/** What the presets share. */
static const adcgs_train_config base = {
    .preset = "fast",
    .iterations = 20000,
    .seed = 1,
    .scale = 1,
    .lambda = 0.1f,
    .ssim_weight = 0.2f,
    .params = { .k = 6, .n_fv = 32, .n_fg = 8, .chunks = 4, .n_eta = 4, .octaves = 5, .fine_uses_fv = 1, .coarse_rotation = 1,
                .time_rows = 40, .time_width = 16 },
    .shape = { .theta_width = 32, .theta_hidden = 2, .omega_width = 48, .omega_hidden = 2, .varpi_width = 48, .varpi_hidden = 2,
               .entropy_width = 24, .entropy_hidden = 1, .step_fv = 0.1f, .step_fg = 0.1f, .step_sigma = 0.06f,
               .step_colour = 0.02f, .depth = 11 },
    .start_anchors = 1000,
    .max_anchors = 4000,
    .densify_threshold = 0.0003f,
    .prune_opacity = 0.02f,
    .keep_opacity = 0.04f,
    .densify_every = 100,
    .rate_period = 4,
    .network_rate = 1,
    .rigid_weight = 0.02f,
    .scale_weight = 0.02f,
    .rdo_strength = 0,
    .dropout = 0.1f,
    .still_below = 1,
    .average_last = 0.05f,
    .curriculum_begin = 0.1f,
    .curriculum_until = 0.25f,
    .quarter_until = 0.25f,
    .half_until = 0.70f,
    .scale_from = 0.30f,
    .deform_from = 0.01f,
    .fine_from = 0.35f,
    .densify_from = 0.03f,
    .densify_until = 0.50f,
    .noise_from = 0.25f,
    .rate_from = 0.30f,
    .prune_units_at = 0.52f,
    .prune_units_again = 0.76f,
    .decide_at = 0.52f,
    .round_from = 0.85f,
    .freeze_from = 0.96f,
};

adcgs_status adcgs_train_preset(adcgs_train_config *config, const char *name, adcgs_error *error)
{
    *config = base;
    config->preset = name;
    if (!strcmp(name, "draft")) {
        config->iterations = 3000;
        config->max_anchors = 1200;
        config->start_anchors = 600;
        return ADCGS_OK;
    }
    if (!strcmp(name, "fast"))
        return ADCGS_OK;
    if (!strcmp(name, "medium")) {
        config->iterations = 40000;
        config->max_anchors = 5000;
        return ADCGS_OK;
    }
    if (!strcmp(name, "slow")) {
        config->iterations = 100000;
        config->max_anchors = 6000;
        return ADCGS_OK;
    }
    if (!strcmp(name, "paper")) {
        /* The paper's sizes and order of events (section 4.1, appendix A), without coarse-to-fine. */
        config->iterations = 80000;
        config->max_anchors = 20000;
        config->params.k = 10;
        config->params.n_fg = 16;
        config->params.time_width = 64;
        config->shape.theta_width = config->shape.entropy_width = 32;
        config->shape.entropy_hidden = 2;
        config->shape.omega_width = config->shape.varpi_width = 128;
        config->curriculum_until = config->quarter_until = config->half_until = 0;
        config->deform_from = config->fine_from = 0.10f;
        config->noise_from = config->rate_from = 0.125f;
        config->densify_from = 0.0125f;
        config->densify_until = 0.3125f;
        config->rigid_weight = config->scale_weight = config->dropout = config->still_below = config->network_rate = 0;
        config->keep_opacity = config->average_last = 0;
        config->prune_units_at = 2;
        return ADCGS_OK;
    }
    return adcgs_fail(error, ADCGS_ERR_USAGE, "unknown preset '%s': expected draft, fast, medium, slow or paper", name);
}

void adcgs_train_rates(adcgs_fmodel *f)
{
    static const float rates[ADCGS_P_COUNT][2] = {
        [ADCGS_P_FV] = { 7.5e-3f, 7.5e-4f },    [ADCGS_P_FG] = { 1.0e-2f, 1.0e-3f },     [ADCGS_P_SIGMA] = { 7.0e-3f, 7.0e-4f },
        [ADCGS_P_COLOUR] = { 5.0e-3f, 5.0e-4f }, [ADCGS_P_ETA] = { 1.0e-2f, 1.0e-3f },    [ADCGS_P_THETA] = { 4.0e-3f, 2.0e-4f },
        [ADCGS_P_OMEGA] = { 1.5e-3f, 1.0e-4f },  [ADCGS_P_VARPI] = { 1.5e-3f, 1.0e-4f },  [ADCGS_P_TIME] = { 5.0e-3f, 3.0e-4f },
        [ADCGS_P_STEP] = { 5.0e-3f, 1.0e-3f },
        [ADCGS_P_ETA_PRIOR] = { 5.0e-3f, 5.0e-4f }, [ADCGS_P_E_FV] = { 5.0e-3f, 5.0e-4f },
        [ADCGS_P_E_SIGMA] = { 5.0e-3f, 5.0e-4f }, [ADCGS_P_E_COLOUR] = { 5.0e-3f, 5.0e-4f },
        [ADCGS_P_E_FG] = { 5.0e-3f, 5.0e-4f }, [ADCGS_P_E_FG + 1] = { 5.0e-3f, 5.0e-4f },
        [ADCGS_P_E_FG + 2] = { 5.0e-3f, 5.0e-4f }, [ADCGS_P_E_FG + 3] = { 5.0e-3f, 5.0e-4f },
        [ADCGS_P_E_STEPS] = { 5.0e-3f, 5.0e-4f },
    };
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        f->param[i].lr0 = rates[i][0];
        f->param[i].lr1 = rates[i][1];
    }
}

float adcgs_train_lambda_from(const adcgs_train_config *c)
{
    return c->without_rate ? 2 : ADCGS_MIN(c->rate_from, c->prune_units_at);
}

const char *adcgs_train_stage(const adcgs_train_config *c, double progress)
{
    if (progress < c->deform_from)
        return "canonical";
    if (progress < c->noise_from)
        return "deform";
    if (progress < c->rate_from)
        return "noise";
    if (progress < c->round_from)
        return "rate";
    return progress < c->freeze_from ? "round" : "networks";
}
