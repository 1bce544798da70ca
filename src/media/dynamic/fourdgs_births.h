/* SPDX-License-Identifier: BSD-2-Clause */
/** \file .4dgs files of the model gaussian-birth: each splat has a lifetime and a velocity of its own. */
#ifndef ADCGS_MEDIA_DYNAMIC_FOURDGS_BIRTHS_H
#define ADCGS_MEDIA_DYNAMIC_FOURDGS_BIRTHS_H

#include "media/dynamic/fourdgs_splat.h"

/**
 * Read the splats of all chunks, in the order of the file. *objects, from malloc(): the object of each splat; NULL if the file
 * has no tracks. Also on failure the caller frees both.
 */
adcgs_status adcgs_fourdgs_births(adcgs_motion *motion, uint32_t **objects, const adcgs_fourdgs *f, adcgs_error *error);

#endif
