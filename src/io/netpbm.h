/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Binary PGM and PPM (P5, P6), 8 and 16 bit. */
#ifndef ADCGS_IO_NETPBM_H
#define ADCGS_IO_NETPBM_H

#include "io/image.h"

#include <stdio.h>

/** The file is at its start and stays the caller's; path is for messages. */
adcgs_status adcgs_netpbm_probe(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error);
adcgs_status adcgs_netpbm_read(FILE *file, adcgs_image *out, const char *path, adcgs_error *error);
/** bits: 8 or 16; alpha is left out. Failures of the stream show in ferror(). */
adcgs_status adcgs_netpbm_write(FILE *file, const adcgs_image *image, int bits, const char *path, adcgs_error *error);

#endif
