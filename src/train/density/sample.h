/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Measurements on a sample of training views, as a basis of decisions. */
#ifndef ADCGS_TRAIN_DENSITY_SAMPLE_H
#define ADCGS_TRAIN_DENSITY_SAMPLE_H

#include "train/state/state.h"

/** Mean loss of up to `most` training views, evenly spread, at their own times or all at the middle of time. */
adcgs_status adcgs_sample_loss(adcgs_trainer *trainer, uint32_t most, int own_time, double *loss, adcgs_error *error);

/**
 * Cost of a network's current weights apart from their own bits, in bits at lambda's price: the loss of some training views or,
 * for an entropy network (which must be on its lattice), the features' bits.
 */
adcgs_status adcgs_sample_distortion(adcgs_trainer *trainer, int group, double *bits, adcgs_error *error);

/**
 * Mean PSNR of up to `most` training views at full size, evenly spread, as a player shows them. Before values are frozen, it
 * includes quantisation errors. Fast if views are loaded at full size.
 */
adcgs_status adcgs_sample_psnr(struct adcgs_trainer *trainer, uint32_t most, double *psnr, adcgs_error *error);

#endif
