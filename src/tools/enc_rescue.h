/* SPDX-License-Identifier: BSD-2-Clause */
/** \file States that a run leaves when it is stopped, or fails: hours are not lost to a full disk. */
#ifndef ADCGS_TOOLS_ENC_RESCUE_H
#define ADCGS_TOOLS_ENC_RESCUE_H

#include "tools/enc_run.h"

/** Whether --finish could make a file of the state; segments behind the one that is trained would be missing. */
int adcgs_enc_is_ready(const adcgs_enc_watcher *w);
/**
 * Save the state as name, or if that fails under the same last part in TMPDIR (/var/tmp without it). *path: where it is, from
 * malloc(). reads_images: their digest is wanted, for which their files may have to be read; where that fails it is done without.
 */
adcgs_status adcgs_enc_save(const adcgs_enc_watcher *w, const char *name, int reads_images, char **path, adcgs_error *error);
/** "stopped at iteration N; ...", by which command the run continues from that state. */
void adcgs_enc_say_how_to_go_on(const adcgs_cli *cli, const adcgs_enc_watcher *w, const char *what, const char *path);
/** The run has failed, for which there is a message already: save the state, if there is one, and say how to continue. */
void adcgs_enc_rescue(const adcgs_cli *cli, adcgs_enc_watcher *w, adcgs_status status);

#endif
