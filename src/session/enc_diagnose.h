/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Warnings on a scene's cameras after a run: with wrong cameras the stream is valid, but of low quality. */
#ifndef ADCGS_SESSION_ENC_DIAGNOSE_H
#define ADCGS_SESSION_ENC_DIAGNOSE_H

#include "cli/cli.h"
#include "scene/scene.h"

#include <adcgs/types.h>

/**
 * Measures some of the training views of the stream, with gain and black level fitted, and prints warnings unless --quiet.
 * Warnings cover cameras that render far worse than the others, much worse views that training never saw (unseen: their PSNR; NaN
 * if there are none), and too few cameras. A view that cannot be measured ends the check without a message, and so does an
 * interrupt beyond the earlier ones.
 */
void adcgs_enc_diagnose(const adcgs_cli *cli, adcgs_decoder *decoder, const adcgs_scene *scene, double unseen, const char *file,
                        int interrupts);

#endif
