/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The input of COLMAP: images with their cameras, from files and videos. Listing them decodes nothing. */
#ifndef ADCGS_APPS_IMPORT_SOURCE_IMAGES_H
#define ADCGS_APPS_IMPORT_SOURCE_IMAGES_H

#include "apps/import/import.h"

#define ADCGS_SOURCE_IMAGE_NAME 64 /**< bytes of a name, with its zero; chosen by hand, not measured */

typedef enum adcgs_footage_kind { ADCGS_FOOTAGE_PICTURES, ADCGS_FOOTAGE_FILM, ADCGS_FOOTAGE_RIG } adcgs_footage_kind;

/** A camera, or a group of images that are assumed to be from one camera. */
typedef struct adcgs_source_image_camera {
    char name[ADCGS_SOURCE_IMAGE_NAME];   /**< unique */
    char folder[ADCGS_SOURCE_IMAGE_NAME]; /**< of its images; images in one folder share their intrinsics */
    char *video;                          /**< its footage; NULL: images */
    int64_t frames;                       /**< of the video */
    adcgs_fps rate;
    int has_sound;
    double start;    /**< of the video's first frame, by the clock of its file */
    char key[160];   /**< for images: properties that distinguish cameras */
    double focal;    /**< approximate focal length over the longer side; 0: unknown */
    uint32_t images; /**< number of its source images */
} adcgs_source_image_camera;

typedef struct adcgs_source_image {
    uint32_t camera;
    char stem[ADCGS_SOURCE_IMAGE_NAME]; /**< unique */
    char end[8];                        /**< extension of the file to make: "jpg" or "png" */
    char *path;                         /**< of the image; NULL: a frame of the camera's video */
    int64_t frame;
    double time;             /**< seconds from the first source image */
    int turn, width, height; /**< parameters for adcgs_photo_shape(); a frame's size is unknown before it is decoded */
    int as_is;               /**< the file can be copied unchanged */
} adcgs_source_image;

typedef struct adcgs_source_images {
    adcgs_footage_kind kind;
    adcgs_source_image_camera *cameras;
    adcgs_source_image *list;
    uint32_t n_cameras, n;
    adcgs_fps rate;  /**< of the selected frames; unknown: images of one time */
    const char *hdr; /**< "HLG" or "PQ" if a video has high dynamic range, which is converted; else NULL */
    int is_numbered; /**< names of images are one prefix with consecutive numbers */
} adcgs_source_images;

/** Call adcgs_source_images_clear() also on failure. */
adcgs_status adcgs_source_images_list(adcgs_source_images *out, const adcgs_import_options *options, adcgs_progress *progress,
                                      adcgs_error *error);
void adcgs_source_images_clear(adcgs_source_images *sources);
/** The path of its image below a folder, "FOLDER/STEM.END", from malloc(); NULL on allocation failure. */
char *adcgs_source_image_path(const adcgs_source_images *sources, const adcgs_source_image *source, const char *folder);
/** Reduces a width and height to at most `side` pixels each, with the same aspect ratio. */
void adcgs_source_image_fit(int *width, int *height, int side);

/* ---- Shared by the files that list: source_list.c, source_photos.c, source_video.c ---- */

/**
 * Adds a source image, zero except for its stem, which is derived from a text. NULL, with a message, on allocation failure or if
 * there are too many.
 */
adcgs_source_image *adcgs_source_images_add(adcgs_source_images *sources, uint32_t camera, const char *stem, adcgs_error *error);
/** The same for cameras, with a unique name. */
adcgs_source_image_camera *adcgs_source_images_add_camera(adcgs_source_images *sources, const char *name, adcgs_error *error);
/** Lists images; the frames of one video, as a moving camera; or those of several videos, as fixed cameras. */
adcgs_status adcgs_source_images_photos(adcgs_source_images *sources, const adcgs_import_options *options,
                                        adcgs_progress *progress, adcgs_error *error);
adcgs_status adcgs_source_images_video(adcgs_source_images *sources, const char *path, const adcgs_import_options *options,
                                       adcgs_error *error);
adcgs_status adcgs_source_images_rig(adcgs_source_images *sources, const adcgs_import_options *options, adcgs_progress *progress,
                                     adcgs_error *error);

#endif
