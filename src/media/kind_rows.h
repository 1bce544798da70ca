/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rows of the tables of kinds: the advice that several kinds share, a macro per class, and the search by first bytes. */
#ifndef ADCGS_MEDIA_KIND_ROWS_H
#define ADCGS_MEDIA_KIND_ROWS_H

#include "media/kind.h"

#define TO_PNG "convert it to PNG, JPEG, TIFF or EXR first"
#define TO_JPEG "develop it to JPEG, TIFF or PNG first"
#define COLMAP_FOLDER "give the folder that has the model and its images"
#define TO_COLMAP "export the cameras as a COLMAP model, or as transforms.json"

/* clang-format off */
#define IMAGE(name, reader) {ADCGS_KIND_IMAGE, name, reader, NULL, 1, 0}
#define NO_IMAGE(name, advice) {ADCGS_KIND_IMAGE, name, NULL, advice, 0, 0}
#define VIDEO(name) {ADCGS_KIND_VIDEO, name, NULL, NULL, 1, 0}
#define SPLATS(name) {ADCGS_KIND_SPLATS, name, NULL, NULL, 1, 0}
#define NO_SPLATS(name, advice) {ADCGS_KIND_SPLATS, name, NULL, advice, 0, 0}
#define OVER_TIME(name) {ADCGS_KIND_SPLATS, name, NULL, NULL, 1, 1}
#define POINTS(name) {ADCGS_KIND_POINTS, name, NULL, NULL, 1, 0}
#define NO_POINTS(name, advice) {ADCGS_KIND_POINTS, name, NULL, advice, 0, 0}
#define NO_SCENE(name, advice) {ADCGS_KIND_SCENE, name, NULL, advice, 0, 0}
#define OTHER(name, advice) {ADCGS_KIND_OTHER, name, NULL, advice, 0, 0}
/* clang-format on */

/** The kind of a file by fixed bytes at a fixed place among its first n; NULL: they identify none. */
const adcgs_kind *adcgs_kind_by_magic(const uint8_t *begin, size_t n);

#endif
