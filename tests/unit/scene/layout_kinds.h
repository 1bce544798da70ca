/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The rig of layout_files.h as a whole scene of every kind, and the files of its test views. */
#ifndef ADCGS_TESTS_LAYOUT_KINDS_H
#define ADCGS_TESTS_LAYOUT_KINDS_H

#include "layout_files.h"

enum { CAMERAS = 9, MOMENTS = 4 };

/** A kind of scene, and the files of its test views: images or videos by number. */
typedef struct layout {
    const char *name;
    const char *scene;     /**< below the folder; "": the folder itself */
    const char *tests;     /**< files of the test views, by a number; NULL: none */
    int first, last, step; /**< the numbers */
    int period;            /**< cameras 0, period, 2 * period, ... are for testing; 0: none of the rig's */
    void (*put)(void);
    int videos;
} layout;

static inline void put_pictures(const char *format, int n)
{
    for (int i = 0; i < n; i++) {
        char name[64];
        snprintf(name, sizeof name, format, i);
        put_picture(name, i, RIG_WIDTH, RIG_HEIGHT);
    }
}

static inline void put_frames(const char *format)
{
    for (int c = 0; c < CAMERAS; c++) {
        char name[64];
        snprintf(name, sizeof name, format, c);
        *strrchr(name, '/') = 0;
        put_folder(name);
        for (int i = 0; i < MOMENTS; i++) {
            char file[64];
            snprintf(file, sizeof file, format, c);
            snprintf(file + strlen(file), sizeof file - strlen(file), "%04d.ppm", i);
            put_picture(file, c * MOMENTS + i, RIG_WIDTH, RIG_HEIGHT);
        }
    }
}

/** One file of transforms for every step-th camera from the first. */
static inline void put_transforms(const char *name, int first, int step)
{
    char *text = malloc(65536);
    assert_non_null(text);
    size_t at = (size_t)sprintf(text, "{\"fl_x\":20,\"w\":24,\"h\":16,\"frames\":[");
    for (int i = first; i < CAMERAS; i += step) {
        double pose[12];
        rig_pose(i, pose);
        at += (size_t)sprintf(text + at, "%s{\"file_path\":\"%d.ppm\",\"time\":%g,\"transform_matrix\":%s}", i > first ? "," : "",
                              i, i / 8.0, json_opengl(pose));
    }
    sprintf(text + at, "]}");
    put_text(name, text);
    free(text);
}

static inline void put_dnerf(void)
{
    put_pictures("%d.ppm", CAMERAS);
    put_transforms("transforms_train.json", 1, 2);
    put_transforms("transforms_test.json", 0, 8);
}

static inline void put_nerfstudio(void)
{
    put_pictures("%d.ppm", CAMERAS);
    put_transforms("transforms.json", 0, 1);
}

static inline void put_hypernerf(void)
{
    char ids[256] = "", times[256] = "", name[64], text[512];
    put_folder("rgb");
    put_folder("rgb/1x");
    put_folder("camera");
    put_pictures("rgb/1x/%d.ppm", CAMERAS);
    for (int i = 0; i < CAMERAS; i++) {
        double p[12];
        rig_pose(i, p);
        if (i % 8)
            sprintf(ids + strlen(ids), "%s\"%d\"", i > 1 ? "," : "", i);
        sprintf(times + strlen(times), "%s\"%d\":{\"warp_id\":%d}", i ? "," : "", i, i);
        snprintf(name, sizeof name, "camera/%d.json", i);
        snprintf(text, sizeof text,
                 "{\"orientation\":[[%.17g,%.17g,%.17g],[%.17g,%.17g,%.17g],[%.17g,%.17g,%.17g]],"
                 "\"position\":[%.17g,%.17g,%.17g],\"focal_length\":20,\"principal_point\":[12,8],\"image_size\":[24,16]}",
                 p[0], p[4], p[8], p[1], p[5], p[9], p[2], p[6], p[10], p[3], p[7], p[11]);
        put_text(name, text);
    }
    snprintf(text, sizeof text, "{\"ids\":[],\"train_ids\":[%s],\"val_ids\":[\"0\",\"8\"]}", ids);
    put_text("dataset.json", text);
    snprintf(text, sizeof text, "{%s}", times);
    put_text("metadata.json", text);
    put_text("scene.json", "{\"center\":[0,0,0],\"scale\":1}");
}

static inline void put_llff(void)
{
    put_folder("images");
    put_pictures("images/%d.ppm", CAMERAS);
    put_poses(CAMERAS, 4);
}

static inline void put_neu3d(void)
{
    for (int c = 0; c < CAMERAS; c++) {
        char name[64];
        snprintf(name, sizeof name, "cam%02d", c);
        put_folder(name);
    }
    put_frames("cam%02d/images/");
    put_poses(CAMERAS, 2);
}

