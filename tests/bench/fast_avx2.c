/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The renderer's kernels, AVX2, without the rules that make them exact. */
#include "fast.h"

#define adcgs_raster_avx2 bench_fast_raster_avx2
#include "render/raster_avx2.c"
