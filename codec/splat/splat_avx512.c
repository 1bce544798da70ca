/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kernels from network outputs to primitives, AVX-512 variant. */
#include "splat/splat_kernels.h"

const adcgs_splat_dsp adcgs_splat_avx512 = {anchor, predict, place, motion, deform, position_code};
