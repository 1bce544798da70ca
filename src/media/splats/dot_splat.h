/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats as .splat, the format of antimatter15's viewer: records of 32 bytes
 * without a header. A record is the position and the standard deviations as
 * binary32, red, green, blue and opacity as bytes, and a quaternion w x y z
 * with the components (byte - 128) / 128. Axes are those of the PLY that it was
 * made from. From its text, https://github.com/antimatter15/splat: README.md.
 */
#ifndef ADCGS_MEDIA_SPLATS_DOT_SPLAT_H
#define ADCGS_MEDIA_SPLATS_DOT_SPLAT_H

#include "media/splats/splats.h"

/* Origin: definition (.splat). */
#define ADCGS_DOT_SPLAT_BYTES 32    /**< bytes of a record */
#define ADCGS_DOT_SPLAT_SCALE 12    /**< position of the standard deviations in it, in bytes */
#define ADCGS_DOT_SPLAT_COLOUR 24   /**< position of the colour */
#define ADCGS_DOT_SPLAT_ROTATION 28 /**< position of the rotation */

/** adcgs_splats_parse() of data that adcgs_dot_splat_is() accepts. On failure the caller clears *out. */
adcgs_status adcgs_dot_splat_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

#endif
