/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kernels of the renderer, portable variant. */
#define ADCGS_LANES_ISA 0
#include "base/lanes.h"

#include "render/bin_kernels.h"
#include "render/blend_kernels.h"
#include "render/project_kernels.h"

const adcgs_raster_dsp adcgs_raster_scalar = {project, bin, blend};
