/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kernels of the backward pass of the renderer, portable variant. */
#define ADCGS_LANES_ISA 0 /* no vectors; definition */
#include "base/lanes.h"

#include "grad/raster_blend_kernels.h"
#include "grad/raster_project_kernels.h"

const adcgs_back_dsp adcgs_back_scalar = {blend_back, project_back};
