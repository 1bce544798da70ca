/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The renderer's kernels, AVX-512, without the rules that make them exact. */
#include "fast.h"

#define adcgs_raster_avx512 bench_fast_raster_avx512
#include "render/raster_avx512.c"
