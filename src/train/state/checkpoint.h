/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checkpoints of a run, in files and in memory. */
#ifndef ADCGS_TRAIN_STATE_CHECKPOINT_H
#define ADCGS_TRAIN_STATE_CHECKPOINT_H

#include "train/state/state.h"

/**
 * Checkpoints hold everything needed to continue with identical results; the file is atomic, versioned and checksummed. Loading
 * returns ADCGS_ERR_DATA, with the mismatch in the message, if the file was saved with other options or another scene, including
 * its images. It also returns ADCGS_ERR_DATA for a state that no run can have. Two settings may differ. lambda may differ until
 * it affects the run, so that runs at several rates share their beginning. without_weight_steps may differ until weights are
 * rounded, so that its cost can be measured. The table of settings says from when a setting binds a run.
 */
adcgs_status adcgs_trainer_save(const adcgs_trainer *trainer, const char *path, adcgs_error *error);
/**
 * Saves the state of a failed run: the current state or, if the failure left it inconsistent, the last snapshot. Allocates no
 * memory and reads no images. If the images' digest is not known yet, the file contains none, and loading does not compare it.
 * adcgs_trainer_rescued(): the iteration of that state; 0: there is none worth saving.
 */
adcgs_status adcgs_trainer_rescue(const adcgs_trainer *trainer, const char *path, adcgs_error *error);
uint32_t adcgs_trainer_rescued(const adcgs_trainer *trainer);
adcgs_status adcgs_trainer_load(adcgs_trainer *trainer, const char *path, adcgs_error *error);
/**
 * Finds the mechanisms that trials (train/trial/trial.h) dropped before the run of a file, 1 each. A continued run has no trials.
 * A file that is no checkpoint has none: adcgs_trainer_load() reports it.
 */
adcgs_status adcgs_checkpoint_dropped(uint8_t dropped[ADCGS_MECHANISMS], const char *path, adcgs_error *error);
/** The same in memory, for rollback. Images are not compared. */
adcgs_status adcgs_trainer_store(const adcgs_trainer *trainer, adcgs_buffer *out, adcgs_error *error);
adcgs_status adcgs_trainer_restore(adcgs_trainer *trainer, const uint8_t *data, size_t size, adcgs_error *error);

#endif
