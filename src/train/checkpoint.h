/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checkpoints of a run, in files and in memory. */
#ifndef ADCGS_TRAIN_CHECKPOINT_H
#define ADCGS_TRAIN_CHECKPOINT_H

#include "train/state.h"

/**
 * Checkpoints: everything needed to go on with identical results; atomic file, versioned, checksummed. Loading one saved with
 * other options or another scene, pictures included, is ADCGS_ERR_DATA, which says what differs, and
 * so is one that no run can have left; only lambda may be another
 * while it has had no say, so that runs at several rates share their beginning, and without_weight_steps before weights are
 * rounded, so that its price can be told: the table of settings says from when on a run is bound to each.
 */
adcgs_status adcgs_trainer_save(const adcgs_trainer *trainer, const char *path, adcgs_error *error);
/**
 * Save the state of a run that has failed: the present one, or where the failure left that inconsistent, the last
 * snapshot. Takes no memory and reads no images: unless their digest is known already, the file has none, and loading it
 * does not compare it. adcgs_trainer_rescued(): the iteration of that state; 0: there is none worth saving.
 */
adcgs_status adcgs_trainer_rescue(const adcgs_trainer *trainer, const char *path, adcgs_error *error);
uint32_t adcgs_trainer_rescued(const adcgs_trainer *trainer);
adcgs_status adcgs_trainer_load(adcgs_trainer *trainer, const char *path, adcgs_error *error);
/**
 * Turn off in config the mechanisms that trials decide (train/trial.h) and that are off in a file: a run that goes on has no
 * trials again. A file that is no checkpoint changes nothing: adcgs_trainer_load() reports it.
 */
adcgs_status adcgs_checkpoint_adopt(adcgs_train_config *config, const char *path, adcgs_error *error);
/** The same to and from memory (rollback), where pictures are taken on trust. */
adcgs_status adcgs_trainer_store(const adcgs_trainer *trainer, adcgs_buffer *out, adcgs_error *error);
adcgs_status adcgs_trainer_restore(adcgs_trainer *trainer, const uint8_t *data, size_t size, adcgs_error *error);

#endif
