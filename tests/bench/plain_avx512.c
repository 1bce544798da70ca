/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The baseline's kernels, AVX-512. */
#define ADCGS_LANES_ISA 512
#include "base/lanes.h"

#include "plain_kernels.h"

const plain_dsp plain_avx512 = {blend, back};
