/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kernels of the renderer, AVX2 variant. */
#define ADCGS_LANES_ISA 256
#include "base/lanes.h"

#include "render/bin_kernels.h"
#include "render/blend_kernels.h"
#include "render/project_kernels.h"

const adcgs_raster_dsp adcgs_raster_avx2 = {project, bin, blend};
