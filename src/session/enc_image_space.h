/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Memory and disk space for a run's images, reported before training. */
#ifndef ADCGS_SESSION_ENC_IMAGE_SPACE_H
#define ADCGS_SESSION_ENC_IMAGE_SPACE_H

#include "session/enc_run.h"

/**
 * Reports the space of the run's images at full size, if they do not all fit into memory; once. Decodes an image or two in that
 * case.
 */
adcgs_status adcgs_enc_report_space(adcgs_enc_context *w, adcgs_error *error);
/**
 * Lets the scene keep decoded images while it is trained: with --memory up to that limit, else without more memory than the
 * training needs for its images at full size.
 */
void adcgs_enc_keep_images(const adcgs_enc_job *job, const adcgs_scene *scene);
/** Reports loaded images without space that was not foreseen to be missing. Once. */
void adcgs_enc_report_no_space(adcgs_enc_context *w);

#endif
