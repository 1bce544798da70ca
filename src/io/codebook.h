/* SPDX-License-Identifier: BSD-2-Clause */
/** \file 256 values that stand for many: each value is near one of them, in the mean of squares. */
#ifndef ADCGS_IO_CODEBOOK_H
#define ADCGS_IO_CODEBOOK_H

#include "base/base.h"

#define ADCGS_CODEBOOK 256

/** Of n finite values, which are sorted; book rises. \return 0 where there was no memory. */
int adcgs_codebook_make(float book[ADCGS_CODEBOOK], float *values, size_t n);
/** Index of the nearest. */
uint8_t adcgs_codebook_find(const float book[ADCGS_CODEBOOK], float value);

#endif
