/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The vector variants of the dense kernels, for the dispatch alone. */
#ifndef ADCGS_SPLAT_DENSE_ISA_H
#define ADCGS_SPLAT_DENSE_ISA_H

#include "splat/dense.h"

extern const adcgs_dense_dsp adcgs_dense_avx2, adcgs_dense_avx512, adcgs_dense_wasm;

#endif
