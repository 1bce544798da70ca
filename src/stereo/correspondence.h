/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Correspondences: points known from other cameras, searched in a camera's image around their expected positions or in the whole
 * image.
 */
#ifndef ADCGS_STEREO_CORRESPONDENCE_H
#define ADCGS_STEREO_CORRESPONDENCE_H

#include "stereo/smooth.h"

enum { ADCGS_SIGHT_MARKS = 224, ADCGS_SIGHTS = 1024 };

/** A keypoint: a pixel with known depth and a window that differs from those of adjacent pixels. */
typedef struct adcgs_mark {
    int px, py;
    double depth;
} adcgs_mark;

/** An image prepared for the search. Zero-initialise before use. */
typedef struct adcgs_outlook {
    const adcgs_stereo_view *view;
    float *grey; /**< [h][w] */
    float *over; /**< [h][w] inverse norm of the window around a pixel; 0: no usable window */
    int n_marks;
    adcgs_mark mark[ADCGS_SIGHT_MARKS];
} adcgs_outlook;

/** A correspondence: a point known from camera `from`, and its position in the image. */
typedef struct adcgs_sight {
    double x[3], at[2];
    int from;
} adcgs_sight;

typedef struct adcgs_sights {
    int n;
    adcgs_sight sight[ADCGS_SIGHTS];
} adcgs_sights;

/** changes: [h][w] of the view, 1 at pixels to ignore. depths: of the view. */
adcgs_status adcgs_outlook_init(adcgs_outlook *outlook, const adcgs_stereo_view *view, const uint8_t *changes,
                                const adcgs_depths *depths, adcgs_error *error);
void adcgs_outlook_clear(adcgs_outlook *outlook);

/**
 * Searches for keypoints of another camera, one in `every` of them. pose: assumed pose of `in`; its pixels are not used. The
 * search covers `reach` pixels around the position that this pose predicts. A reach of 0 searches the whole image, under the
 * assumption that both cameras look in the same direction. alike: scratch, [h][w].
 */
void adcgs_sights_add(adcgs_sights *sights, const adcgs_outlook *in, const adcgs_stereo_view *pose, const adcgs_outlook *other,
                      int from, int every, int reach, float *alike);

#endif
