/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Anchors and networks that fit into a size. */
#include "train/rate/rate_plan.h"

#include "train/schedule.h"
#include "train/settings.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    OTHER_BYTES = 1700, /* upper estimate for headers, cameras and metadata; arithmetic */
    /* Per anchor at a small lambda, calibrated on demo and the robot; a large size allows more anchors than a preset. */
    ANCHOR_BITS = 220,
    /* Per anchor at a large lambda, calibrated on demo (doc/log/rate.md); a small size allows fewer anchors. */
    FEWEST_BITS = 50,
    ANCHORS_LEAST = 16, /* minimum number of anchors */
    WIDTH_LEAST = 8     /* minimum units of a hidden layer */
};
#define NETWORKS_SHARE 0.25 /* plausible share of the networks in a size */
#define UNITS_STAY 0.3      /* share of the weights that remain after pruning of hidden units */
#define LAMBDA_FIRST 0.1f   /* initial lambda of a search */
#define ANCHORS_GROWTH 4    /* maximum factor by which a large size raises a preset's budget */

/** Number of weights of all networks of a shape. */
static adcgs_status count_weights(const adcgs_train_config *c, const adcgs_shape *shape, size_t *weights, adcgs_error *error)
{
    static const float origin[3];
    static const uint32_t place[1][3];
    adcgs_params params = c->params;
    adcgs_fmodel *f;
    *weights = 0;
    params.bodies = 0; /* not known yet, and few scenes have the maximum number */
    ADCGS_TRY(adcgs_fmodel_create(&f, &params, shape, origin, 1, place, 1, 0, error));
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        *weights += f->mlp[i].n;
    adcgs_fmodel_free(&f);
    return ADCGS_OK;
}

static int narrower(int width, double factor)
{
    const int scaled = 4 * (int)rint(width * factor / 4);
    return width ? ADCGS_MIN(width, ADCGS_MAX(scaled, WIDTH_LEAST)) : 0; /* 0: the network is left out */
}

/** Chooses the widest networks, from fractions of the requested width, that leave room for anchors. */
static adcgs_status plan_networks(adcgs_rate_plan *plan, const adcgs_train_config *config, double *bytes, adcgs_error *error)
{
    const int has_anchors = adcgs_setting_is_given(config, "max_anchors");
    const int has_networks = adcgs_setting_group_is_given(config, ADCGS_SETTING_NETWORKS);
    const double share = NETWORKS_SHARE * config->target_value;
    const double room = has_anchors ? config->target_value - OTHER_BYTES - (double)config->max_anchors * ANCHOR_BITS / 8 : 0;
    /* Widths tried, relative to the request; chosen by hand, not measured. */
    static const double factors[] = {1, 0.875, 0.75, 0.625, 0.5, 0.375, 0.25, 0.125};
    adcgs_shape shape = config->shape;
    for (size_t i = 0; i < ADCGS_COUNTOF(factors); i++) {
        size_t weights;
        shape.theta_width = narrower(config->shape.theta_width, factors[i]);
        shape.omega_width = narrower(config->shape.omega_width, factors[i]);
        shape.varpi_width = narrower(config->shape.varpi_width, factors[i]);
        shape.entropy_width = narrower(config->shape.entropy_width, factors[i]);
        ADCGS_TRY(count_weights(config, &shape, &weights, error));
        *bytes = (adcgs_train_prunes_units(config) ? UNITS_STAY : 1) * (double)weights * ADCGS_WEIGHT_BITS / 8;
        if (has_networks || *bytes <= fmax(share, room))
            break;
    }
    plan->shape = shape;
    return ADCGS_OK;
}

adcgs_status adcgs_rate_plan_make(adcgs_rate_plan *plan, const adcgs_train_config *c, adcgs_error *error)
{
    double networks;
    *plan =
        (adcgs_rate_plan){c->target == ADCGS_TARGET_NONE ? c->lambda : LAMBDA_FIRST, c->shape, c->start_anchors, c->max_anchors};
    if (c->target != ADCGS_TARGET_SIZE)
        return ADCGS_OK;
    ADCGS_TRY(plan_networks(plan, c, &networks, error));
    const double anchors = floor((c->target_value - networks - OTHER_BYTES) * 8 / ANCHOR_BITS);
    if (anchors < ANCHORS_LEAST)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%.0f bytes are too few: networks, cameras and headers alone take about %.0f",
                          c->target_value, networks + OTHER_BYTES);
    if (!adcgs_setting_is_given(c, "max_anchors"))
        plan->max_anchors = (uint32_t)fmax(fmin(anchors, fmin((double)c->max_anchors * ANCHORS_GROWTH, ADCGS_ANCHORS_MAX)),
                                           fmin(anchors * ANCHOR_BITS / FEWEST_BITS, c->max_anchors));
    plan->start_anchors = ADCGS_MIN(c->start_anchors, plan->max_anchors);
    return ADCGS_OK;
}
