/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --budget: the part of a stream that bytes, splats or time allow. */
#ifndef ADCGS_APPS_DEC_DEC_BUDGET_H
#define ADCGS_APPS_DEC_DEC_BUDGET_H

#include <adcgs/adcgs.h>

typedef enum adcgs_budget_of { ADCGS_BUDGET_NONE, ADCGS_BUDGET_BYTES, ADCGS_BUDGET_SPLATS, ADCGS_BUDGET_TIME } adcgs_budget_of;

typedef struct adcgs_budget {
    adcgs_budget_of of;
    double most; /**< bytes, splats, or milliseconds per frame */
} adcgs_budget;

/** Parses "40k", "20000splats" or "16ms"; ADCGS_ERR_USAGE. */
adcgs_status adcgs_budget_parse(adcgs_budget *budget, const char *text, adcgs_error *error);
/** Opens a stream and reads at most the budget's bytes. */
adcgs_status adcgs_budget_open(adcgs_decoder **decoder, const adcgs_budget *budget, adcgs_read_fn read, void *user,
                               const adcgs_config *config, adcgs_error *error);
/**
 * Sets the number of tiers, at least one, that the splats or the render time of this frame allow. frame has the camera's size and
 * is rendered. *tiers receives the number, 0 for all tiers.
 */
adcgs_status adcgs_budget_fit(const adcgs_budget *budget, adcgs_decoder *decoder, const adcgs_camera *camera, double time,
                              adcgs_frame *frame, int *tiers, adcgs_error *error);

#endif
