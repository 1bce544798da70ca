/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A scene to learn from: posed images with times, whatever layout they came
 * in. Conventions are converted here, once: cameras are OpenCV-axed pinholes in
 * world units, times are seconds from the start of the scene.
 *
 * Views for testing and validation are only listed: what follows from all views together (near plane, axes, the frame of
 * reference, the first anchors) follows from the views for training alone. Only when they were taken counts, for how long the
 * scene is: a recording is as long as it was before some of its frames were put aside.
 *
 * Pictures taken through a lens that bends (OpenCV's model) are straightened when they are loaded: a view's camera is the
 * pinhole, its lens says how the picture was taken. Training on the rays as given would need a rasteriser of its own:
 * splats are projected by the pinhole's normative projection, in training as in decoding, and the bent image of a splat
 * is no ellipse. Resampling costs a little sharpness, once; training, measuring and decoding then speak of one picture.
 */
#ifndef ADCGS_DATA_SCENE_H
#define ADCGS_DATA_SCENE_H

#include "base/base.h"
#include "data/frames.h"
#include "data/lens.h"
#include "io/fps.h"
#include "io/image.h"
#include "io/points.h"

#include <adcgs/types.h>

typedef enum adcgs_split { ADCGS_SPLIT_TRAIN, ADCGS_SPLIT_VAL, ADCGS_SPLIT_TEST, ADCGS_SPLITS } adcgs_split;

/** World axes, right-handed: the codes of adcgs_stream. */
typedef enum adcgs_axes { ADCGS_AXES_UNKNOWN, ADCGS_AXES_Y_UP, ADCGS_AXES_Z_UP, ADCGS_AXES_Y_DOWN } adcgs_axes;

/** Values of a picture from here on do not grow with the light. */
#define ADCGS_BURNT 0.98f

typedef struct adcgs_scene_view {
    adcgs_camera camera;  /**< at the image's own size, straightened; name is the file's stem */
    double time;          /**< seconds */
    char *path;           /**< of the image or the video */
    char *mask;           /**< of the image that says where the picture counts, or NULL */
    char *moving;         /**< of the image that says where something moves, known truth for measuring alone, or NULL */
    int is_video;
    int64_t frame;        /**< of a video, from 0 */
    adcgs_lens lens;      /**< the picture as it was taken; width 0: by the camera itself */
    float stops[3];       /**< by which its channels are taken back when it is loaded (light.h) */
} adcgs_scene_view;

typedef adcgs_points adcgs_scene_points; /**< positions in world units; as the scene gives them */

/** Splats that views are renderings of; see splat_views.h. */
typedef struct adcgs_splat_scene adcgs_splat_scene;

/** Pictures that are wider or higher cost training more than they show. */
#define ADCGS_SIDE_MOST 1600

#define ADCGS_REMARKS_MAX 8
#define ADCGS_REMARK_BYTES 400

typedef struct adcgs_scene {
    char *directory;
    uint32_t n_views[ADCGS_SPLITS];
    adcgs_scene_view *views[ADCGS_SPLITS];
    double duration;      /**< seconds, 0 for a still scene */
    adcgs_fps rate;       /**< frames per second of what is kept, known */
    double intervals;     /**< between frames of the data set, from time 0 to 1 of its layout; 0: it does not say */
    int is_outline;       /**< nobody has asked whether all pictures are there */
    int counts;           /**< names of its pictures only count, as those of frames do, but all are of one time */
    uint32_t n_times;     /**< distinct times of the training split */
    double near_bound;    /**< nothing that training views show is nearer, by what the data set says; 0: it does not say */
    int has_alpha;        /**< images carry alpha, composited over background */
    float background[3];  /**< white for images with alpha, else black, unless given */
    adcgs_scene_points points; /**< initial points, n = 0 if the scene has none */
    uint8_t axes, units, colour_space; /**< codes of adcgs_stream */
    double origin[3], scale; /**< the frame of reference, where it is given; scale 0: it follows from the views for training */
    adcgs_splat_scene *splats; /**< NULL: views are pictures; else path of a view is that of the splats */
    int measured;         /**< pictures are reduced by this when a stream is measured on them; 0 or 1: as they are */
    char remarks[ADCGS_REMARKS_MAX][ADCGS_REMARK_BYTES]; /**< lines to read before it is learned */
    int n_remarks;
    struct adcgs_clips *clips; /**< videos that are open (clips.h) */
    const struct adcgs_scene *whole; /**< of which this is a part in time (part.h); NULL: it is whole */
} adcgs_scene;

void adcgs_scene_free(adcgs_scene **scene);
/** What a view has allocated. */
void adcgs_scene_view_clear(adcgs_scene_view *view);

/** Add a line about the scene, which is read nevertheless, after its directory. Long lines are cut off. */
void adcgs_scene_remark(adcgs_scene *scene, const char *format, ...) ADCGS_PRINTF(2, 3);

/** "train", "val", "test". */
const char *adcgs_split_name(adcgs_split split);
/** 0, or -1 if unknown. */
int adcgs_split_parse(const char *name, adcgs_split *split);

/** The files of a picture and its masks have the size that its camera, or its lens, says; ADCGS_ERR_DATA if not. */
adcgs_status adcgs_scene_probe(const adcgs_scene_view *view, adcgs_error *error);

/**
 * Load a view's picture as planar binary32 [3][h][w], alpha composited over scene->background, straightened, box-filtered down
 * by the integer factor `divide` (edge boxes average what they cover; w = ceil(width/divide)). Where its mask is black, pixels
 * are not seen: only others are averaged, and a pixel of which less than half is left has NaN in all channels, as has one that is
 * burnt out in a picture whose light is taken back. Who compares
 * pictures leaves such pixels out (metric.h, adcgs_trainer_loss()). camera, if not NULL, gets the camera at that size. The caller
 * frees *rgb with free(). Any thread may call; frames of a video are best asked for in ascending order by one thread
 * (adcgs_view_runs_make()).
 */
adcgs_status adcgs_scene_load(const adcgs_scene *scene, const adcgs_scene_view *view, int divide, float **rgb,
                              adcgs_camera *camera, adcgs_error *error);
/**
 * Load what is known of a view that has `moving`: of the size of its picture reduced by `divide`, 1 where something moves, which
 * is where that image is not black, else 0. It is straightened and reduced as the picture is, and then moves where most of a
 * pixel does. The caller frees *moving with free(). Any thread may call.
 */
adcgs_status adcgs_scene_load_moving(const adcgs_scene_view *view, int divide, uint8_t **moving, adcgs_error *error);

#endif
