/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene file that is being read, shared by the file that reads it and the one that reads its cameras. */
#ifndef ADCGS_SCENE_LAYOUTS_SCENE_READER_H
#define ADCGS_SCENE_LAYOUTS_SCENE_READER_H

#include "scene/layouts/scene_file.h"
#include "system/paths.h"

#define ADCGS_SCENE_WORLD_MAX 1e9 /**< of a coordinate, in world units; chosen by hand, not measured */

/** A scene file that is being read. */
typedef struct adcgs_scene_reader {
    adcgs_scene *scene;
    adcgs_error *error;
    const adcgs_frame_range *frames;
    const char *path;
    char *folder; /**< of the file, with its slash, or "" */
    json_t *root;
    double scale;                 /**< factor of positions */
    adcgs_fps rate;               /**< of the whole file; unknown: not given */
    const adcgs_footage *taken;   /**< footage of the next training camera; NULL: use the footage named by the file */
    int listing;                  /**< cameras are listed without reading their footage */
    adcgs_source_camera *sources; /**< the training cameras, if listing */
    uint32_t n_sources;
} adcgs_scene_reader;

/** The path of a name in the file, from malloc(). */
static inline char *adcgs_scene_resolve(const adcgs_scene_reader *r, const char *name)
{
    return adcgs_path("%s%s", *name == '/' ? "" : r->folder, name);
}

/** Reads the list of cameras (camera_list.c): their views or, for live footage, its location. */
adcgs_status adcgs_scene_cameras_read(adcgs_scene_reader *r, const adcgs_json_place *at);

#endif
