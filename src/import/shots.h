/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What COLMAP is to be given: pictures, each of a camera, from files and videos. Nothing is decoded to list them. */
#ifndef ADCGS_IMPORT_SHOTS_H
#define ADCGS_IMPORT_SHOTS_H

#include "import/import.h"

#define ADCGS_SHOT_NAME 64

typedef enum adcgs_footage_kind { ADCGS_FOOTAGE_PICTURES, ADCGS_FOOTAGE_FILM, ADCGS_FOOTAGE_RIG } adcgs_footage_kind;

/** A camera, or what may be one. */
typedef struct adcgs_shot_camera {
    char name[ADCGS_SHOT_NAME];   /**< no two are the same */
    char folder[ADCGS_SHOT_NAME]; /**< of its pictures: those in one folder share their intrinsics */
    char *video;                /**< that it filmed; NULL: pictures */
    int64_t frames;             /**< of the video */
    adcgs_fps rate;
    char key[160];              /**< of pictures: what tells cameras apart */
    double focal;               /**< over the longer side, about; 0: not known */
    uint32_t shots;             /**< how many are of it */
} adcgs_shot_camera;

typedef struct adcgs_shot {
    uint32_t camera;
    char stem[ADCGS_SHOT_NAME]; /**< no two are the same */
    char end[8];                /**< of the file that is made: "jpg" or "png" */
    char *path;                 /**< of the picture; NULL: a frame of the camera's video */
    int64_t frame;
    double time;                /**< seconds from the first */
    int turn, width, height;    /**< as adcgs_photo_shape() is to make it; a frame's size is not known before it is decoded */
    int as_is;                  /**< the file can stay as it is */
} adcgs_shot;

typedef struct adcgs_shots {
    adcgs_footage_kind kind;
    adcgs_shot_camera *cameras;
    adcgs_shot *shots;
    uint32_t n_cameras, n;
    adcgs_fps rate;             /**< of frames that are taken; not known: pictures of one time */
    int is_numbered;            /**< names of pictures are one text with numbers that follow each other */
} adcgs_shots;

/** On failure, too, adcgs_shots_clear(). */
adcgs_status adcgs_shots_list(adcgs_shots *out, const adcgs_import_options *options, adcgs_progress *progress,
                              adcgs_error *error);
void adcgs_shots_clear(adcgs_shots *shots);
/** Its picture below a folder, "FOLDER/STEM.END", from malloc(); NULL without memory. */
char *adcgs_shot_path(const adcgs_shots *shots, const adcgs_shot *shot, const char *folder);
/** Width and height that a picture is to have, of at most so many pixels a side. */
void adcgs_shot_fit(int *width, int *height, int side);

/* ---- Shared by the files that list: shots_list.c, shots_pictures.c, shots_video.c ---- */

/** One more, zero but for its stem, which comes from a text; NULL, with a message, if there is no memory or are too many. */
adcgs_shot *adcgs_shots_add(adcgs_shots *shots, uint32_t camera, const char *stem, adcgs_error *error);
/** The same for cameras, with a name of its own. */
adcgs_shot_camera *adcgs_shots_add_camera(adcgs_shots *shots, const char *name, adcgs_error *error);
/** Of pictures; of one video: a camera that moves; of several: cameras that stand. */
adcgs_status adcgs_shots_pictures(adcgs_shots *shots, const adcgs_import_options *options, adcgs_progress *progress,
                                  adcgs_error *error);
adcgs_status adcgs_shots_film(adcgs_shots *shots, const char *path, const adcgs_import_options *options, adcgs_error *error);
adcgs_status adcgs_shots_rig(adcgs_shots *shots, const adcgs_import_options *options, adcgs_progress *progress,
                             adcgs_error *error);

#endif
