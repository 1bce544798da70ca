/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * All images of a split at one size, decoded once and kept: in memory up to a
 * budget, then in an unnamed file of TMPDIR (/var/tmp without it) up to the room
 * there, which the system reads ahead. Images without room are decoded again
 * from the scene's files for each use.
 * Values in [0,1] are kept in 16 bits, or in 8 where that is the same, so that no
 * budget changes the result of training; those of an image that goes beyond are
 * kept as binary32.
 */
#ifndef ADCGS_DATA_PICTURES_H
#define ADCGS_DATA_PICTURES_H

#include "base/pool.h"
#include "data/glance.h"
#include "data/scene.h"

typedef struct adcgs_pictures adcgs_pictures;

/** Told how many of n are there, by any thread, one at a time; nonzero: stop. */
typedef int (*adcgs_pictures_progress)(void *user, uint32_t done, uint32_t n);

typedef struct adcgs_pictures_config {
    adcgs_split split;
    int divide;        /**< sizes are divided by this, see adcgs_scene_load() */
    uint64_t memory;   /**< bytes of images in memory at most; 0: adcgs_pictures_usual_memory() */
    adcgs_pictures_progress progress; /**< or NULL */
    void *user;
    adcgs_glance *glances; /**< [views] taken of each picture as it is loaded; or NULL */
} adcgs_pictures_config;

/** Bytes in memory at most, unless they are given: half of the machine's, or of the limit of a cgroup or of ulimit -v. */
uint64_t adcgs_pictures_usual_memory(void);
/**
 * The scene must outlive them. The first failure of a picture, in their order, is the one reported; ADCGS_ERR_IO also when
 * progress says stop.
 */
adcgs_status adcgs_pictures_load(adcgs_pictures **out, const adcgs_scene *scene, const adcgs_pictures_config *config,
                                 adcgs_pool *pool, adcgs_error *error);
void adcgs_pictures_free(adcgs_pictures **pictures);
/** At the size of the pictures. */
const adcgs_camera *adcgs_pictures_camera(const adcgs_pictures *pictures, uint32_t view);
/** rgb: planar [3][height][width], the caller's, as adcgs_scene_load() gives it. Any thread. */
adcgs_status adcgs_pictures_get(const adcgs_pictures *pictures, uint32_t view, float *rgb, adcgs_error *error);
/** [height * width] 1 where a picture is masked; NULL: nowhere. */
const uint8_t *adcgs_pictures_hidden(const adcgs_pictures *pictures, uint32_t view);
/** Put another picture of the same size in a view's place; no other thread may read meanwhile. */
adcgs_status adcgs_pictures_put(adcgs_pictures *pictures, uint32_t view, const float *rgb, adcgs_error *error);
/** That a picture will be asked for soon. Costs nothing when it is in memory. */
void adcgs_pictures_expect(const adcgs_pictures *pictures, uint32_t view);
/** Bytes in memory, and in the file. */
void adcgs_pictures_size(const adcgs_pictures *pictures, uint64_t *memory, uint64_t *file);
/** Images that are decoded again each time they are asked for, and why there is no room for them. */
uint32_t adcgs_pictures_decoded_again(const adcgs_pictures *pictures, const char **why);

/** How much room images will take, and where. */
typedef struct adcgs_pictures_need {
    uint64_t bytes;         /**< of all of them, estimated from one or two of them */
    uint64_t memory, file;  /**< of these, kept in memory and in the file; the rest is decoded again */
    uint64_t room;          /**< for the file */
    int problem;            /**< errno, where there is no room at all */
    uint32_t n, again;      /**< images, and those that are decoded again */
} adcgs_pictures_need;

/** Before they are loaded. Decodes one or two images, but none where all fit into memory as binary32. */
adcgs_status adcgs_pictures_foresee(adcgs_pictures_need *need, const adcgs_scene *scene, const adcgs_pictures_config *config,
                                    adcgs_error *error);

#endif
