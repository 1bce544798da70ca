/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * C interface to OpenImageIO, for formats without a reader or writer of ours.
 * No exception and no C++ type crosses it. OpenImageIO needs about 250 shared
 * libraries, which take many times a decoder's run time to load. So the shim is
 * a module of its own, opened when the first image needs it. A build without
 * shared libraries links it.
 */
#ifndef ADCGS_MEDIA_IMAGE_OIIO_SHIM_H
#define ADCGS_MEDIA_IMAGE_OIIO_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

#include "media/image/image.h"
#include "media/image/photo.h"
#include "system/module.h"

#include <stdio.h>

/**
 * Functions of the module. Any thread may call them. Functions that a build of OpenImageIO lacks return ADCGS_ERR_UNSUPPORTED.
 */
typedef struct adcgs_oiio {
    const char *version; /**< version of the programs that the module belongs to */
    /** Size of an open image, by the named reader alone: "tiff". path is for messages. */
    adcgs_status (*probe)(int *width, int *height, int *channels, FILE *file, const char *reader, const char *path,
                          adcgs_error *error);
    /** The first image in the file, as sRGB with straight alpha. A depth channel after the colours is dropped. */
    adcgs_status (*read)(adcgs_image *out, FILE *file, const char *reader, const char *path, adcgs_error *error);
    /**
     * Encode in memory with 8 or 16 bits, in the format of `extension`; the caller free()s *data. Messages name `path`.
     * ADCGS_ERR_USAGE if the format does not support such samples, or the image's alpha.
     */
    adcgs_status (*encode)(uint8_t **data, size_t *bytes, const adcgs_image *image, int bits, const char *extension,
                           const char *path, adcgs_error *error);
    /** Fill in the header's values other than the size. Values that are not numbers count as missing. */
    adcgs_status (*tell)(adcgs_photo *photo, FILE *file, const char *reader, const char *path, adcgs_error *error);
    adcgs_status (*shape)(adcgs_image *image, int turn, int width, int height, const char *path, adcgs_error *error);
} adcgs_oiio;

/** The module's only exported symbol. */
ADCGS_MODULE_EXPORT extern const adcgs_oiio adcgs_oiio_table;

/** The module's table (see module.h). path: the file that messages name. ADCGS_ERR_UNSUPPORTED if the module is missing. */
adcgs_status adcgs_oiio_get(const adcgs_oiio **oiio, const char *path, adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif
