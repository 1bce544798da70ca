/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc --or-whole: one segment for all of a scene's time, against those that it was cut into. */
#ifndef ADCGS_TOOLS_ENC_WHOLE_H
#define ADCGS_TOOLS_ENC_WHOLE_H

#include "tools/enc_run.h"

/**
 * Learn the scene as one segment, with as many iterations as its parts have had together, and compare it with the stream of the
 * parts, by bytes and by the PSNR of all training views, both decoded. Where it has no more of the one and no less of the other
 * it takes the place of that stream, in bytes; either way that is said. *spent: grows by what training takes.
 * Its checkpoint is that of a part behind the last.
 */
adcgs_status adcgs_enc_try_whole(adcgs_enc_watcher *watcher, const adcgs_enc_job *job, adcgs_buffer *bytes, adcgs_time *spent,
                                 adcgs_error *error);

#endif
