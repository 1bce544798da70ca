/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A scene to train on: posed images with timestamps, from any layout. Each reader converts its layout's conventions once:
 * cameras are OpenCV-axed pinholes in world units, times are seconds from the start of the scene.
 *
 * Views for testing and validation are only listed. All values derived from views (near plane, axes, frame of reference, first
 * anchors) follow from the training views alone. The one exception is the duration, which counts the times of all views: a
 * recording keeps its length although some frames are held out.
 *
 * Images from a lens with distortion (OpenCV's model) are undistorted when they are loaded: a view's camera is the pinhole, its
 * lens describes the recorded image. Training on the recorded rays would need a rasteriser of its own. Splats are projected by
 * the normative pinhole projection, in training as in decoding, and the distorted image of a splat is no ellipse. Resampling
 * costs a little sharpness, once. Training, measuring and decoding then use the same image.
 */
#ifndef ADCGS_SCENE_SCENE_H
#define ADCGS_SCENE_SCENE_H

#include "base/base.h"
#include "media/image/image.h"
#include "media/points/points.h"
#include "media/video/fps.h"
#include "scene/frames.h"
#include "scene/lens.h"
#include "scene/packed_image.h"

#include <adcgs/types.h>

typedef enum adcgs_split { ADCGS_SPLIT_TRAIN, ADCGS_SPLIT_VAL, ADCGS_SPLIT_TEST, ADCGS_SPLITS } adcgs_split;

/** World axes, right-handed: the codes of adcgs_stream. */
typedef enum adcgs_axes { ADCGS_AXES_UNKNOWN, ADCGS_AXES_Y_UP, ADCGS_AXES_Z_UP, ADCGS_AXES_Y_DOWN } adcgs_axes;

/**
 * From this value on, values of an image are clipped: they do not grow with the light. Values of 0 to 1; chosen by hand, not
 * measured.
 */
#define ADCGS_BURNT 0.98f

typedef struct adcgs_scene_view {
    adcgs_camera camera; /**< of the undistorted image at full size; name is the file's stem */
    double time;         /**< seconds */
    double source_time;  /**< for splats over time: seconds in their source; the same in a part of the scene */
    char *path;          /**< of the image or the video */
    char *mask;          /**< of the mask, an image that marks the pixels that count, or NULL */
    char *moving;        /**< of an image that marks moving regions: ground truth, for measuring only; or NULL */
    int is_video;
    int64_t frame;   /**< index in a video, from 0 */
    adcgs_lens lens; /**< of the recorded image; width 0: it was taken by the pinhole camera itself */
    float stops[3];  /**< gain of each channel, in stops, that loading removes (light.h) */
} adcgs_scene_view;

typedef adcgs_points adcgs_scene_points; /**< positions in world units, as given by the scene */

/** Splats that the views are rendered from; see splat_views.h. */
typedef struct adcgs_splat_scene adcgs_splat_scene;

/** Larger widths or heights of images cost training time without a visible gain. Pixels; chosen by hand, not measured. */
#define ADCGS_SIDE_MOST 1600

#define ADCGS_REMARKS_MAX 8    /* remarks of a scene; chosen by hand, not measured */
#define ADCGS_REMARK_BYTES 400 /* bytes of a remark; chosen by hand, not measured */

typedef struct adcgs_scene {
    char *directory;
    uint32_t n_views[ADCGS_SPLITS];
    adcgs_scene_view *views[ADCGS_SPLITS];
    double duration;     /**< seconds, 0 for a static scene */
    adcgs_fps rate;      /**< frames per second of the selected frames, if known */
    double intervals;    /**< between frames of the data set, from time 0 to 1 of its layout; 0: not given */
    int is_outline;      /**< nonzero: the image files have not been checked for existence */
    int counts;          /**< nonzero: image names are numbers, like those of frames, but all have the same time */
    uint32_t n_times;    /**< distinct times of the training split */
    double near_bound;   /**< least distance of visible content from training views, as given by the data set; 0: not given */
    int has_alpha;       /**< images carry alpha, composited over background */
    float background[3]; /**< default: white for images with alpha, else black */
    adcgs_scene_points points;         /**< initial points, n = 0 if the scene has none */
    uint8_t axes, units, colour_space; /**< codes of adcgs_stream */
    double origin[3], scale;           /**< the frame of reference, if given; scale 0: it follows from the training views */
    adcgs_splat_scene *splats;         /**< NULL: views are images; else path of a view is the path of the splats */
    char *sound;                       /**< file of the scene's sound, for players; NULL: none */
    double sound_begin;                /**< when it begins, seconds after the first training view */
    int measured;                      /**< factor that reduces images for measuring a stream on them; 0 or 1: full size */
    char remarks[ADCGS_REMARKS_MAX][ADCGS_REMARK_BYTES]; /**< lines to print before training */
    int n_remarks;
    struct adcgs_clips *clips;        /**< open videos (clips.h) */
    struct adcgs_image_cache *images; /**< decoded images (image_cache.h); NULL: none are kept */
    const struct adcgs_scene *whole;  /**< the whole scene if this is a part in time (part.h); else NULL */
} adcgs_scene;

void adcgs_scene_free(adcgs_scene **scene);
/** Frees the memory that a view owns. */
void adcgs_scene_view_clear(adcgs_scene_view *view);

/** Adds a remark about a scene that is usable nevertheless, with its directory in front. Long lines are truncated. */
void adcgs_scene_remark(adcgs_scene *scene, const char *format, ...) ADCGS_PRINTF(2, 3);

/** "train", "val", "test". */
const char *adcgs_split_name(adcgs_split split);
/** Returns 0, or -1 if the name is unknown. */
int adcgs_split_parse(const char *name, adcgs_split *split);

/**
 * Checks that an image file has the size of its camera or lens, and that its masks have the same aspect ratio; ADCGS_ERR_DATA if
 * not. Masks of another size are scaled by the nearest pixel when they are loaded.
 */
adcgs_status adcgs_scene_probe(const adcgs_scene_view *view, adcgs_error *error);

/**
 * Loads a view's image as planar binary32 [3][h][w]: alpha composited over scene->background, undistorted, box-filtered down by
 * the integer factor `divide` (edge boxes average the pixels that they cover; w = ceil(width/divide)).
 * Pixels where the mask is black are ignored in averages. A pixel with less than half of its area left has NaN in all channels.
 * So has a clipped pixel of an image whose light is scaled down. Comparisons of images skip such pixels (metric.h,
 * adcgs_trainer_loss()).
 * camera, if not NULL, becomes the camera at that size. The caller frees *rgb with free(). Any thread may call. For a video,
 * one thread should ask for frames in ascending order (adcgs_view_runs_make()).
 * The decoded image comes from scene->images, or is kept there if there is room, for the next call; the values are the same.
 */
adcgs_status adcgs_scene_image(const adcgs_scene *scene, const adcgs_scene_view *view, int divide, float **rgb,
                               adcgs_camera *camera, adcgs_error *error);
/**
 * Borrows a kept image instead of a copy, until adcgs_scene_give_back(). *out NULL: it has other values than the result of
 * adcgs_scene_image(), more than 16 bits, or no room.
 */
adcgs_status adcgs_scene_borrow(const adcgs_scene *scene, const adcgs_scene_view *view, int divide,
                                const adcgs_packed_image **out, adcgs_error *error);
void adcgs_scene_give_back(const adcgs_scene *scene, const adcgs_packed_image *image);
/**
 * Loads the ground truth of moving regions, for a view that has `moving`. The result has the size of the image reduced by
 * `divide`: 1 where something moves (where that file is not black), else 0. It is undistorted and reduced like the image; then
 * a pixel moves if at least half of it does. The caller frees *moving with free(). Any thread may call.
 */
adcgs_status adcgs_scene_load_moving(const adcgs_scene_view *view, int divide, uint8_t **moving, adcgs_error *error);

#endif
