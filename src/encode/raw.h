/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A model stored without compression, as plain binary32 numbers: the baseline of compression ratios. */
#ifndef ADCGS_ENCODE_RAW_H
#define ADCGS_ENCODE_RAW_H

#include "fmodel/fmodel.h"

/**
 * Prepares a finished model for uncompressed storage. Each channel gets the finest step that still reaches all its values (about
 * 800 levels between the extremes). The entropy networks and eta are cleared, since no such file needs them. A stream of the
 * result is large, and shows the quality of the model itself.
 */
void adcgs_raw_prepare(adcgs_fmodel *f);

/**
 * Appends the numbers that define the rendered model, 4 bytes each, little-endian: positions [n][3] in scene units, f_v [n][N_v],
 * Sigma_v [n][6], C_v [n][3], f_g [N_g] of each primitive that exists, then all weights and biases of F_theta, F_omega and
 * F_varpi, and Z. Sizes, flags and masks of a few bits are not counted, so a real format of this kind would be larger.
 */
adcgs_status adcgs_raw_write(const adcgs_model *model, adcgs_buffer *out, adcgs_error *error);

#endif
