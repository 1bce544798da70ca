/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Preview image of a run: a view as filmed, and next to it as the model renders it now. */
#ifndef ADCGS_SESSION_ENC_PREVIEW_H
#define ADCGS_SESSION_ENC_PREVIEW_H

#include "cli/cli.h"
#include "train/state/state.h"

typedef struct adcgs_enc_preview {
    const char *path;  /**< NULL: no preview */
    const char *stage; /**< of the last preview */
    double drawn;      /**< seconds of the run at the last preview */
    int failed;        /**< rendering or writing has failed, and was reported */
} adcgs_enc_preview;

/** Writes the preview before there is a model, white in the model's place, to find out whether it can be written. */
adcgs_status adcgs_enc_preview_begin(const char *path, const adcgs_scene *scene, adcgs_error *error);
/**
 * Writes the preview again after 30 seconds of the run or at a new stage; stage NULL: in any case. Neither the preview nor its
 * failure, reported once, affects the run. Call it between iterations.
 */
void adcgs_enc_preview_show(adcgs_enc_preview *preview, adcgs_trainer *t, const char *stage, adcgs_progress *progress);

#endif
