/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The baseline's kernels, portable C. */
#define ADCGS_LANES_ISA 0
#include "base/lanes.h"

#include "plain_kernels.h"

const plain_dsp plain_scalar = {blend, back};
