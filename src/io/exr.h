/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Writing OpenEXR through OpenEXRCore, the library's part in C. (Reading goes
 * through OpenImageIO.) EXR's colours are premultiplied by alpha;
 * adcgs_image's are not, so writing converts.
 */
#ifndef ADCGS_IO_EXR_H
#define ADCGS_IO_EXR_H

#include "io/image.h"

#include <stdio.h>

/** Scan lines, lossless ZIP compression, samples of binary16 (half) or binary32. path is for messages. */
adcgs_status adcgs_exr_write(FILE *file, const adcgs_image *image, int half, const char *path, adcgs_error *error);

#endif
