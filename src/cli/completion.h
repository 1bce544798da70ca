/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The table of options for the shell's completion (share/adcgs.bash). */
#ifndef ADCGS_CLI_COMPLETION_H
#define ADCGS_CLI_COMPLETION_H

#include "cli/cli.h"

/**
 * Print a line for each option, as `program --completion` does, separated by tabs: name; letter or -; kind (flag, value, file);
 * name of the value in the help, or -; words that the value may consist of, separated by blanks, or -; description. The last line
 * describes the operands: name -, kind file if there are any and they are files.
 */
void adcgs_cli_print_completion(const adcgs_cli *cli);

#endif
