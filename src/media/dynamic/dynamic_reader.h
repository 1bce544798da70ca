/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The table of readers of splats over time; each format is a row. */
#ifndef ADCGS_MEDIA_DYNAMIC_DYNAMIC_READER_H
#define ADCGS_MEDIA_DYNAMIC_DYNAMIC_READER_H

#include "media/dynamic/dynamic_splats.h"

#define ADCGS_DYNAMIC_LOOK 65536 /**< bytes of a file that identify its format, at most; chosen by hand, not measured */

typedef struct adcgs_dynamic_reader {
    const char *name; /**< for messages: "SpacetimeGaussians PLY" */
    /**
     * True if a file that begins with these bytes has the format. A zero byte follows the file. If no reader knows a ZIP archive
     * by its first bytes, there is a second call with all of them, since its directory is at its end.
     */
    int (*is)(const uint8_t *data, size_t bytes);
    int keeps_data; /**< nonzero: at() reads dynamic->data, which else is freed after open() */
    /**
     * Fill dynamic->state, rate, frames, n, has_identity, is_continuous and, if needed, remark. dynamic->path, options, data and
     * bytes are set. On failure the caller calls close().
     */
    adcgs_status (*open)(adcgs_dynamic *dynamic, adcgs_error *error);
    /** adcgs_dynamic_at() for a time within the clip. */
    adcgs_status (*at)(const adcgs_dynamic *dynamic, double seconds, adcgs_splats *out, adcgs_error *error);
    /** Free dynamic->state, which may be NULL or incomplete. */
    void (*close)(adcgs_dynamic *dynamic);
} adcgs_dynamic_reader;

/** Set rate and frames of a clip: the options first, then those of the file (den 0 and 0: unknown), then the defaults. */
void adcgs_dynamic_set_clock(adcgs_dynamic *dynamic, adcgs_fps rate, uint32_t frames);
/** Index of the frame that is shown at a time. */
uint32_t adcgs_dynamic_frame(const adcgs_dynamic *dynamic, double seconds);

/** at() and close() of readers whose state is an adcgs_motion from calloc(). */
adcgs_status adcgs_dynamic_motion_at(const adcgs_dynamic *dynamic, double seconds, adcgs_splats *out, adcgs_error *error);
void adcgs_dynamic_motion_close(adcgs_dynamic *dynamic);

#endif
