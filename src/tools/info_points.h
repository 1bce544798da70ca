/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --points: anchors as a point cloud. */
#ifndef ADCGS_TOOLS_INFO_POINTS_H
#define ADCGS_TOOLS_INFO_POINTS_H

#include "io/points.h"
#include "stream/stream.h"

/**
 * The anchors of the segment that plays at the middle of the stream, in the stream's order: positions in world units, less the
 * offset of a scene that is far from the origin (io/offset.h), where they are before anything moves; colours at that time, the
 * mean over an anchor's Gaussians, each weighed by its opacity, and mid-grey where there is none to be seen.
 */
adcgs_status adcgs_info_points(adcgs_points *out, double offset[3], const adcgs_stream *stream, const char *path,
                               adcgs_error *error);

#endif
