/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats as .ksplat, the format of mkkellogg's viewer GaussianSplats3D, version
 * 0.1. A header of 4096 bytes and headers of sections precede the sections. A
 * section has the lengths of its partly filled buckets, the centres of all
 * buckets, and records: position, standard deviations, quaternion w x y z,
 * colour and opacity as bytes, harmonics of degree 0 to 2. Level 0 holds
 * binary32. Levels 1 and 2 hold positions as 16 bits around the bucket's
 * centre, and binary16; level 2 holds harmonics as bytes. Axes are those of the
 * PLY that it was made from.
 */
#ifndef ADCGS_MEDIA_SPLATS_KSPLAT_H
#define ADCGS_MEDIA_SPLATS_KSPLAT_H

#include "media/splats/splats.h"

/* Origin: definition (.ksplat). Positions are in bytes. */
#define ADCGS_KSPLAT_HEADER 4096     /**< bytes of the header */
#define ADCGS_KSPLAT_SECTION 1024    /**< bytes of a section's header */
#define ADCGS_KSPLAT_VERSION 0x0100u /**< the first four bytes of version 0.1 */
#define ADCGS_KSPLAT_LEVELS 2        /**< the highest level of compression */
#define ADCGS_KSPLAT_SECTIONS 4      /**< position of the number of sections' headers in the header */
#define ADCGS_KSPLAT_LEVEL 20        /**< position of the level */
#define ADCGS_KSPLAT_LOW 36          /**< position of the smallest coefficient of harmonics; the largest follows */
#define ADCGS_KSPLAT_HIGH 40         /**< position of the largest one */
#define ADCGS_KSPLAT_USED 44         /**< bytes of the header that have a meaning */

/**
 * adcgs_splats_parse() of data that adcgs_ksplat_is() accepts. Coefficients of harmonics that a section lacks are zero.
 * ADCGS_ERR_UNSUPPORTED for harmonics of degree 3 and more. On failure the caller clears *out.
 */
adcgs_status adcgs_ksplat_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);

#endif
