/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * OpenImageIO seen from C. No exception and no C++ type crosses this border.
 * What a build of OpenImageIO cannot do gives ADCGS_ERR_UNSUPPORTED.
 */
#ifndef ADCGS_IO_OIIO_SHIM_H
#define ADCGS_IO_OIIO_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

#include "io/image.h"

adcgs_status adcgs_oiio_probe(int *width, int *height, int *channels, const char *path, adcgs_error *error);
/** The first picture in the file; straight alpha. */
adcgs_status adcgs_oiio_read(adcgs_image *out, const char *path, adcgs_error *error);
/** 8 bit to the file `name`, in the format that `extension` stands for; messages name `path`. */
adcgs_status adcgs_oiio_write(const adcgs_image *image, const char *name, const char *extension, const char *path,
                              adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif
