/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The loss kernels as portable C. */
#define ADCGS_LANES_ISA 0 /* no vectors; definition */
#define KERNEL adcgs_loss_strip_scalar
#include "grad/loss_kernels.h"
