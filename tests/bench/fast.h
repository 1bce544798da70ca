/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The renderer's kernels once more, compiled without the rules that make them exact: with contraction, reciprocals and all else
 * that -ffast-math allows, but for reordering sums and denying NaN, which would break exp2 and the bounds of loops. They tell
 * what exactness costs.
 */
#ifndef ADCGS_BENCH_FAST_H
#define ADCGS_BENCH_FAST_H

#include "grad/raster_isa.h"
#include "render/raster_isa.h"

extern const adcgs_raster_dsp bench_fast_raster_avx2, bench_fast_raster_avx512;
extern const adcgs_back_dsp bench_fast_back_avx2, bench_fast_back_avx512;

#endif
