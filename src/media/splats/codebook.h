/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Codebooks: 256 values that approximate many values with a small mean squared error. */
#ifndef ADCGS_MEDIA_SPLATS_CODEBOOK_H
#define ADCGS_MEDIA_SPLATS_CODEBOOK_H

#include "base/base.h"

#define ADCGS_CODEBOOK 256 /**< entries; definition (SOG: an index is a byte) */

/** Compute the codebook of n finite values; sorts them. book is ascending. \return 0 on allocation failure */
int adcgs_codebook_make(float book[ADCGS_CODEBOOK], float *values, size_t n);
/** Index of the nearest entry. */
uint8_t adcgs_codebook_find(const float book[ADCGS_CODEBOOK], float value);

#endif
