/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-enc --or-whole: compares one segment for the whole time of a scene with its cut segments. */
#ifndef ADCGS_SESSION_ENC_WHOLE_H
#define ADCGS_SESSION_ENC_WHOLE_H

#include "session/enc_run.h"

/**
 * Trains the scene as one segment, with as many iterations as its parts together, and compares it with the stream of the parts,
 * by bytes and by the PSNR of all training views, both decoded. If it has at most as many bytes, and its PSNR is higher or
 * less than 0.05 dB lower, it replaces that stream in bytes. The function reports the decision. *spent grows by the training
 * time. The checkpoint has the name of a part after the last.
 */
adcgs_status adcgs_enc_try_whole(adcgs_enc_context *context, const adcgs_enc_job *job, adcgs_buffer *bytes, adcgs_time *spent,
                                 adcgs_error *error);

#endif
