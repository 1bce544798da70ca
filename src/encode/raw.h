/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A model as it would be stored without compression: plain binary32 numbers. It
 * is what compressed files are measured against.
 */
#ifndef ADCGS_ENCODE_RAW_H
#define ADCGS_ENCODE_RAW_H

#include "fmodel/fmodel.h"

/**
 * Prepare a finished model for being stored uncompressed: to each channel the finest step that still reaches all its values
 * (about 800 levels between the extremes), and nothing in the entropy networks and eta, which no such file needs. A stream of
 * it is large, and shows what the model itself can do.
 */
void adcgs_raw_prepare(adcgs_fmodel *f);

/**
 * Append the numbers that draw the model, 4 bytes each, little-endian: positions [n][3] in scene units, f_v [n][N_v],
 * Sigma_v [n][6], C_v [n][3], f_g [N_g] of each primitive that exists, then all weights and biases of F_theta, F_omega and
 * F_varpi, and Z. Not counted are sizes, flags and masks of a few bits, so a real format of this kind would be larger.
 */
adcgs_status adcgs_raw_write(const adcgs_model *model, adcgs_buffer *out, adcgs_error *error);

#endif
