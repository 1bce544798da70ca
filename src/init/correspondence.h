/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Correspondences: points known from other cameras, searched in a camera's image around their expected positions or in the whole
 * image.
 */
#ifndef ADCGS_INIT_CORRESPONDENCE_H
#define ADCGS_INIT_CORRESPONDENCE_H

#include "init/smooth.h"

/* Maximum numbers of keypoints of an image and of correspondences of a camera; chosen by hand, not measured. */
enum { ADCGS_KEYPOINTS_MAX = 224, ADCGS_CORRESPONDENCES_MAX = 1024 };

/** A keypoint: a pixel with known depth and a window that differs from those of adjacent pixels. */
typedef struct adcgs_keypoint {
    int px, py;
    double depth;
} adcgs_keypoint;

/** An image prepared for the search. Zero-initialise before use. */
typedef struct adcgs_patch_image {
    const adcgs_stereo_view *view;
    float *grey; /**< [h][w] */
    float *over; /**< [h][w] inverse norm of the window around a pixel; 0: no usable window */
    int n_keypoints;
    adcgs_keypoint keypoint[ADCGS_KEYPOINTS_MAX];
} adcgs_patch_image;

/** A correspondence: a point known from camera `from`, and its position in the image. */
typedef struct adcgs_correspondence {
    double x[3], at[2];
    int from;
} adcgs_correspondence;

typedef struct adcgs_correspondences {
    int n;
    adcgs_correspondence match[ADCGS_CORRESPONDENCES_MAX];
} adcgs_correspondences;

/** unstable: [h][w] of the view, 1 at pixels to ignore. depths: of the view. */
adcgs_status adcgs_patch_image_init(adcgs_patch_image *image, const adcgs_stereo_view *view, const uint8_t *unstable,
                                    const adcgs_depths *depths, adcgs_error *error);
void adcgs_patch_image_clear(adcgs_patch_image *image);

/**
 * Searches for keypoints of another camera, one in `every` of them. pose: assumed pose of `in`; its pixels are not used. The
 * search covers `reach` pixels around the position that this pose predicts. A reach of 0 searches the whole image, under the
 * assumption that both cameras look in the same direction. alike: scratch, [h][w].
 */
void adcgs_correspondences_add(adcgs_correspondences *matches, const adcgs_patch_image *in, const adcgs_stereo_view *pose,
                               const adcgs_patch_image *other, int from, int every, int reach, float *alike);

#endif
