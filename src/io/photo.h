/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pictures as a camera leaves them: what they say of how they were taken, and making them upright and smaller. */
#ifndef ADCGS_IO_PHOTO_H
#define ADCGS_IO_PHOTO_H

#ifdef __cplusplus
extern "C" {
#endif

#include "io/image.h"

#define ADCGS_PHOTO_UPRIGHT 1

typedef struct adcgs_photo {
    int width, height; /**< as stored */
    int turn;          /**< how it is to be turned, 1 to 8 as in EXIF; ADCGS_PHOTO_UPRIGHT where it says nothing */
    double focal;      /**< focal length over the longer side of the picture, about; 0: not known */
    char camera[96];   /**< maker, model and focal length of the lens, "" where they are not known */
} adcgs_photo;

/** Fill in the fields that an image's header has in addition to its size. A value that is no number counts as absent. */
adcgs_status adcgs_image_tell(adcgs_photo *photo, const char *path, adcgs_error *error);
/** What its header says, without decoding pixels. */
adcgs_status adcgs_photo_probe(adcgs_photo *out, const char *path, adcgs_error *error);
/** Whether width and height change places. */
int adcgs_photo_lies(int turn);
/**
 * Turn an image upright, then make it width x height, by a filter that keeps what is smaller sharp; *image is replaced. path is
 * for messages.
 */
adcgs_status adcgs_photo_shape(adcgs_image *image, int turn, int width, int height, const char *path, adcgs_error *error);

#ifdef __cplusplus
}
#endif
#endif
