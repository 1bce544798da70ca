/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Digests of the files of a scene's views and of its metadata, to detect that images have changed. */
#ifndef ADCGS_SCENE_CONTENT_H
#define ADCGS_SCENE_CONTENT_H

#include "scene/scene.h"

#define ADCGS_CONTENT_BYTES 16 /* bytes of an MD5; definition */

/**
 * MD5 of the sizes and contents of all files that make up the views of a split, in the order of the views; file names do not
 * matter. Reads all files: some gigabytes a second at best.
 */
adcgs_status adcgs_scene_content(const adcgs_scene *scene, adcgs_split split, uint8_t digest[ADCGS_CONTENT_BYTES],
                                 adcgs_error *error);
/**
 * MD5 of the metadata of the scene and its training views: cameras, lenses, times, frames, initial points. It covers neither
 * image contents, which are not read, nor file paths. Two scenes with equal metadata and equal images train identically.
 */
void adcgs_scene_outline(const adcgs_scene *scene, uint8_t digest[ADCGS_CONTENT_BYTES]);

#endif
