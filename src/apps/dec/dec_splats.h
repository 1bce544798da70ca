/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --splats: writes the splats of one or several times as files. */
#ifndef ADCGS_APPS_DEC_DEC_SPLATS_H
#define ADCGS_APPS_DEC_DEC_SPLATS_H

#include "camera/path.h"
#include "cli/cli.h"
#include "media/splats/splats.h"

/** Settings of the command line for splats. */
typedef struct adcgs_dec_splats_config {
    const char *target;
    int is_stable;            /**< row k is the same splat in all files */
    adcgs_splats_style style; /**< without its comment */
    int has_offset;
    double offset[3]; /**< subtracted from positions, in the stream's axes; without has_offset, that of a far scene */
} adcgs_dec_splats_config;

/**
 * Writes the splats at the requested times, each to a file of its own, or all to one file of a format of splats over time.
 * target has one number like %04d in its name, or there is only one time, or all times go to one file. Without requested times,
 * a target without a number gets the stream's first time, and other targets get all times. input names the stream.
 */
adcgs_status adcgs_dec_splats(const adcgs_cli *cli, adcgs_decoder *decoder, const char *input, const adcgs_dec_splats_config *how,
                              const adcgs_camera_path_request *request, adcgs_error *error);

#endif
