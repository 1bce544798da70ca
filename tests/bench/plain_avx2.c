/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The baseline's kernels, AVX2. */
#define ADCGS_LANES_ISA 256
#include "base/lanes.h"

#include "plain_kernels.h"

const plain_dsp plain_avx2 = {blend, back};
