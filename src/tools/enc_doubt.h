/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What a run says about a scene's cameras: those that cannot be right leave a stream that is sound and shows little. */
#ifndef ADCGS_TOOLS_ENC_DOUBT_H
#define ADCGS_TOOLS_ENC_DOUBT_H

#include "cli/cli.h"
#include "data/scene.h"

#include <adcgs/types.h>

/**
 * Measure some of the training views that the stream was made of, with gain and black level fitted, and note, unless --quiet,
 * cameras that are drawn far worse than the others, views that training never saw that are (unseen: their PSNR; not a number if
 * there are none), and cameras that are too few. A view that cannot be measured is no reason to say more, and so
 * is an interrupt beyond those heard before.
 */
void adcgs_enc_doubt(const adcgs_cli *cli, adcgs_decoder *decoder, const adcgs_scene *scene, double unseen, const char *file,
                     int heard);

#endif
