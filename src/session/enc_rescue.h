/* SPDX-License-Identifier: BSD-2-Clause */
/** \file States that a run leaves when it is stopped or fails: a full disk must not cost hours of training. */
#ifndef ADCGS_SESSION_ENC_RESCUE_H
#define ADCGS_SESSION_ENC_RESCUE_H

#include "session/enc_run.h"

/** True if --finish could make a file of the state; later segments would be missing. */
int adcgs_enc_is_ready(const adcgs_enc_context *w);
/**
 * Saves the state as name, or, if that fails, under the same base name in TMPDIR (/var/tmp without it). *path: the place, from
 * malloc(). reads_images: includes the images' digest, for which their files may have to be read; if that fails, the state is
 * saved without the digest.
 */
adcgs_status adcgs_enc_save(const adcgs_enc_context *w, const char *name, int reads_images, char **path, adcgs_error *error);
/** Prints "stopped at iteration N; ..." with the command that continues the run from that state. */
void adcgs_enc_report_continuation(const adcgs_cli *cli, const adcgs_enc_context *w, const char *what, const char *path);
/** For a failed run, whose message has been printed: saves the state, if there is one, and prints how to continue. */
void adcgs_enc_rescue(const adcgs_cli *cli, adcgs_enc_context *w, adcgs_status status);

#endif
