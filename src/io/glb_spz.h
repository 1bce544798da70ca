/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats that a GLB file packs as SPZ: KHR_gaussian_splatting_compression_spz_2, also by the name that it had before. From its
 * draft, https://github.com/KhronosGroup/glTF/pull/2531.
 */
#ifndef ADCGS_IO_GLB_SPZ_H
#define ADCGS_IO_GLB_SPZ_H

#include "io/glb_numbers.h"
#include "io/splats.h"

/** Whether an extension has this meaning. */
int adcgs_glb_is_spz(const char *extension);
/**
 * The splats of the view that `packed`, the extension's value, names, in the axes of glTF. As many as the accessors of the
 * primitive say, should it have some.
 */
adcgs_status adcgs_glb_take_spz(adcgs_splats *out, const adcgs_glb *glb, json_t *packed);

#endif
