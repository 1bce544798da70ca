/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Flushing a stream, with all errors. */
#ifndef ADCGS_SYSTEM_FLUSH_H
#define ADCGS_SYSTEM_FLUSH_H

#include <stdio.h>

/** Flush a stream. \return 0, or the errno of output that could not be written, now or earlier. */
int adcgs_file_flush(FILE *file);

#endif
