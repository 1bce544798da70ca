/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What a sample of training views says of the model as it is: the measures by which decisions are taken. */
#ifndef ADCGS_TRAIN_SAMPLE_H
#define ADCGS_TRAIN_SAMPLE_H

#include "train/state.h"

/** Mean loss of up to `most` training views, spread evenly: each at its own time, or all at the middle of time. */
adcgs_status adcgs_sample_loss(adcgs_trainer *trainer, uint32_t most, int own_time, double *loss, adcgs_error *error);

/**
 * What a network of now costs elsewhere, in bits at lambda's price: the loss of some training views, or for an entropy network
 * (which must be on its lattice) the features' bits.
 */
adcgs_status adcgs_sample_distortion(adcgs_trainer *trainer, int group, double *bits, adcgs_error *error);

/**
 * Mean PSNR of up to `most` training views in full size, spread evenly, as a player shows them; before values are frozen, with
 * the errors that quantisation makes or will make. Quick where views are loaded in full size.
 */
adcgs_status adcgs_sample_psnr(struct adcgs_trainer *trainer, uint32_t most, double *psnr, adcgs_error *error);

#endif
