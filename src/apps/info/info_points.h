/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --points: anchors as a point cloud. */
#ifndef ADCGS_APPS_INFO_INFO_POINTS_H
#define ADCGS_APPS_INFO_INFO_POINTS_H

#include "media/points/points.h"
#include "stream/stream.h"

/**
 * Returns the anchors of the segment at the middle of the stream, in the stream's order. Positions are in world units, before any
 * motion, less the offset of a scene far from the origin (media/splats/offset.h). Colours are those at that time: the mean over
 * an anchor's Gaussians, weighted by opacity, or mid-grey if none is visible.
 */
adcgs_status adcgs_info_points(adcgs_points *out, double offset[3], const adcgs_stream *stream, const char *path,
                               adcgs_error *error);

#endif
