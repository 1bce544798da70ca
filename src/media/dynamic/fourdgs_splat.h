/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats of a .4dgs file from their integers. */
#ifndef ADCGS_MEDIA_DYNAMIC_FOURDGS_SPLAT_H
#define ADCGS_MEDIA_DYNAMIC_FOURDGS_SPLAT_H

#include "media/dynamic/fourdgs_streams.h"
#include "media/dynamic/motion.h"

/** n splats of the file's degree, cutoff and offset; with windows, without turns. */
adcgs_status adcgs_fourdgs_motion(adcgs_motion *motion, const adcgs_fourdgs *f, uint64_t n, adcgs_error *error);
/**
 * Set splat i from a row of integers and, with harmonics, from bytes [3][coefficients]. The window is cut to a chunk's interval.
 * ADCGS_ERR_DATA, naming the splat, for indices beyond their tables and values that are not finite.
 */
adcgs_status adcgs_fourdgs_set(adcgs_motion *motion, uint32_t i, const adcgs_fourdgs *f, const int32_t row[ADCGS_FOURDGS_ROW],
                               const uint8_t *harmonics, const adcgs_fourdgs_window *chunk, adcgs_error *error);

#endif
