/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Parts of a .splat4d file, version 1 (splats4D of A. Raudonis): a JSON header, a static section with the splats at frame 0 and
 * masks of the attributes that change, and groups of frames with bins of these attributes.
 */
#ifndef ADCGS_MEDIA_DYNAMIC_SPLAT4D_H
#define ADCGS_MEDIA_DYNAMIC_SPLAT4D_H

#include "media/dynamic/byte_planes.h"
#include "media/dynamic/dynamic_splats.h"
#include "media/dynamic/recent_parts.h"

/** Attributes, with the numbers of the file; bits of masks. */
enum {
    ADCGS_SPLAT4D_MEAN,
    ADCGS_SPLAT4D_ROTATION,
    ADCGS_SPLAT4D_COLOUR,
    ADCGS_SPLAT4D_OPACITY,
    ADCGS_SPLAT4D_SCALE,
    ADCGS_SPLAT4D_ATTRIBUTES
};

typedef struct adcgs_splat4d_group {
    uint64_t offset, bytes; /**< of its chunk in the file */
    uint32_t first, n_frames;
} adcgs_splat4d_group;

typedef struct adcgs_splat4d {
    const char *path;
    const uint8_t *data; /**< the file */
    size_t bytes;
    uint32_t n, n_frames, n_groups;
    double fps;
    double step[ADCGS_SPLAT4D_ATTRIBUTES]; /**< of bins that change; logarithms for scales, else the unit of the attribute */
    double base_mean, base_scale;          /**< steps in the static section */
    uint64_t base_offset, base_bytes;      /**< of the static section in the file */
    adcgs_splat4d_group *groups;           /**< in order of frames, without gaps */
    /* The static section. */
    adcgs_splats base;
    uint32_t *moving[ADCGS_SPLAT4D_ATTRIBUTES], n_moving[ADCGS_SPLAT4D_ATTRIBUTES]; /**< splats whose attribute changes */
    adcgs_recent recent;                                                            /**< decoded groups */
} adcgs_splat4d;

/** A group of frames with its symbols unpacked. */
typedef struct adcgs_splat4d_part {
    uint32_t n_frames;
    uint8_t *planes[2][ADCGS_SPLAT4D_ATTRIBUTES]; /**< bins of the first frame, differences of the others; NULL: none change */
    int width[2][ADCGS_SPLAT4D_ATTRIBUTES];       /**< bytes of a symbol */
} adcgs_splat4d_part;

/** Header of a stream, whose `packed` lies in the section that was read. */
typedef struct adcgs_splat4d_stream {
    int attribute, kind, width;
    uint32_t elements;
    adcgs_packed packed;
} adcgs_splat4d_stream;

extern const char *const adcgs_splat4d_names[ADCGS_SPLAT4D_ATTRIBUTES]; /**< for messages: "positions" */
extern const int adcgs_splat4d_channels[ADCGS_SPLAT4D_ATTRIBUTES];

/** Read the header; path, data and bytes are set. */
adcgs_status adcgs_splat4d_header(adcgs_splat4d *s, adcgs_error *error);
/** Read the static section. */
adcgs_status adcgs_splat4d_base(adcgs_splat4d *s, adcgs_error *error);
/** Read the header of a stream at *at, not its data, and step behind it. where: "the static section", for messages. */
adcgs_status adcgs_splat4d_stream_header(adcgs_splat4d_stream *stream, const uint8_t **at, const uint8_t *end, const char *path,
                                         const char *where, adcgs_error *error);
/** Set one splat's attribute from its bins, in the units of steps; ADCGS_ERR_DATA, naming the splat, if it is not finite. */
adcgs_status adcgs_splat4d_set(adcgs_splats *splats, int attribute, uint32_t splat, const int64_t *bins, double step,
                               const char *path, adcgs_error *error);
/** Decode a group of frames: a make() of recent parts. */
adcgs_status adcgs_splat4d_make(void **part, const void *s, uint32_t group, adcgs_error *error);
void adcgs_splat4d_drop(void *part);
/** Put the attributes that change into out, a copy of the base; frame: from the first one of the group. */
adcgs_status adcgs_splat4d_frame(adcgs_splats *out, const adcgs_splat4d *s, const adcgs_splat4d_part *part, uint32_t frame,
                                 adcgs_error *error);

#endif
