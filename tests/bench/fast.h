/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The renderer's kernels, compiled without the rules that make them exact: with contraction, reciprocals and everything else that
 * -ffast-math allows. Two parts of it stay off, since they would break exp2 and the bounds of loops: reordering sums, and
 * assuming that there is no NaN. These kernels measure the cost of exactness.
 */
#ifndef ADCGS_BENCH_FAST_H
#define ADCGS_BENCH_FAST_H

#include "grad/raster_backward_isa.h"
#include "render/raster_isa.h"

extern const adcgs_raster_dsp bench_fast_raster_avx2, bench_fast_raster_avx512;
extern const adcgs_back_dsp bench_fast_back_avx2, bench_fast_back_avx512;

#endif
