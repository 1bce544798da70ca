/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Decoded images of a scene, kept for their next use. An image is kept as its file has it, before compositing, undistortion and
 * reduction, so that every size follows from it with the same values. Any thread may call.
 *
 * Uses of a scene's images are sweeps over all of them, so the image that was used last is the one that is needed last. An
 * image without room is not kept, and the image used last is dropped first. Images that have not been used since the last call
 * of adcgs_image_cache_limit() are dropped before all others.
 */
#ifndef ADCGS_SCENE_IMAGE_CACHE_H
#define ADCGS_SCENE_IMAGE_CACHE_H

#include "scene/packed_image.h"

typedef struct adcgs_image_cache adcgs_image_cache;

/** The limit is 0: no image is kept. */
adcgs_status adcgs_image_cache_create(adcgs_image_cache **out, adcgs_error *error);
void adcgs_image_cache_free(adcgs_image_cache **cache);
/** Sets the most bytes of images, including those of adcgs_image_cache_charge(). Images in use stay. */
void adcgs_image_cache_limit(adcgs_image_cache *cache, uint64_t bytes);
/** Images in other memory count, too, and kept ones give way to them. Negative: their memory is free again. */
void adcgs_image_cache_charge(adcgs_image_cache *cache, int64_t bytes);

/** Decodes an image into *packed, which is empty. On failure *packed is empty again, or is cleared by the caller. */
typedef adcgs_status (*adcgs_image_decode)(void *user, adcgs_packed_image *packed, adcgs_error *error);

/**
 * Takes the image of a path and a frame, which stays in memory until adcgs_image_cache_give(). If it is not kept, it is decoded,
 * and other threads that want it wait for it. *out NULL: there is no room for it; bytes is its estimated size.
 */
adcgs_status adcgs_image_cache_take(adcgs_image_cache *cache, const adcgs_packed_image **out, const char *path, int64_t frame,
                                    uint64_t bytes, adcgs_image_decode decode, void *user, adcgs_error *error);
/** image: or NULL. */
void adcgs_image_cache_give(adcgs_image_cache *cache, const adcgs_packed_image *image);

/** Counts a decoded image. */
void adcgs_image_cache_count(adcgs_image_cache *cache);
/** Images decoded so far, and bytes of those that are kept. */
void adcgs_image_cache_facts(adcgs_image_cache *cache, uint64_t *decoded, uint64_t *kept);

#endif
