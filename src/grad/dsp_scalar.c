/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The trainer's kernels for CPU level scalar. */
#define ISA(name) name##_scalar
#include "grad/dsp_kernels.h"
