/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The trainer's kernels for CPU level avx2. */
#define ISA(name) name##_avx2
#include "grad/dsp_kernels.h"
