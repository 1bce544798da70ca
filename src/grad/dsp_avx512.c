/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The trainer's kernels for CPU level avx512. */
#define ISA(name) name##_avx512
#include "grad/dsp_kernels.h"
