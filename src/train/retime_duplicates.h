/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Duplicated images. A recorder that misses a frame repeats the previous one. Such an image shows the previous frame, and
 * training at its own timestamp would blur moving content over both positions.
 */
#ifndef ADCGS_TRAIN_RETIME_DUPLICATES_H
#define ADCGS_TRAIN_RETIME_DUPLICATES_H

#include "train/state/state.h"

/**
 * Sets the timestamps of the training views in [0,1]. A duplicated image (check/faults.h) gets the timestamp of the previous
 * image. thumbnails: of all training views.
 */
adcgs_status adcgs_retime_duplicates(adcgs_trainer *trainer, const adcgs_thumbnail *thumbnails, adcgs_error *error);

#endif
