/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --budget: as much of a stream as bytes, splats or time allow. */
#ifndef ADCGS_TOOLS_DEC_BUDGET_H
#define ADCGS_TOOLS_DEC_BUDGET_H

#include <adcgs/adcgs.h>

typedef enum adcgs_budget_of { ADCGS_BUDGET_NONE, ADCGS_BUDGET_BYTES, ADCGS_BUDGET_SPLATS, ADCGS_BUDGET_TIME } adcgs_budget_of;

typedef struct adcgs_budget {
    adcgs_budget_of of;
    double most; /**< bytes, splats, or milliseconds a frame */
} adcgs_budget;

/** "40k", "20000splats", "16ms"; ADCGS_ERR_USAGE. */
adcgs_status adcgs_budget_parse(adcgs_budget *budget, const char *text, adcgs_error *error);
/** Open a stream of which no more bytes are read than the budget has. */
adcgs_status adcgs_budget_open(adcgs_decoder **decoder, const adcgs_budget *budget, adcgs_read_fn read, void *user,
                               const adcgs_config *config, adcgs_error *error);
/**
 * Have the decoder draw as many tiers, at least one, as splats or time of this frame allow; frame: of the camera's size, is
 * drawn. *tiers receives their number, 0 if it is all of them.
 */
adcgs_status adcgs_budget_fit(const adcgs_budget *budget, adcgs_decoder *decoder, const adcgs_camera *camera, double time,
                              adcgs_frame *frame, int *tiers, adcgs_error *error);

#endif
