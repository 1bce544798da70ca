/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --splats: one file of splats with the values of all frames, .splat4d or .4dgs. */
#ifndef ADCGS_APPS_DEC_DEC_PACKED_H
#define ADCGS_APPS_DEC_DEC_PACKED_H

#include "apps/dec/dec_rows.h"
#include "cli/cli.h"

/** True for these extensions. */
int adcgs_dec_packed_is(const char *target);
/** Writes the splats of all frames to one file. *n receives the number of rows. */
adcgs_status adcgs_dec_packed_write(uint32_t *n, adcgs_decoder *decoder, const adcgs_info *info, const adcgs_camera_path *frames,
                                    const char *target, adcgs_error *error);

#endif