static inline void put_videos(const char *format)
{
    for (int c = 0; c < CAMERAS; c++) {
        char name[64];
        snprintf(name, sizeof name, format, c);
        put_video(name, c, MOMENTS, RIG_WIDTH, RIG_HEIGHT);
    }
}

static inline void put_neu3d_videos(void)
{
    put_videos("cam%02d.mp4");
    put_poses(CAMERAS, 1);
}

static inline void put_colmap(void)
{
    put_folder("sparse");
    put_folder("sparse/0");
    put_folder("images");
    put_pictures("images/%d.ppm", CAMERAS);
    put_model_binary("sparse/0", CAMERAS, "%d.ppm");
}

static inline void put_colmap_videos(void)
{
    put_folder("sparse");
    put_folder("videos");
    put_videos("videos/%d.mp4");
    put_model_text("sparse", CAMERAS, "%d.ppm", "7 PINHOLE 24 16 20 20 12 8\n");
}

static inline void put_scene_file(void)
{
    put_frames("cam%d/");
    char *text = malloc(65536);
    assert_non_null(text);
    size_t at = (size_t)sprintf(text, "{\"adcgs_scene\":1,\"defaults\":{\"width\":24,\"height\":16,\"fx\":20},\"cameras\":[");
    for (int i = 0; i < CAMERAS; i++) {
        double pose[12];
        rig_pose(i, pose);
        at += (size_t)sprintf(text + at,
                              "%s{\"name\":\"%d\",\"camera_to_world\":%s,\"images\":\"cam%d/%%04d.ppm\","
                              "\"split\":\"%s\"}",
                              i ? "," : "", i, json_matrix(pose), i, i ? "train" : "test");
    }
    sprintf(text + at, "]}");
    put_text("scene.json", text);
    free(text);
}

static inline void put_colmap_text(void)
{
    put_folder("sparse");
    put_folder("images");
    put_pictures("images/%d.ppm", CAMERAS);
    put_model_text("sparse", CAMERAS, "%d.ppm", "7 PINHOLE 24 16 20 20 12 8\n");
}

static inline void put_splats_file(void)
{
    char *text = malloc(65536);
    assert_non_null(text);
    size_t at = (size_t)sprintf(text, "ply\nformat ascii 1.0\nelement vertex 125\n");
    static const char *const names[] = {"x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                                        "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++)
        at += (size_t)sprintf(text + at, "property float %s\n", names[i]);
    at += (size_t)sprintf(text + at, "end_header\n");
    for (int i = 0; i < 125; i++)
        at += (size_t)sprintf(text + at, "%g %g %g %g 0 0.5 2 -2 -2.5 -3 1 0 0 0\n", 0.5 * (i % 5), 0.5 * (i / 5 % 5),
                              0.5 * (i / 25), 0.1 * (i % 7));
    put_text("splats.ply", text);
    free(text);
}

enum { DNERF, NERFSTUDIO, HYPERNERF, LLFF, NEU3D, NEU3D_VIDEOS, COLMAP, COLMAP_TEXT, COLMAP_VIDEOS, SCENE_FILE, SPLATS, LAYOUTS };

static const layout layouts[LAYOUTS] = {
    [DNERF] = {"dnerf", "", "%d.ppm", 0, 8, 8, 8, put_dnerf, 0},
    [NERFSTUDIO] = {"nerfstudio", "", "%d.ppm", 0, 8, 8, 8, put_nerfstudio, 0},
    [HYPERNERF] = {"hypernerf", "", "rgb/1x/%d.ppm", 0, 8, 8, 8, put_hypernerf, 0},
    [LLFF] = {"llff", "", "images/%d.ppm", 0, 8, 8, 8, put_llff, 0},
    [NEU3D] = {"neu3d", "", "cam00/images/%04d.ppm", 0, MOMENTS - 1, 1, CAMERAS, put_neu3d, 0},
    [NEU3D_VIDEOS] = {"neu3d-videos", "", "cam%02d.mp4", 0, 0, 1, CAMERAS, put_neu3d_videos, 1},
    [COLMAP] = {"colmap", "", "images/%d.ppm", 0, 8, 8, 8, put_colmap, 0},
    [COLMAP_TEXT] = {"colmap-text", "", "images/%d.ppm", 0, 8, 8, 8, put_colmap_text, 0},
    [COLMAP_VIDEOS] = {"colmap-videos", "", "videos/%d.mp4", 0, 0, 1, CAMERAS, put_colmap_videos, 1},
    [SCENE_FILE] = {"adcgs", "scene.json", "cam0/%04d.ppm", 0, MOMENTS - 1, 1, CAMERAS, put_scene_file, 0},
    [SPLATS] = {"splats", "splats.ply", NULL, 0, 0, 1, 0, put_splats_file, 0},
};

#endif
