/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The kernels of the renderer's backward pass, AVX-512, without the rules that make them exact. */
#include "fast.h"

#define adcgs_back_avx512 bench_fast_back_avx512
#include "grad/raster_backward_avx512.c"
