/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Encoding by OpenImageIO, inside the shim: C++ that may throw. */
#ifndef ADCGS_MEDIA_IMAGE_OIIO_ENCODE_H
#define ADCGS_MEDIA_IMAGE_OIIO_ENCODE_H

#include <string>

#include "media/image/oiio_shim.h"

/** As adcgs_oiio.encode(), but exceptions pass. */
adcgs_status adcgs_oiio_encode(uint8_t **data, size_t *bytes, const adcgs_image *image, int bits, const char *extension,
                               const char *path, adcgs_error *error);

/** The first line of a message of the library; further lines may repeat the file's name. */
static inline std::string adcgs_oiio_first_line(const std::string &text)
{
    return text.empty() ? "no reason given" : text.substr(0, text.find('\n'));
}

#endif
