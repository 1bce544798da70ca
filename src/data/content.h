/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What the files of a scene's views hold, in one number: whether pictures are those of another time. */
#ifndef ADCGS_DATA_CONTENT_H
#define ADCGS_DATA_CONTENT_H

#include "data/scene.h"

#define ADCGS_CONTENT_BYTES 16

/**
 * MD5 of the sizes and contents of all files that the views of a split are made of, in the order of the views; names do not
 * matter. All of them are read: some gigabytes a second at best.
 */
adcgs_status adcgs_scene_content(const adcgs_scene *scene, adcgs_split split, uint8_t digest[ADCGS_CONTENT_BYTES],
                                 adcgs_error *error);
/**
 * MD5 of all that the training views and the scene say besides their pictures, which are not read, and the places of files:
 * cameras, lenses, moments, frames, initial points. Two scenes that have it in common, and the same pictures, are learnt alike.
 */
void adcgs_scene_outline(const adcgs_scene *scene, uint8_t digest[ADCGS_CONTENT_BYTES]);

#endif
