/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The table of options as the shell's completion reads it (share/adcgs.bash). */
#ifndef ADCGS_CLI_COMPLETION_H
#define ADCGS_CLI_COMPLETION_H

#include "cli/cli.h"

/**
 * Print a line for each option, as `program --completion` does, with tabs between: name, letter or -, kind (flag, value, file),
 * what the help calls the value or -, words that the value may be or be made of, with blanks between, or -, what it does. The
 * last line is that of the operands: a name of -, kind file if there are any.
 */
void adcgs_cli_print_completion(const adcgs_cli *cli);

#endif
