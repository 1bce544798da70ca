/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * All images of a split at one size, decoded once and kept. They are kept in memory up to a budget. Further ones go to an
 * unnamed file in TMPDIR (default: /var/tmp), up to the room there; the system reads ahead in it. Images without room are
 * decoded again from the scene's files for each use.
 * Values in [0,1] are kept in 16 bits, or in 8 bits where no bit is lost, so that no budget changes the result of training.
 * Images with values outside [0,1] are kept as binary32.
 */
#ifndef ADCGS_SCENE_IMAGE_STORE_H
#define ADCGS_SCENE_IMAGE_STORE_H

#include "base/thread_pool.h"
#include "scene/scene.h"
#include "scene/thumbnail_stats.h"

typedef struct adcgs_image_store adcgs_image_store;

/** Called by any thread, one at a time, with the number of images loaded so far out of n. Nonzero: stop. */
typedef int (*adcgs_image_store_progress)(void *user, uint32_t done, uint32_t n);

typedef struct adcgs_image_store_config {
    adcgs_split split;
    int divide;                          /**< sizes are divided by this, see adcgs_scene_image() */
    uint64_t memory;                     /**< limit in bytes of images in memory; 0: adcgs_image_store_default_memory() */
    adcgs_image_store_progress progress; /**< or NULL */
    void *user;
    adcgs_thumbnail *thumbnails; /**< [views] thumbnails to compute as images are loaded; or NULL */
} adcgs_image_store_config;

/** The default limit in bytes of images in memory: half of the machine's memory, or of the limit of a cgroup or of ulimit -v. */
uint64_t adcgs_image_store_default_memory(void);
/**
 * The scene must outlive the images. If several images fail, the error of the first one in the order of views is reported.
 * ADCGS_ERR_IO also if progress asks to stop.
 */
adcgs_status adcgs_image_store_load(adcgs_image_store **out, const adcgs_scene *scene, const adcgs_image_store_config *config,
                                    adcgs_pool *pool, adcgs_error *error);
void adcgs_image_store_free(adcgs_image_store **pictures);
/** The camera at the size of the images. */
const adcgs_camera *adcgs_image_store_camera(const adcgs_image_store *pictures, uint32_t view);
/**
 * Copies an image to the caller's rgb, planar [3][height][width], with values as from adcgs_scene_image(). Any thread may call.
 */
adcgs_status adcgs_image_store_get(const adcgs_image_store *pictures, uint32_t view, float *rgb, adcgs_error *error);
/** [height * width] 1 where a pixel is unknown (masked or clipped); NULL: all pixels are known. */
const uint8_t *adcgs_image_store_mask(const adcgs_image_store *pictures, uint32_t view);
/** Replaces a view's image by another one of the same size. No other thread may read at the same time. */
adcgs_status adcgs_image_store_put(adcgs_image_store *pictures, uint32_t view, const float *rgb, adcgs_error *error);
/** Announces that an image will be requested soon. Costs nothing if it is in memory. */
void adcgs_image_store_prefetch(const adcgs_image_store *pictures, uint32_t view);
/** Bytes used in memory, and in the file. */
void adcgs_image_store_size(const adcgs_image_store *pictures, uint64_t *memory, uint64_t *file);
/** Number of images that are decoded again for each use; *why: why there is no room for them. */
uint32_t adcgs_image_store_decoded_again(const adcgs_image_store *pictures, const char **why);

/** Estimated storage of images. */
typedef struct adcgs_image_store_need {
    uint64_t bytes;        /**< of all images, estimated from one or two of them */
    uint64_t memory, file; /**< bytes kept in memory and in the file; the rest is decoded again */
    uint64_t room;         /**< bytes available to the file */
    int problem;           /**< errno, if there is no room at all */
    uint32_t n, again;     /**< images, and the number of those that are decoded again */
} adcgs_image_store_need;

/**
 * The least bytes of all images of a split in memory, of 8 bits where these may suffice, without regard to the limit. Decodes
 * nothing.
 */
uint64_t adcgs_image_store_least(const adcgs_scene *scene, adcgs_split split, int divide);
/** Estimates the storage before images are loaded. Decodes one or two images, or none if all fit into memory as binary32. */
adcgs_status adcgs_image_store_estimate(adcgs_image_store_need *need, const adcgs_scene *scene,
                                        const adcgs_image_store_config *config, adcgs_error *error);

#endif
