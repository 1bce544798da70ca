/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --splats: one file of splats for a whole range of times. */
#ifndef ADCGS_APPS_DEC_DEC_CLIP_H
#define ADCGS_APPS_DEC_DEC_CLIP_H

#include "apps/dec/dec_rows.h"
#include "cli/cli.h"

/** True if the file name is that of a format of splats over time: .ftgs.ply or .splatv. */
int adcgs_dec_clip_is(const char *target);
/** Writes the splats of all frames to one file, and reports their error. input names the stream. */
adcgs_status adcgs_dec_clip_write(const adcgs_cli *cli, adcgs_decoder *decoder, const adcgs_info *info,
                                  const adcgs_camera_path *frames, const char *input, const char *target, adcgs_error *error);

#endif
