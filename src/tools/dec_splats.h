/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --splats: the splats of moments as files. */
#ifndef ADCGS_TOOLS_DEC_SPLATS_H
#define ADCGS_TOOLS_DEC_SPLATS_H

#include "camera/path.h"
#include "cli/cli.h"

/** What the command line says about it. */
typedef struct adcgs_dec_splats_config {
    const char *target;
    int rest_degree; /**< see adcgs_splats_style */
} adcgs_dec_splats_config;

/**
 * Write the splats at the moments asked for, each to a file of its own: target has one number like %04d in its name, or there is
 * one moment. Without times that is the stream's first moment, for a target without a number, else all. input names the stream.
 */
adcgs_status adcgs_dec_splats(const adcgs_cli *cli, adcgs_decoder *decoder, const char *input,
                              const adcgs_dec_splats_config *how, const adcgs_camera_path_request *request, adcgs_error *error);

#endif
