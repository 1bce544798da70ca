/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One splat after the activations, checked and stored: for readers whose files may hold any numbers. */
#ifndef ADCGS_MEDIA_SPLATS_SPLAT_SET_H
#define ADCGS_MEDIA_SPLATS_SPLAT_SET_H

#include "media/splats/splats.h"

typedef struct adcgs_splat {
    double mean[3], scale[3]; /**< world units; standard deviations */
    double rotation[4];       /**< w x y z, of any length */
    double opacity;           /**< 0..1 */
    double colour[3];         /**< 0.5 + ADCGS_SPLATS_DC f_dc */
} adcgs_splat;

/**
 * Store a splat at an index. The rotation is normalised, a scale below ADCGS_SPLATS_SCALE_MIN raised to it, an opacity outside
 * 0..1 moved to the nearer end. ADCGS_ERR_DATA, naming path and index, for a number that is not finite, a negative scale or one
 * above ADCGS_SPLATS_SCALE_MAX, and a rotation of length 0.
 */
adcgs_status adcgs_splats_set(adcgs_splats *splats, uint32_t index, const adcgs_splat *splat, const char *path,
                              adcgs_error *error);
/** Allocate zeroed harmonics for a degree of 0 to 3. */
adcgs_status adcgs_splats_add_harmonics(adcgs_splats *splats, int degree, const char *path, adcgs_error *error);

/** A unit quaternion from three components in order; the omitted one, by its index, is not negative. */
void adcgs_rotation_of_three(double rotation[4], const double three[3], int omitted);

#endif
