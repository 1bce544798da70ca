/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec: opens a stream from a file, standard input or a URL. */
#ifndef ADCGS_APPS_DEC_DEC_OPEN_H
#define ADCGS_APPS_DEC_DEC_OPEN_H

#include "apps/dec/dec_budget.h"
#include "cli/cli.h"
#include "media/operand.h"

/** Settings of the command line for opening. */
typedef struct adcgs_dec_open_config {
    const adcgs_cli *cli;
    const adcgs_budget *budget; /**< bytes: reading stops there */
    const adcgs_config *config;
} adcgs_dec_open_config;

/**
 * Opens the stream. "-" is standard input. The decoder may keep reading *source, a page or a URL: close it after the decoder.
 */
adcgs_status adcgs_dec_open(adcgs_decoder **decoder, adcgs_operand *source, const char *input, const adcgs_dec_open_config *how,
                            adcgs_error *error);

/** Prints a remark if the decoder tuned in after the stream's beginning (config.tune_in). */
adcgs_status adcgs_dec_report_tune_in(const adcgs_cli *cli, const adcgs_decoder *decoder, const char *name, adcgs_error *error);

#endif
