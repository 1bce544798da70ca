/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The loss kernels for AVX2. */
#define ADCGS_LANES_ISA 256 /* bits of a vector; definition */
#define KERNEL adcgs_loss_strip_avx2
#include "grad/loss_kernels.h"
