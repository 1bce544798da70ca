/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A scene whose footage comes while it is taken, cut into segments. A thread of its own looks for what has come, so that it is
 * known when it did, whatever else is going on; whoever learns waits for one segment after the other.
 *
 * A segment ends at the frame of any camera that is nearest to a multiple of its length; the next one begins with that frame,
 * as it does where a scene is cut that is there as a whole (data/part.h). It is complete when each frame in it is there or is
 * missing. A picture is missing when one that was taken two frames later is there, when any camera is ahead of it by a segment,
 * or at the end; a pipe is waited for. Which frames a segment has follows from these rules alone, and, where none is missing,
 * from the footage alone.
 *
 * The end: a file named `end` beside the scene file, or that all cameras end, which pipes do that are closed, and rows of
 * pictures that have their count.
 */
#ifndef ADCGS_LAYOUTS_LIVE_H
#define ADCGS_LAYOUTS_LIVE_H

#include "layouts/open.h"

typedef struct adcgs_live adcgs_live;

typedef struct adcgs_live_options {
    double seconds;  /**< of a segment, at least */
    int unbounded;   /**< pipes are read however much they bring; else whoever writes waits once segments behind them are there */
    const char *points_path; /**< initial points instead of the scene's, or NULL */
    int (*interrupted)(void); /**< whether to take no more than what was seen so far; asked now and then */
    /**
     * Of a stream that is to go on: seconds of its last segment's begin and end, and its frame of reference; scale 0: none.
     * Footage before is passed over. Where the last segment ended in the middle of a stretch, since no more had come then, it is
     * given anew, as a whole; but not if it was cut otherwise.
     */
    double last[2], origin[3], scale;
} adcgs_live_options;

/**
 * path: a scene file, or a folder with one that is named scene.json. The footage need not have begun. A pipe does not bring again
 * what was before: where a stream is to go on it is an error, ADCGS_ERR_USAGE of the next segment.
 */
adcgs_status adcgs_live_open(adcgs_live **out, const char *path, const adcgs_live_options *options, adcgs_error *error);
void adcgs_live_close(adcgs_live **live);

/** Some stretch of time and what was taken in it. Zero-initialise before use. */
typedef struct adcgs_live_segment {
    adcgs_scene *scene;   /**< views for training, times from the segment's begin on; whole is adcgs_live_whole(). NULL: over */
    double begin, end;    /**< seconds from the scene's beginning */
    double came;          /**< adcgs_seconds() when the last of it came */
} adcgs_live_segment;

/**
 * Wait for the next segment that shows more than one moment; the one before is cleared. Its pictures stay until the next call.
 * ADCGS_ERR_DATA where footage is no such, or one moment is all that there is in the end and no stream is to go on.
 */
adcgs_status adcgs_live_next(adcgs_live *live, adcgs_live_segment *segment, adcgs_error *error);
void adcgs_live_segment_clear(adcgs_live_segment *segment);

/** What is the same of all segments, by the first of them, and of which they are parts: NULL before there is one. */
const adcgs_scene *adcgs_live_whole(const adcgs_live *live);

/** A camera of which pictures were missing since the last call, and when it was the first time; NULL: none. */
const char *adcgs_live_missing(adcgs_live *live, double *time);
/** Seconds of the first two frames of each camera, to at, unless that is NULL; how many. There was a segment. */
uint32_t adcgs_live_times(const adcgs_live *live, double *at);

#endif
