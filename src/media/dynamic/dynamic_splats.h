/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats over time, from any format that stores them: one reader for each, found by the content of the file. Times are seconds
 * from the first frame, positions are in world units. Formats with a time from 0 to 1 get their seconds from the options.
 */
#ifndef ADCGS_MEDIA_DYNAMIC_DYNAMIC_SPLATS_H
#define ADCGS_MEDIA_DYNAMIC_DYNAMIC_SPLATS_H

#include "media/splats/splats.h"
#include "media/video/fps.h"

#define ADCGS_DYNAMIC_FRAMES_MAX 100000 /**< frames of a source; chosen by hand, not measured */
#define ADCGS_DYNAMIC_FRAMES 50         /**< frames of a clip that does not state them; literature (SpacetimeGaussians' clips) */
#define ADCGS_DYNAMIC_RATE 30           /**< frames per second of such a clip; literature (Neural 3D Video) */
#define ADCGS_DYNAMIC_REMARK 200        /**< bytes of a remark; chosen by hand, not measured */

typedef struct adcgs_dynamic_options {
    adcgs_fps rate;  /**< frames per second; den 0: those of the file, else ADCGS_DYNAMIC_RATE */
    uint32_t frames; /**< frames of a clip with a time from 0 to 1; 0: those of the file, else ADCGS_DYNAMIC_FRAMES */
    int partial;     /**< accept a file of which only a part can be read: SpacetimeGaussians' full model without its network */
} adcgs_dynamic_options;

/** A source; members are constant after adcgs_dynamic_open(). */
typedef struct adcgs_dynamic {
    const struct adcgs_dynamic_reader *reader;
    char *path;
    adcgs_dynamic_options options;     /**< as requested */
    adcgs_fps rate;                    /**< frames per second */
    uint32_t frames;                   /**< number of frames, at least 1; frame i is at i / rate seconds */
    uint32_t n;                        /**< with identity: splats of every state; else those of the first frame */
    int has_identity;                  /**< splat k of any two states is the same splat, at opacity 0 where it does not exist */
    int is_continuous;                 /**< states between frames differ from those of the frames */
    char remark[ADCGS_DYNAMIC_REMARK]; /**< values that were assumed or lost, for the user; empty: none */
    const uint8_t *data; /**< the file, with a zero byte after it; NULL for a folder, and where the reader needs it no more */
    size_t bytes;
    void *state; /**< the reader's */
} adcgs_dynamic;

/**
 * True if path is a file of splats over time, by its content, or a folder of numbered files of static splats. False for one file
 * of static splats.
 */
int adcgs_dynamic_is(const char *path);
/**
 * Open a source. Splats are read now or when a state is requested; memory is at most that of a few states, or the size of the
 * file. options: NULL for the defaults.
 * \return ADCGS_ERR_DATA, naming the error and its position, for a file that is damaged, ends early or holds a non-finite number;
 * ADCGS_ERR_UNSUPPORTED for a feature of the format that is not read. On failure *out is NULL.
 */
adcgs_status adcgs_dynamic_open(adcgs_dynamic **out, const char *path, const adcgs_dynamic_options *options, adcgs_error *error);
/** Path of file i of the source, in the order of frames; NULL behind the last. */
const char *adcgs_dynamic_path(const adcgs_dynamic *dynamic, uint32_t i);
/** Seconds from the first frame to the last. */
double adcgs_dynamic_duration(const adcgs_dynamic *dynamic);
/**
 * The splats at a time; the caller frees *out with adcgs_splats_free(). Times outside of the clip are moved to its nearest end.
 * A source that is not continuous gives the latest frame that has begun; half a microsecond of rounding is allowed for. Any
 * thread may call, several at once.
 */
adcgs_status adcgs_dynamic_at(const adcgs_dynamic *dynamic, double seconds, adcgs_splats *out, adcgs_error *error);
/** As adcgs_dynamic_open() from memory, which is copied: for tests. */
adcgs_status adcgs_dynamic_parse(adcgs_dynamic **out, const uint8_t *data, size_t bytes, const char *path,
                                 const adcgs_dynamic_options *options, adcgs_error *error);
void adcgs_dynamic_free(adcgs_dynamic **dynamic);

#endif
