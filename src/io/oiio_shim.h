/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * OpenImageIO seen from C, for formats that we have no better way to. No exception and no C++ type crosses this border.
 * It brings some 250 shared libraries along, which take a decoder's time many
 * times over to load; so the shim is a module of its own, opened when the first
 * picture needs it. A build without shared libraries links it.
 */
#ifndef ADCGS_IO_OIIO_SHIM_H
#define ADCGS_IO_OIIO_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

#include "io/image.h"
#include "io/module.h"
#include "io/photo.h"

#include <stdio.h>

/** What the module offers. What a build of OpenImageIO cannot do gives ADCGS_ERR_UNSUPPORTED. Any thread may call. */
typedef struct adcgs_oiio {
    const char *version; /**< of the programs that the module belongs to */
    /** Of a file that is open, by the reader of that name and no other: "tiff". path is for messages. */
    adcgs_status (*probe)(int *width, int *height, int *channels, FILE *file, const char *reader, const char *path,
                          adcgs_error *error);
    /** The first picture in the file, as sRGB with straight alpha. A depth channel behind the colours is left out. */
    adcgs_status (*read)(adcgs_image *out, FILE *file, const char *reader, const char *path, adcgs_error *error);
    /**
     * With 8 or 16 bits, in the format that `extension` stands for, into memory: the caller free()s *data. Messages name `path`.
     * ADCGS_ERR_USAGE when the format has no such samples, or no alpha and the image has.
     */
    adcgs_status (*encode)(uint8_t **data, size_t *bytes, const adcgs_image *image, int bits, const char *extension,
                           const char *path, adcgs_error *error);
    /** Fill in what the header says besides the size. What is no number there is as if it were not there. */
    adcgs_status (*tell)(adcgs_photo *photo, FILE *file, const char *reader, const char *path, adcgs_error *error);
    adcgs_status (*shape)(adcgs_image *image, int turn, int width, int height, const char *path, adcgs_error *error);
} adcgs_oiio;

/** The one thing that the module exports. */
ADCGS_MODULE_EXPORT extern const adcgs_oiio adcgs_oiio_table;

/** The module's table (see module.h), for the file `path`, which messages name. ADCGS_ERR_UNSUPPORTED when it is not there. */
adcgs_status adcgs_oiio_get(const adcgs_oiio **oiio, const char *path, adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif
