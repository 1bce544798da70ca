/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Whether all that was written to a stream has arrived. */
#ifndef ADCGS_CLI_FLUSH_H
#define ADCGS_CLI_FLUSH_H

#include <stdio.h>

/** Write out what is held back. \return 0, or an errno that tells why something was not written, now or earlier. */
int adcgs_file_flush(FILE *file);

#endif
