/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Opens a scene of any supported layout.
 *
 * The layout is detected by the files:
 * - a folder with transforms_train.json (and _val, _test; D-NeRF), a folder with one transforms.json (nerfstudio), or such a
 *   file itself. Without files per split, every 8th frame (0, 8, 16, ...) is for testing and the others are for training. World
 *   axes, units and colours are the dataset's own.
 * - a folder with dataset.json, metadata.json and camera/ (HyperNeRF, Nerfies). World units are the layout's working
 *   coordinates, (x - center) * scale of its scene.json.
 * - a folder with poses_bounds.npy: images (LLFF) or videos of fixed cameras (Neu3D), see llff.h.
 * - a folder with a sparse model of COLMAP, see colmap.h.
 * - a folder with train_meta.json (Dynamic 3D Gaussians' Panoptic benchmark), or that file itself, see panoptic.h.
 * - a JSON file with the field adcgs_scene, see scene_file.h.
 * - a file of splats: a static scene, whose views are rendered from them, see splat_file.h.
 * - splats over time, as a file or as a folder of numbered files: a dynamic scene, the same.
 */
#ifndef ADCGS_SCENE_LAYOUTS_OPEN_H
#define ADCGS_SCENE_LAYOUTS_OPEN_H

#include "scene/layouts/footage.h"
#include "scene/scene.h"

/** Kinds of scenes; AUTO: the first kind whose files exist. */
typedef enum adcgs_dataset {
    ADCGS_DATASET_AUTO,
    ADCGS_DATASET_TRANSFORMS,
    ADCGS_DATASET_HYPERNERF,
    ADCGS_DATASET_LLFF,
    ADCGS_DATASET_COLMAP,
    ADCGS_DATASET_ADCGS,  /**< the scene file */
    ADCGS_DATASET_SPLATS, /**< splats, static or over time */
    ADCGS_DATASET_PANOPTIC,
    ADCGS_DATASETS
} adcgs_dataset;

/** "auto", "transforms", "hypernerf", "llff", "colmap", "adcgs", "splats", "panoptic", and NULL at the end. */
extern const char *const adcgs_dataset_names[ADCGS_DATASETS + 1];

/** Overrides given on a command line. Zero-initialise. */
typedef struct adcgs_scene_options {
    const char *points_path; /**< file of initial points, in world units, instead of the scene's own */
    int has_background;
    float background[3];
    adcgs_fps rate;             /**< of the selected frames; unknown: the scene's, else 30 */
    uint32_t splat_frames;      /**< frames of splats over time whose file does not state them; 0: the default */
    int is_partial;             /**< read splats over time of which a part is lost (adcgs_dynamic_options) */
    int dataset;                /**< an adcgs_dataset */
    const adcgs_footage *taken; /**< for a scene file: footage for adcgs_scene_file_read(); or NULL */
    int is_outline;             /**< read only images that determine a size; alpha and background are not determined */
    adcgs_frame_range frames; /**< selects frames of videos, or distinct times of all images; the first selected one is time 0 */
} adcgs_scene_options;

/**
 * Opens a scene folder, its JSON file of transforms, a scene file, or splats. Times in [0,1] of the layout become
 * seconds: t times the intervals between frames (frames.h), over the rate. The near plane is half the near bound. Without a
 * bound it is a hundredth of a distance: the median distance of the training cameras from the centre of their views, or
 * adcgs_scene_extent() if all cameras are in one place. No length is absolute: a scene in other units is the same scene.
 * \return ADCGS_ERR_IO if the scene does not exist; ADCGS_ERR_DATA (naming file and field) if it contradicts itself or lacks a
 * file that it lists; ADCGS_ERR_UNSUPPORTED for camera models other than the pinhole and OpenCV's
 */
adcgs_status adcgs_scene_open(adcgs_scene **out, const char *path, const adcgs_scene_options *options, adcgs_error *error);
/**
 * Checks that the images and masks of all views exist, and that those of other splits than training have the right size.
 * adcgs_scene_open() does this by itself, except for an outline.
 */
adcgs_status adcgs_scene_check_files(const adcgs_scene *scene, adcgs_error *error);

#endif
