/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Opens a scene: finds its layout, and derives values from all views together. */
#include "config.h"

#include "scene/layouts/open.h"

#include "media/dynamic/dynamic_splats.h"
#include "media/kind.h"
#include "media/splats/splats.h"
#include "media/video/video.h"
#include "scene/camera_json.h"
#include "scene/clips.h"
#include "scene/image_cache.h"
#include "scene/extent.h"
#include "scene/layouts/captures.h"
#include "scene/layouts/colmap.h"
#include "scene/layouts/hypernerf.h"
#include "media/listing.h"
#include "scene/layouts/llff.h"
#include "scene/layouts/panoptic.h"
#include "scene/layouts/scene_file.h"
#include "scene/layouts/splat_file.h"
#include "scene/layouts/transforms_splits.h"
#include "scene/pose_check.h"
#include "scene/view_mask.h"
#include "system/extension.h"
#include "system/file.h"
#include "system/paths.h"

#include <errno.h>
#include <stdlib.h>
#include <strings.h>
#include <sys/stat.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define DEFAULT_FRAME_RATE ((adcgs_fps){30, 1}) /* frames per second, of footage without a rate */
#define NEAR_PER_DISTANCE 0.01                  /* near plane over the distance of cameras from the scene */
#define DISTANCE_MIN 1e-9                       /* world units, well within a stream's range */
#define DISTANCE_MAX 1e10                       /* world units, the same */
#define FOLDERS_MOST 100                        /* limit of subfolders that are searched for a scene */
#define NEAR_PER_BOUND 0.5                      /* near plane over the near bound: bounds hold for most points, not for all */
#define COLOUR_SRGB 1                           /* a code of adcgs_stream (stream.h); definition */

const char *const adcgs_dataset_names[ADCGS_DATASETS + 1] = {"auto",  "transforms", "hypernerf", "llff", "colmap",
                                                             "adcgs", "splats",     "panoptic",  NULL};

/** Sets the duration in seconds, unless the layout gives it, and the number of distinct training times. */
static adcgs_status find_duration(adcgs_scene *scene, const char *path, int64_t step, adcgs_error *error)
{
    double intervals;
    ADCGS_TRY(adcgs_frames_intervals(scene, &scene->n_times, &intervals, path, error));
    if (scene->duration > 0.0)
        return ADCGS_OK;
    if (scene->intervals > 0.0 && scene->n_times > 1) /* the data set has step times as many intervals as the selected frames */
        intervals = scene->intervals / (double)step;
    scene->duration = intervals * (double)scene->rate.den / (double)scene->rate.num;
    return ADCGS_OK;
}

/* Views of other splits than training are read last: it is better to report errors now than after training. */
adcgs_status adcgs_scene_check_files(const adcgs_scene *scene, adcgs_error *error)
{
    for (int s = 0; s < ADCGS_SPLITS && !scene->splats; s++)
        for (uint32_t i = 0; i < scene->n_views[s]; i++) {
            const adcgs_scene_view *view = &scene->views[s][i];
            if (view->mask)
                ADCGS_TRY(adcgs_file_check(view->mask, "an image", error));
            if (view->is_video)
                continue;
            ADCGS_TRY(adcgs_file_check(view->path, "an image", error));
            if (view->moving)
                ADCGS_TRY(adcgs_file_check(view->moving, "an image", error));
            if (s != ADCGS_SPLIT_TRAIN)
                ADCGS_TRY(adcgs_scene_probe(view, error));
        }
    return scene->splats ? ADCGS_OK : adcgs_scene_check_masks(scene, error);
}

/** Near planes are relative to the scene, whose units are unknown. Cameras in one place use the scene's extent as distance. */
static adcgs_status set_near_planes(adcgs_scene *scene, const char *path, adcgs_error *error)
{
    double extent, median;
    ADCGS_TRY(adcgs_scene_extent(scene, &extent, error));
    ADCGS_TRY(adcgs_pose_median_distance(scene->views[ADCGS_SPLIT_TRAIN], scene->n_views[ADCGS_SPLIT_TRAIN], &median, error));
    const double distance = median > ADCGS_EXTENT_NOTHING * extent ? median : extent;
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t i = 0; i < scene->n_views[s]; i++)
            scene->views[s][i].camera.near_plane =
                scene->near_bound > 0.0 ? NEAR_PER_BOUND * scene->near_bound : NEAR_PER_DISTANCE * distance;
    if (!(distance >= DISTANCE_MIN && distance <= DISTANCE_MAX))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: cameras see the scene from a distance of %g units, expected %g to %g", path,
                          distance, DISTANCE_MIN, DISTANCE_MAX);
    return ADCGS_OK;
}

