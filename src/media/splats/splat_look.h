/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file Formats of splats without a magic number, found by their first bytes. Each function gets the first n bytes of a file of
 * `size` bytes; a few kilobytes are enough.
 */
#ifndef ADCGS_MEDIA_SPLATS_SPLAT_LOOK_H
#define ADCGS_MEDIA_SPLATS_SPLAT_LOOK_H

#include "base/base.h"

/** .splat: all whole records are valid splats. */
int adcgs_dot_splat_is(const uint8_t *data, size_t n, uint64_t size);
/** .ksplat: the header's version, level and counts are valid, and the file is long enough for the sections' headers. */
int adcgs_ksplat_is(const uint8_t *data, size_t n, uint64_t size);
/** The meta.json of an unpacked SOG: JSON with bounds of means, and names of WebP images. */
int adcgs_sog_meta_is(const uint8_t *data, size_t n);

#endif
