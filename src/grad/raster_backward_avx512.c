/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kernels of the backward pass of the renderer, AVX-512 variant. */
#define ADCGS_LANES_ISA 512 /* bits of a vector; definition */
#include "base/lanes.h"

#include "grad/raster_blend_kernels.h"
#include "grad/raster_project_kernels.h"

const adcgs_back_dsp adcgs_back_avx512 = {blend_back, project_back};