/** Sets values that depend on all views together: seconds, alpha, background. */
static adcgs_status finish_views(adcgs_scene *scene, const char *path, const adcgs_scene_options *options, adcgs_error *error)
{
    if (!options->is_outline)
        ADCGS_TRY(adcgs_scene_check_files(scene, error));
    ADCGS_TRY(find_duration(scene, path, adcgs_frames_step(&options->frames), error));
    const adcgs_scene_view *train = scene->views[ADCGS_SPLIT_TRAIN];
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t i = 0; i < scene->n_views[s]; i++)
            scene->views[s][i].time *= scene->duration;
    int width, height, channels = 3;
    if (!scene->splats && !options->is_outline && !train[0].is_video)
        ADCGS_TRY(adcgs_image_probe(&width, &height, &channels, train[0].path, error));
    scene->has_alpha = channels % 2 == 0;
    for (int c = 0; c < 3; c++)
        scene->background[c] = options->has_background ? options->background[c] : scene->has_alpha ? 1.0f : 0.0f;
    return ADCGS_OK;
}

/** True if scene.json exists and is an adcgs scene file. */
static int has_scene_file(const char *folder)
{
    adcgs_error unused;
    json_t *root = NULL;
    char *path = adcgs_path("%s/scene.json", folder);
    const int is_ours =
        adcgs_is_there(path) && adcgs_json_load(&root, path, &unused) == ADCGS_OK && json_object_get(root, "adcgs_scene") != NULL;
    json_decref(root);
    free(path);
    return is_ours;
}

/** Detects the folder's layout by its files; ADCGS_DATASET_AUTO: no known layout. */
static adcgs_dataset find_dataset(const char *folder)
{
    return adcgs_is_transforms(folder)  ? ADCGS_DATASET_TRANSFORMS
           : adcgs_is_panoptic(folder)  ? ADCGS_DATASET_PANOPTIC
           : adcgs_is_hypernerf(folder) ? ADCGS_DATASET_HYPERNERF
           : adcgs_is_llff(folder)      ? ADCGS_DATASET_LLFF
           : adcgs_is_colmap(folder)    ? ADCGS_DATASET_COLMAP
           : has_scene_file(folder)     ? ADCGS_DATASET_ADCGS
                                        : ADCGS_DATASET_AUTO;
}

/** Reads a scene file from its folder. */
static adcgs_status read_scene_json(adcgs_scene *scene, const adcgs_scene_options *options, adcgs_error *error)
{
    if (!adcgs_is_there_at("%s/scene.json", scene->directory))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: a folder, expected a scene file, or scene.json in it", scene->directory);
    char *path = adcgs_path("%s/scene.json", scene->directory);
    const adcgs_status status =
        path ? adcgs_scene_file_read(scene, path, &options->frames, !options->points_path, options->taken, error)
             : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", scene->directory);
    free(path);
    return status;
}

#define HINT "; adcgs-import makes one from footage"

static int is_footage(const char *name)
{
    return adcgs_is_image_name(name) || adcgs_is_video(name);
}

/** True for a folder with images or videos. */
static int has_footage(const char *folder)
{
    adcgs_listing listing;
    adcgs_error unused;
    if (adcgs_listing_read(&listing, folder, is_footage, &unused) != ADCGS_OK)
        return 0;
    const int found = listing.n > 0;
    adcgs_listing_free(&listing);
    return found;
}

static int is_splats(const char *name)
{
    static const char *const ends[] = {"ply", "spz", "glb", "splat", "ksplat", "sog", "splatv"};
    const char *const end = adcgs_extension(name);
    for (size_t i = 0; i < ADCGS_COUNTOF(ends); i++)
        if (!strcasecmp(end, ends[i]))
            return 1;
    return 0;
}

/** Refuses a folder without cameras that contains files of splats without numbers. */
static adcgs_status refuse_sequence(const char *folder, adcgs_error *error)
{
    adcgs_listing listing;
    adcgs_error unused;
    adcgs_status status = ADCGS_OK;
    if (adcgs_listing_read(&listing, folder, is_splats, &unused) != ADCGS_OK)
        return ADCGS_OK;
    const int is_cloud = listing.n == 1 && !strcmp(listing.names[0], "points3d.ply"); /* of a scene without its cameras */
    char *const path = listing.n && !is_cloud ? adcgs_path("%s/%s", folder, listing.names[0]) : NULL;
    if (path && adcgs_kind_at(path)->class == ADCGS_KIND_SPLATS)
        status =
            adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: a folder of %zu files of splats (%.60s): %s", folder, listing.n,
                       listing.names[0],
                       listing.n > 1 ? "for a sequence name them by numbers (frame0.ply, frame1.ply, ...), or give one of them"
                                     : "give the file itself");
    free(path);
    adcgs_listing_free(&listing);
    return status;
}

