/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Photos from cameras: the metadata in their headers, and turning and resizing them. */
#ifndef ADCGS_MEDIA_IMAGE_PHOTO_H
#define ADCGS_MEDIA_IMAGE_PHOTO_H

#ifdef __cplusplus
extern "C" {
#endif

#include "media/image/image.h"

#define ADCGS_PHOTO_UPRIGHT 1 /**< orientation of an image that needs no turn; definition (EXIF, tag 274) */

typedef struct adcgs_photo {
    int width, height; /**< as stored */
    int turn;          /**< orientation, 1 to 8 as in EXIF; ADCGS_PHOTO_UPRIGHT if the file has none */
    double focal;      /**< approximate focal length over the longer side of the image; 0: unknown */
    char camera[96];   /**< maker, model and focal length of the lens; "" if unknown */
} adcgs_photo;

/** Fill in the fields from an image's header, except its size. A value that is not a number counts as absent. */
adcgs_status adcgs_image_tell(adcgs_photo *photo, const char *path, adcgs_error *error);
/** Read the size and the other fields from the header, without decoding pixels. */
adcgs_status adcgs_photo_probe(adcgs_photo *out, const char *path, adcgs_error *error);
/** True if turning upright swaps width and height. */
int adcgs_photo_lies(int turn);
/**
 * Turn an image upright, then resize it to width x height, by a filter that keeps reduced images sharp; *image is replaced. path
 * is for messages.
 */
adcgs_status adcgs_photo_shape(adcgs_image *image, int turn, int width, int height, const char *path, adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif
