/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Panoramas: photos whose metadata declare another projection than that of a lens. */
#ifndef ADCGS_MEDIA_IMAGE_PANORAMA_H
#define ADCGS_MEDIA_IMAGE_PANORAMA_H

#include "base/base.h"

#define ADCGS_PANORAMA_NAME 24 /**< bytes of a projection's name, with its zero; chosen by hand, not measured */

/**
 * The projection that a JPEG declares, "equirectangular" for all that surrounds a camera: GPano:ProjectionType in a packet of
 * XMP, among the n first bytes. "" if it declares none.
 */
void adcgs_panorama_find(char projection[ADCGS_PANORAMA_NAME], const uint8_t *data, size_t n);
/** The same of a file; "" if it is no JPEG. */
adcgs_status adcgs_panorama_of(char projection[ADCGS_PANORAMA_NAME], const char *path, adcgs_error *error);

#endif