/** Refuses a folder with a scene in a subfolder, as in unpacked archives and COLMAP's dense workspaces, and names it. */
static adcgs_status refuse_above(const char *folder, adcgs_error *error)
{
    adcgs_listing listing;
    adcgs_error unused;
    adcgs_status status = ADCGS_OK;
    if (adcgs_listing_read(&listing, folder, adcgs_is_visible_name, &unused) != ADCGS_OK)
        return ADCGS_OK;
    for (size_t i = 0; status == ADCGS_OK && i < listing.n && i < FOLDERS_MOST; i++) {
        char *const below = adcgs_path("%s/%s", folder, listing.names[i]);
        if (below && adcgs_is_folder(below) && find_dataset(below) != ADCGS_DATASET_AUTO)
            status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: not a scene, but its folder %.100s is one: give that folder", folder,
                                listing.names[i]);
        free(below);
    }
    adcgs_listing_free(&listing);
    return status;
}

static adcgs_status read_splats(adcgs_scene *scene, const char *path, const adcgs_scene_options *options, adcgs_error *error)
{
    const adcgs_dynamic_options clock = {options->rate, options->splat_frames, options->is_partial};
    ADCGS_TRY(adcgs_splat_scene_read(scene, !options->points_path, &clock, path, error));
    return adcgs_frames_keep(scene, &options->frames, path, error);
}

static adcgs_status bare(const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: not a scene: it has no camera poses" HINT, path);
}

static adcgs_status read_folder(adcgs_scene *scene, char **points_path, const adcgs_scene_options *options, adcgs_error *error)
{
    const int with_points = !options->points_path;
    switch (options->dataset ? options->dataset : (int)find_dataset(scene->directory)) {
    case ADCGS_DATASET_TRANSFORMS:
        ADCGS_TRY(adcgs_transforms_read_folder(scene, points_path, error));
        break;
    case ADCGS_DATASET_HYPERNERF:
        ADCGS_TRY(adcgs_hypernerf_read(scene, with_points, error));
        break;
    case ADCGS_DATASET_PANOPTIC:
        ADCGS_TRY(adcgs_panoptic_read(scene, with_points, error));
        break;
    case ADCGS_DATASET_LLFF:
        return adcgs_llff_read(scene, &options->frames, with_points, error);
    case ADCGS_DATASET_COLMAP:
        return adcgs_colmap_read(scene, &options->frames, with_points, error);
    case ADCGS_DATASET_ADCGS:
        return read_scene_json(scene, options, error);
    case ADCGS_DATASET_SPLATS:
        return read_splats(scene, scene->directory, options, error);
    default:
        if (adcgs_dynamic_is(scene->directory))
            return read_splats(scene, scene->directory, options, error);
        ADCGS_TRY(adcgs_capture_refuse_folder(scene->directory, error));
        ADCGS_TRY(refuse_sequence(scene->directory, error));
        ADCGS_TRY(refuse_above(scene->directory, error));
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%s: not a scene: neither transforms_train.json, nor transforms.json, nor train_meta.json, nor "
                          "dataset.json with metadata.json and camera/, nor poses_bounds.npy, nor a COLMAP model%s",
                          scene->directory, has_footage(scene->directory) ? HINT : " in sparse/0, sparse or here");
    }
    return adcgs_frames_keep(scene, &options->frames, scene->directory, error);
}

