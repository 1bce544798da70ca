/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats as SOG, PlayCanvas' format: meta.json and lossless WebP images with
 * one pixel per splat, in a ZIP archive or a folder. Positions are stored as 16
 * bits of a logarithm, rotations as 26 bits, opacities as 8 bits, scales and
 * colours as indices into codebooks of 256 (version 1: as steps between
 * bounds), harmonics as indices of centroids. From its text,
 * https://developer.playcanvas.com/user-manual/gaussian-splatting/formats/sog.
 * There y is up, but programs keep the axes of the PLY that they convert, and
 * show y down. So axes are unknown after reading, and y is down in our files.
 */
#ifndef ADCGS_MEDIA_SPLATS_SOG_H
#define ADCGS_MEDIA_SPLATS_SOG_H

#include "media/splats/splats.h"

#include <stdio.h>

struct adcgs_zip_archive;

/**
 * adcgs_splats_parse() of a ZIP archive. ADCGS_ERR_UNSUPPORTED for another version than 1 and 2, for splats that change with time
 * (TSOG), and in a build without libwebp. On failure the caller clears *out.
 */
adcgs_status adcgs_sog_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
/** The same for the text of a meta.json at path. The images that it names are read from the same folder. */
adcgs_status adcgs_sog_parse_meta(adcgs_splats *out, const uint8_t *text, size_t bytes, const char *path, adcgs_error *error);
/** The splats of a TSOG (media/dynamic/tsog.c) without their times, in the order of the pixels. text: its meta.json. */
adcgs_status adcgs_sog_parse_timeless(adcgs_splats *out, const struct adcgs_zip_archive *zip, const uint8_t *text, size_t bytes,
                                      adcgs_error *error);
/**
 * Write version 2 to an open file; the caller checks it for errors. The splats are sorted along a Morton curve. The style's
 * comment is the generator's name. ADCGS_ERR_UNSUPPORTED for zero splats, and in a build without libwebp.
 */
adcgs_status adcgs_sog_put(const adcgs_splats *splats, const adcgs_splats_style *style, FILE *file, const char *path,
                           adcgs_error *error);

#endif
