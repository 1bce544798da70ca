/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The command line of adcgs-enc. */
#ifndef ADCGS_APPS_ENC_ENC_COMMAND_H
#define ADCGS_APPS_ENC_ENC_COMMAND_H

#include "session/enc_run.h"

/** Parses and checks the options and the operand. \return -1 to continue, else the exit code to leave with */
int adcgs_enc_parse(adcgs_cli *cli, adcgs_enc_options *o, int argc, char **argv);

#endif