/** Reads the folder of train_meta.json, given the file itself. */
static adcgs_status read_meta(adcgs_scene *scene, const char *path, const adcgs_scene_options *options, adcgs_error *error)
{
    const char *slash = strrchr(path, '/');
    if (strcmp(slash ? slash + 1 : path, "train_meta.json"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: cameras of Dynamic 3D Gaussians, expected train_meta.json, or its folder",
                          path);
    ADCGS_TRY(adcgs_panoptic_read(scene, !options->points_path, error));
    return adcgs_frames_keep(scene, &options->frames, path, error);
}

/** Reads a file: splats by their first bytes, a scene file by its field adcgs_scene, other JSON as a file of transforms. */
static adcgs_status read_file(adcgs_scene *scene, const char *path, char **points_path, const adcgs_scene_options *options,
                              adcgs_error *error)
{
    json_t *root;
    int is_scene_file = options->dataset == ADCGS_DATASET_ADCGS;
    if (options->dataset == ADCGS_DATASET_SPLATS ||
        (options->dataset == ADCGS_DATASET_AUTO && (adcgs_splats_is(path) || adcgs_dynamic_is(path))))
        return read_splats(scene, path, options, error);
    if (options->dataset == ADCGS_DATASET_AUTO && is_footage(path))
        return bare(path, error);
    ADCGS_TRY(adcgs_kind_check(path, ADCGS_WANT_SCENE, error));
    if (options->dataset == ADCGS_DATASET_AUTO) {
        ADCGS_TRY(adcgs_json_load(&root, path, error));
        is_scene_file = json_object_get(root, "adcgs_scene") != NULL;
        const int is_panoptic = json_object_get(root, "fn") && json_object_get(root, "w2c") && json_object_get(root, "k");
        const adcgs_status status = adcgs_capture_refuse(root, path, error);
        json_decref(root);
        ADCGS_TRY(status);
        if (is_panoptic)
            return read_meta(scene, path, options, error);
    } else if (!is_scene_file && options->dataset != ADCGS_DATASET_TRANSFORMS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: a file, expected the folder of a scene of the kind %s", path,
                          adcgs_dataset_names[options->dataset]);
    if (is_scene_file)
        return adcgs_scene_file_read(scene, path, &options->frames, !options->points_path, options->taken, error);
    ADCGS_TRY(adcgs_transforms_read_single(scene, path, points_path, error));
    return adcgs_frames_keep(scene, &options->frames, path, error);
}

static adcgs_status read_points(adcgs_scene *scene, const char *listed, const adcgs_scene_options *options, adcgs_error *error)
{
    if (options->points_path)
        return adcgs_points_read(&scene->points, options->points_path, error);
    if (listed)
        return adcgs_points_read(&scene->points, listed, error);
    if (!adcgs_is_there_at("%s/points3d.ply", scene->directory))
        return ADCGS_OK;
    char *customary = adcgs_path("%s/points3d.ply", scene->directory);
    const adcgs_status status = customary ? adcgs_points_read(&scene->points, customary, error)
                                          : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", scene->directory);
    free(customary);
    return status;
}

/** Returns path without slashes at its end, or for a file its folder. */
static char *folder_of(const char *path, int is_folder)
{
    char *folder = strdup(path);
    if (!folder)
        return NULL;
    size_t n = strlen(folder);
    if (is_folder) {
        while (n > 1 && folder[n - 1] == '/')
            folder[--n] = 0;
        return folder;
    }
    char *slash = strrchr(folder, '/');
    if (slash)
        slash[slash == folder] = 0;
    else
        strcpy(folder, "."); /* a name is at least one character long */
    return folder;
}

static adcgs_status fill(adcgs_scene *scene, const char *path, int is_folder, const adcgs_scene_options *options,
                         adcgs_error *error)
{
    char *points_path = NULL;
    scene->axes = ADCGS_AXES_Z_UP; /* convention of the transforms layouts */
    scene->colour_space = COLOUR_SRGB;
    scene->is_outline = options->is_outline;
    scene->rate = options->rate;
    adcgs_status status =
        is_folder ? read_folder(scene, &points_path, options, error) : read_file(scene, path, &points_path, options, error);
    if (!scene->rate.den)
        scene->rate = DEFAULT_FRAME_RATE;
    if (!options->rate.den)
        scene->rate = adcgs_fps_divide(scene->rate, adcgs_frames_step(&options->frames));
    if (status == ADCGS_OK)
        status = finish_views(scene, path, options, error);
    if (status == ADCGS_OK && !scene->points.position) /* the layout may have set its own points */
        status = read_points(scene, points_path, options, error);
    if (status == ADCGS_OK)
        status = set_near_planes(scene, path, error);
    free(points_path);
    return status;
}

adcgs_status adcgs_scene_open(adcgs_scene **out, const char *path, const adcgs_scene_options *options, adcgs_error *error)
{
    static const adcgs_scene_options defaults;
    struct stat status;
    *out = NULL;
    if (!*path || stat(path, &status))
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open the scene: %s", path, strerror(errno));
    if (S_ISREG(status.st_mode) && !status.st_size)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: empty, expected a scene", path);
    adcgs_scene *scene = calloc(1, sizeof *scene);
    if (!scene)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    scene->directory = folder_of(path, S_ISDIR(status.st_mode));
    adcgs_status result = scene->directory ? adcgs_clips_create(&scene->clips, error)
                                           : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (result == ADCGS_OK)
        result = adcgs_image_cache_create(&scene->images, error);
    if (result == ADCGS_OK)
        result = fill(scene, path, S_ISDIR(status.st_mode), options ? options : &defaults, error);
    if (result != ADCGS_OK)
        adcgs_scene_free(&scene);
    *out = scene;
    return result;
}
