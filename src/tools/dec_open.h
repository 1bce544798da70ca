/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec: opening a stream, be it a file, standard input or what a URL names. */
#ifndef ADCGS_TOOLS_DEC_OPEN_H
#define ADCGS_TOOLS_DEC_OPEN_H

#include "cli/cli.h"
#include "io/http.h"
#include "tools/dec_budget.h"

/** What the command line says about it. */
typedef struct adcgs_dec_open_config {
    const adcgs_cli *cli;
    const adcgs_budget *budget; /**< of bytes: no more are read */
    const adcgs_config *config;
} adcgs_dec_open_config;

/**
 * Open it. "-" is standard input. *http is what a decoder of a URL goes on reading while it is open, to be closed after it; NULL
 * where all was read.
 */
adcgs_status adcgs_dec_open(adcgs_decoder **decoder, adcgs_http **http, const char *input, const adcgs_dec_open_config *how,
                            adcgs_error *error);

/** Say so if the stream's beginning was past already: config.join. */
adcgs_status adcgs_dec_tell_joined(const adcgs_cli *cli, const adcgs_decoder *decoder, const char *name, adcgs_error *error);

#endif
