/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A scene whose footage arrives while it is recorded, cut into segments. A thread of its own looks for new footage, so that
 * arrival times are exact despite other work. The trainer waits for one segment after another.
 *
 * A segment ends at the frame of any camera that is nearest to a multiple of its length. The next one begins with that frame,
 * as in a recorded scene (scene/part.h). A segment is complete when each of its frames is available or missing. An image is
 * missing when one taken two frames later is available, when any camera is ahead of it by a segment, or at the end; footage
 * from a pipe is always waited for. These rules alone determine the frames of a segment; if none is missing, the footage alone
 * does.
 *
 * Footage ends with a file named `end` next to the scene file, or when all cameras end. A camera ends when its pipe is closed,
 * or when its numbered images have reached their count.
 */
#ifndef ADCGS_SCENE_LIVE_LIVE_SCENE_H
#define ADCGS_SCENE_LIVE_LIVE_SCENE_H

#include "scene/layouts/open.h"

typedef struct adcgs_live adcgs_live;

typedef struct adcgs_live_options {
    double seconds;           /**< minimum length of a segment */
    int unbounded;            /**< pipes are read without a limit; else writers wait once the next segments are available */
    const char *points_path;  /**< initial points instead of the scene's, or NULL */
    int (*interrupted)(void); /**< returns nonzero to stop at the footage found so far; called now and then */
    /**
     * Of a stream to continue: begin and end of its last segment in seconds, and its frame of reference; scale 0: none. Earlier
     * footage is skipped. If the last segment ended in the middle of a stretch, for lack of footage at the time, that stretch
     * is given again, as a whole; but not if the segment was cut in another way.
     */
    double last[2], origin[3], scale;
} adcgs_live_options;

/**
 * path: a scene file, or a folder with one that is named scene.json. The footage need not have begun. A pipe cannot repeat
 * earlier footage: when a stream is to be continued, a pipe makes the next segment fail with ADCGS_ERR_USAGE.
 */
adcgs_status adcgs_live_open(adcgs_live **out, const char *path, const adcgs_live_options *options, adcgs_error *error);
void adcgs_live_close(adcgs_live **live);

/** A stretch of time and its footage. Zero-initialise before use. */
typedef struct adcgs_live_segment {
    adcgs_scene *scene; /**< training views, with times from the segment's begin; part of adcgs_live_whole(). NULL: the end */
    double begin, end;  /**< seconds from the scene's beginning */
    double came;        /**< adcgs_seconds() when its last frame arrived */
} adcgs_live_segment;

/**
 * Clears the previous segment and waits for the next one with more than one frame time. Its images exist until the next call.
 * ADCGS_ERR_DATA for invalid footage. It is also ADCGS_ERR_DATA if the footage ends with a single time and no stream is to be
 * continued.
 */
adcgs_status adcgs_live_next(adcgs_live *live, adcgs_live_segment *segment, adcgs_error *error);
void adcgs_live_segment_clear(adcgs_live_segment *segment);

/** The data that all segments share, taken from the first one. Segments are parts of it. NULL before the first segment. */
const adcgs_scene *adcgs_live_whole(const adcgs_live *live);

/** Returns a camera with missing images that was not returned before; *time is that of its first missing image. NULL: none. */
const char *adcgs_live_missing(adcgs_live *live, double *time);
/**
 * Stores the times of the first two frames of each camera, in seconds, to at, unless at is NULL. Returns their number. Call it
 * after the first segment.
 */
uint32_t adcgs_live_times(const adcgs_live *live, double *at);

#endif
