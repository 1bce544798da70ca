/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A picture of how far a run is: a view as it was taken, and beside it as the model shows it now. */
#ifndef ADCGS_TOOLS_ENC_PREVIEW_H
#define ADCGS_TOOLS_ENC_PREVIEW_H

#include "cli/cli.h"
#include "train/state.h"

typedef struct adcgs_enc_preview {
    const char *path;  /**< NULL: nobody wants one */
    const char *stage; /**< of the last one */
    double drawn;      /**< seconds of the run at which that was */
    int failed;        /**< it could not be drawn, or written, which has been said */
} adcgs_enc_preview;

/** Write it before there is a model, all white in its place: so it turns out whether it can be written. */
adcgs_status adcgs_enc_preview_begin(const char *path, const adcgs_scene *scene, adcgs_error *error);
/**
 * Write it anew if 30 seconds of the run have gone by, or another stage has begun; NULL as stage: in any case. The run does not
 * depend on it, nor ends if it fails, which is said once. To be called between iterations.
 */
void adcgs_enc_preview_show(adcgs_enc_preview *preview, adcgs_trainer *t, const char *stage, adcgs_progress *progress);

#endif
