/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Records of a .4dgs file, version 1 draft (avala-ai/4dgs): a header, steps of quantization, windows of time, chunks of splats,
 * and poses of rigid objects. Other records are skipped.
 */
#ifndef ADCGS_MEDIA_DYNAMIC_FOURDGS_H
#define ADCGS_MEDIA_DYNAMIC_FOURDGS_H

#include "media/dynamic/byte_cursor.h"
#include "media/dynamic/byte_planes.h"
#include "media/splats/splats.h"

/* Attributes of splats; those up to the window are in each chunk. Origin: definition (the registry of .4dgs). */
enum {
    ADCGS_FOURDGS_POSITION,
    ADCGS_FOURDGS_SCALE,
    ADCGS_FOURDGS_OMITTED, /* component of the rotation that is not stored */
    ADCGS_FOURDGS_ROTATION,
    ADCGS_FOURDGS_COLOUR,
    ADCGS_FOURDGS_OPACITY,
    ADCGS_FOURDGS_MOTION,
    ADCGS_FOURDGS_CENTRE,
    ADCGS_FOURDGS_SIGMA,
    ADCGS_FOURDGS_FLAGS,
    ADCGS_FOURDGS_WINDOW,
    ADCGS_FOURDGS_REQUIRED,
    ADCGS_FOURDGS_ID = 13, /* of a splat, in files of keyframes */
    ADCGS_FOURDGS_OBJECT,  /* the splat's rigid object; 0: none */
    ADCGS_FOURDGS_ATTRIBUTES
};

/* Bits of sets of attributes. Origin: arithmetic. */
enum {
    ADCGS_FOURDGS_ALL = (1 << ADCGS_FOURDGS_REQUIRED) - 1,
    ADCGS_FOURDGS_HAS_ID = 1 << ADCGS_FOURDGS_ID,
    ADCGS_FOURDGS_HAS_OBJECT = 1 << ADCGS_FOURDGS_OBJECT
};

#define ADCGS_FOURDGS_BANDS 3 /**< bands of harmonics; definition (.4dgs) */

typedef struct adcgs_fourdgs_range {
    const uint8_t *data; /**< in the file; NULL: absent */
    uint64_t bytes;
} adcgs_fourdgs_range;

typedef struct adcgs_fourdgs_chunk {
    uint64_t offset, length; /**< of the record in the file */
    double begin, end;       /**< seconds */
    uint32_t level;
    uint32_t n;                                     /**< splats that it introduces: all of a keyframe, else births */
    uint64_t population;                            /**< splats of its state */
    adcgs_packed streams;                           /**< of attributes */
    adcgs_fourdgs_range bands[ADCGS_FOURDGS_BANDS]; /**< harmonics of these splats */
    /* Of changes to another chunk; else 0. */
    int is_delta, mode;
    uint32_t updates, deaths, depth;
    uint64_t reference_offset, keyframe_offset;
    uint32_t reference; /**< index of the other chunk, which comes earlier */
} adcgs_fourdgs_chunk;

typedef struct adcgs_fourdgs_window {
    double begin, end; /**< seconds */
} adcgs_fourdgs_window;

/** A rigid object's poses: 8 binary64 each, time, rotation x y z w, translation. */
typedef struct adcgs_fourdgs_track {
    uint32_t object, n;
    int is_step; /**< true: poses hold until the next one */
    const uint8_t *poses;
} adcgs_fourdgs_track;

typedef struct adcgs_fourdgs {
    const char *path;
    const uint8_t *data; /**< the file */
    size_t bytes;
    /* Header. */
    double duration, cutoff, box[6]; /**< seconds; 0..1; least x y z, greatest x y z */
    uint64_t n;                      /**< splats, or distinct ids with keyframes */
    int has_keyframes, degree;
    /* Quantization. */
    int has_steps;
    double origin[3], step_position, step_scale, step_rotation, step_colour, step_opacity, step_motion, step_time, step_sigma;
    /* Other records. */
    adcgs_fourdgs_window *windows;
    adcgs_fourdgs_chunk *chunks; /**< in the order of the file */
    adcgs_fourdgs_track *tracks; /**< by object */
    uint32_t n_windows, n_chunks, n_tracks;
    uint64_t summary, footer; /**< offset of the index, 0: none; offset of the last record */
    uint32_t summary_crc;     /**< 0: none */
} adcgs_fourdgs;

extern const char *const adcgs_fourdgs_names[ADCGS_FOURDGS_ATTRIBUTES]; /**< for messages: "positions" */

/** Read all records; path, data and bytes are set. Also on failure the caller calls adcgs_fourdgs_free(). */
adcgs_status adcgs_fourdgs_read(adcgs_fourdgs *f, adcgs_error *error);
void adcgs_fourdgs_free(adcgs_fourdgs *f);
/** Read the content of one chunk, changes to a chunk, or entry of the index: the records that other files of this folder read. */
adcgs_status adcgs_fourdgs_read_chunk(adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor content, int is_delta,
                                      adcgs_error *error);
adcgs_status adcgs_fourdgs_check_index(const adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor content, adcgs_error *error);
adcgs_status adcgs_fourdgs_read_track(adcgs_fourdgs *f, uint64_t offset, adcgs_byte_cursor content, adcgs_error *error);
/** Sort tracks by object; ADCGS_ERR_DATA for two of one object. */
adcgs_status adcgs_fourdgs_sort_tracks(adcgs_fourdgs *f, adcgs_error *error);
/**
 * Move splats whose object has a track, once, by its pose at a time; offset: of splats' means. objects: of each splat, NULL for
 * none.
 */
adcgs_status adcgs_fourdgs_move(adcgs_splats *splats, const uint32_t *objects, const adcgs_fourdgs *f, double seconds,
                                adcgs_error *error);

#endif
