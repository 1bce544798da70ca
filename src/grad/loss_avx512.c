/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The loss kernels for AVX-512. */
#define ADCGS_LANES_ISA 512 /* bits of a vector; definition */
#define KERNEL adcgs_loss_strip_avx512
#include "grad/loss_kernels.h"
