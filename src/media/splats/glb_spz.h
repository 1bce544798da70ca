/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats that a GLB file packs as SPZ:
 * KHR_gaussian_splatting_compression_spz_2, also under its former name. From
 * its draft, https://github.com/KhronosGroup/glTF/pull/2531.
 */
#ifndef ADCGS_MEDIA_SPLATS_GLB_SPZ_H
#define ADCGS_MEDIA_SPLATS_GLB_SPZ_H

#include "media/splats/glb_numbers.h"
#include "media/splats/splats.h"

/** True if an extension is one of these two. */
int adcgs_glb_is_spz(const char *extension);
/**
 * Read the splats of the view that `packed`, the extension's value, refers to, in the axes of glTF. Their number must equal the
 * counts of the primitive's accessors, if it has any.
 */
adcgs_status adcgs_glb_take_spz(adcgs_splats *out, const adcgs_glb *glb, json_t *packed);

#endif
