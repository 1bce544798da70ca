/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A sparse model of COLMAP in memory, and the functions that its binary and text readers share. */
#ifndef ADCGS_SCENE_LAYOUTS_COLMAP_MODEL_H
#define ADCGS_SCENE_LAYOUTS_COLMAP_MODEL_H

#include "media/points/points.h"
#include "scene/layouts/colmap_angles.h"
#include "scene/lens.h"

#define ADCGS_COLMAP_PARAMS_MAX 12 /**< numbers of a lens, at most: those of FULL_OPENCV, by definition of COLMAP */

typedef struct adcgs_colmap_camera {
    uint32_t id;
    adcgs_lens lens;
} adcgs_colmap_camera;

typedef struct adcgs_colmap_image {
    uint32_t id, camera_id;
    double cam_to_world[12]; /**< OpenCV axes */
    char *name;              /**< may contain folders; never absolute or above the folder */
} adcgs_colmap_image;

typedef struct adcgs_colmap {
    adcgs_colmap_camera *cameras; /**< in the order of the file, then sorted by id */
    adcgs_colmap_image *images;   /**< in the order of the file, then sorted by name */
    size_t n_cameras, n_images;
    adcgs_points points;
    uint64_t tracked, seen; /**< points with a track, and images in all tracks together */
    double deviation;       /**< sum of the mean reprojection errors of these points, in pixels */
    uint32_t *training;     /**< ids of the training images, ascending; NULL: unknown */
    size_t n_training;
    adcgs_colmap_angles *angles; /**< receives the angles of points during reading; NULL: not wanted */
    /* Position of the reader, for messages. */
    const char *path, *unit; /**< unit: "line", or the kind of element ("camera") */
    uint64_t index;
    adcgs_error *error;
} adcgs_colmap;

void adcgs_colmap_clear(adcgs_colmap *model);
/** Like adcgs_fail(), with file and position in front of the message. */
adcgs_status adcgs_colmap_bad(const adcgs_colmap *model, adcgs_status status, const char *format, ...) ADCGS_PRINTF(3, 4);

/** Finds a kind of camera by its name, or by its number in binary files. Returns the index of its row, -1 if there is none. */
int adcgs_colmap_kind(const char *name, int64_t number);
/** Sets *n to the number of parameters. ADCGS_ERR_UNSUPPORTED, naming the kind, if it is no pinhole with an OpenCV model. */
adcgs_status adcgs_colmap_params(const adcgs_colmap *model, int kind, int *n);

/* These functions check and append one element. Names are copied. */
adcgs_status adcgs_colmap_add_camera(adcgs_colmap *model, uint32_t id, int kind, uint64_t width, uint64_t height,
                                     const double *params);
/** q: w, x, y, z of the rotation, world to camera; t: translation. */
adcgs_status adcgs_colmap_add_image(adcgs_colmap *model, uint32_t id, const double q[4], const double t[3], uint32_t camera_id,
                                    const char *name);
/** The track of a point. */
typedef struct adcgs_colmap_track {
    double deviation;        /**< mean reprojection error in pixels */
    uint64_t seen, training; /**< images, and the number of training images among them */
} adcgs_colmap_track;

/** Adds an image to the track of a point. */
void adcgs_colmap_add_seen(const adcgs_colmap *model, const double position[3], uint32_t image, adcgs_colmap_track *track);
/** Leaves out a point seen by fewer than two training images, if tracks are known. There must be room for the point. */
adcgs_status adcgs_colmap_add_point(adcgs_colmap *model, const double position[3], const uint64_t colour[3],
                                    const adcgs_colmap_track *track);
/**
 * Lists the training images: of the model's sorted images, all except every period-th by name, beginning with the first.
 * Without images there are n of them, with ids from 1 in the order of their names, as COLMAP assigns them.
 */
adcgs_status adcgs_colmap_list_training(adcgs_colmap *model, size_t n, size_t period);
int adcgs_colmap_is_training(const adcgs_colmap *model, uint32_t image);

/** Sorts the elements, and finds those listed twice. */
adcgs_status adcgs_colmap_sort_cameras(adcgs_colmap *model);
adcgs_status adcgs_colmap_sort_images(adcgs_colmap *model);
/** Returns NULL if there is none; cameras must be sorted. */
const adcgs_colmap_camera *adcgs_colmap_find_camera(const adcgs_colmap *model, uint32_t id);

/** A reader of one file's bytes, followed by a zero byte. Text is modified. */
typedef adcgs_status adcgs_colmap_parse(adcgs_colmap *model, uint8_t *data, size_t bytes);
adcgs_colmap_parse adcgs_colmap_binary_cameras, adcgs_colmap_binary_images, adcgs_colmap_binary_points;
adcgs_colmap_parse adcgs_colmap_text_cameras, adcgs_colmap_text_images, adcgs_colmap_text_points;

#endif
