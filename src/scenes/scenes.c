/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Where the cameras of a scene stand, and writing the scene to a folder. */
#include "config.h"

#include "scenes/scenes.h"

#include "data/scene.h"
#include "io/atomic.h"
#include "io/image.h"
#include "scenes/sine.h"
#include "scenes/table.h"

#include <errno.h>
#include <stdio.h>
#include <sys/stat.h>

#define OBJECTS_MAX 32
#define SAMPLES 3
#define PATH_BYTES 4096
/* The focal length is HALF_WIDTH_INVERSE half widths; the layout wants the angle, 2 atan(1/2.5). */
#define HALF_WIDTH_INVERSE 2.5
#define CAMERA_ANGLE_X "0.7610127542247298"

static const char *const split_names[ADCGS_SPLITS] = {"train", "val", "test"};

typedef struct view {
    adcgs_trace_camera camera;
    double time;
} view;

typedef struct writer {
    const adcgs_scenes_entry *scene;
    const char *directory, *format;
    int width, height;
    adcgs_pool *pool;
    adcgs_scenes_progress_fn progress;
    void *user;
    int done;
    float *rgb;
    adcgs_error *error;
} writer;

const char *adcgs_scenes_name(int i)
{
    const adcgs_scenes_entry *const entry = adcgs_scenes_entry_at(i);
    return entry ? entry->name : NULL;
}

const char *adcgs_scenes_about(int i)
{
    const adcgs_scenes_entry *const entry = adcgs_scenes_entry_at(i);
    return entry ? entry->about : NULL;
}

static int split_size(const adcgs_scenes_entry *scene, int split)
{
    return split == ADCGS_SPLIT_TRAIN ? scene->cameras / scene->turns * scene->times
           : split == ADCGS_SPLIT_VAL ? scene->n_val
                                      : scene->n_test;
}

int adcgs_scenes_count(const char *name)
{
    const adcgs_scenes_entry *const scene = adcgs_scenes_entry_find(name);
    int n = 0;
    for (int split = 0; scene && split < ADCGS_SPLITS; split++)
        n += split_size(scene, split);
    return n;
}

/* Azimuth from -y and elevation in turns; part of a hemisphere around the target. */
static void place(adcgs_trace_camera *camera, const adcgs_scenes_entry *scene, double azimuth, double elevation, int width)
{
    const double flat = scene->distance * adcgs_trace_cos(elevation);
    const double eye[3] = {scene->target[0] + flat * adcgs_trace_sin(azimuth), scene->target[1] - flat * adcgs_trace_cos(azimuth),
                           scene->target[2] + scene->distance * adcgs_trace_sin(elevation)};
    camera->focal = 0.5 * width * HALF_WIDTH_INVERSE;
    adcgs_trace_look(camera, eye, scene->target);
}

/*
 * Training cameras stand on an arc of 140 degrees at three heights and take
 * turns: each moment is seen by some of them. The others stand between them, and the test looks between the times too.
 */
static view view_at(const adcgs_scenes_entry *scene, int split, int i, int width)
{
    static const double heights[3] = {0.050, 0.120, 0.085};
    static const double shift[ADCGS_SPLITS] = {0.0, 0.3, 0.5};
    const int steps = scene->times - 1, count = split_size(scene, split);
    view v;
    if (split == ADCGS_SPLIT_TRAIN) {
        const int each = scene->cameras / scene->turns, moment = i / each;
        const int c = i % each * scene->turns + moment % scene->turns;
        v.time = steps > 0 ? (double)moment / steps : 0.0;
        place(&v.camera, scene, 0.39 * ((double)c / (scene->cameras - 1) - 0.5), heights[(c + c / 3) % 3], width);
        return v;
    }
    const double along = (i + shift[split]) / count;
    /* 7 is coprime to the counts in use, so that place and time do not run together. */
    const double moment = (double)(i * 7 % count) / count * steps;
    v.time = steps > 0 ? ((double)(int)moment + (split == ADCGS_SPLIT_TEST ? 0.5 : 0.0)) / steps : 0.0;
    place(&v.camera, scene, 0.36 * (along - 0.5), 0.065 + 0.040 * (double)(i * 3 % 5) / 4.0, width);
    return v;
}

static adcgs_status make_directory(const char *path, adcgs_error *error)
{
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot make the folder: %s", path, strerror(errno));
    return ADCGS_OK;
}

static adcgs_status join(char path[PATH_BYTES], const char *directory, const char *name, const char *extension,
                         adcgs_error *error)
{
    if (snprintf(path, PATH_BYTES, "%s/%s%s%s", directory, name, *extension ? "." : "", extension) >= PATH_BYTES)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%.60s...: path too long", directory);
    return ADCGS_OK;
}

static adcgs_status write_picture(writer *w, const view *v, const char *name)
{
    adcgs_trace_object objects[OBJECTS_MAX];
    char path[PATH_BYTES];
    const adcgs_scenes_entry *const scene = w->scene;
    memcpy(objects, scene->objects, (size_t)scene->n_objects * sizeof objects[0]);
    for (int i = 0; i < scene->n_objects; i++) {
        adcgs_trace_object *const o = &objects[i];
        if (scene->moving >> i & 1)
            continue;
        memset(o->velocity, 0, sizeof o->velocity);
        memset(o->fade, 0, sizeof o->fade);
        o->bounces = o->spin = o->orbit_turns = 0.0;
    }
    ADCGS_TRY(join(path, w->directory, name, w->format, w->error));
    ADCGS_TRY(adcgs_trace_render(objects, scene->n_objects, &v->camera, v->time, w->width, w->height, SAMPLES, w->pool, w->rgb,
                                 w->error));
    const adcgs_image image = {.width = w->width, .height = w->height, .channels = 3, .data = w->rgb};
    return adcgs_image_write(&image, path, 0, w->error);
}

static void print_frame(FILE *file, const view *v, const char *name, const char *extension, int last)
{
    const double *const m = v->camera.to_world;
    fprintf(file, "    { \"file_path\": \"./%s%s\", \"time\": %.12g,\n      \"transform_matrix\": [", name, extension, v->time);
    for (int r = 0; r < 3; r++)
        fprintf(file, "[%.12g, %.12g, %.12g, %.12g], ", m[4 * r], m[4 * r + 1], m[4 * r + 2], m[4 * r + 3]);
    fprintf(file, "[0, 0, 0, 1]] }%s\n", last ? "" : ",");
}

static adcgs_status write_frames(writer *w, int split, FILE *file)
{
    const int n = split_size(w->scene, split), total = adcgs_scenes_count(w->scene->name);
    fprintf(file, "{\n  \"camera_angle_x\": " CAMERA_ANGLE_X ",\n  \"frames\": [\n");
    for (int i = 0; i < n; i++) {
        char name[32];
        const view v = view_at(w->scene, split, i, w->width);
        snprintf(name, sizeof name, "%s/r_%03d", split_names[split], i);
        /* The layout leaves ".png" out; any other extension is written out. */
        print_frame(file, &v, name, strcmp(w->format, "png") ? ".ppm" : "", i == n - 1);
        ADCGS_TRY(write_picture(w, &v, name));
        w->done++;
        if (w->progress)
            w->progress(w->user, w->done, total);
    }
    fprintf(file, "  ]\n}\n");
    return ADCGS_OK;
}

static adcgs_status write_split(writer *w, int split)
{
    char path[PATH_BYTES], name[32];
    ADCGS_TRY(join(path, w->directory, split_names[split], "", w->error));
    ADCGS_TRY(make_directory(path, w->error));
    snprintf(name, sizeof name, "transforms_%s", split_names[split]);
    ADCGS_TRY(join(path, w->directory, name, "json", w->error));
    adcgs_atomic file;
    ADCGS_TRY(adcgs_atomic_open(&file, path, w->error));
    const adcgs_status status = write_frames(w, split, file.file);
    if (status == ADCGS_OK)
        return adcgs_atomic_commit(&file, w->error);
    adcgs_atomic_abort(&file);
    return status;
}

adcgs_status adcgs_scenes_write(const char *directory, const adcgs_scenes_options *options, adcgs_pool *pool,
                                adcgs_scenes_progress_fn progress, void *user, adcgs_error *error)
{
    const adcgs_scenes_entry *const scene = adcgs_scenes_entry_find(options->name);
    const char *const format = options->format ? options->format : "png";
    if (!scene)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "no scene is called \"%s\"", options->name);
    if (strcmp(format, "png") && strcmp(format, "ppm"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scenes: format \"%s\", expected png or ppm", format);
    writer w = {.scene = scene, .directory = directory, .format = format, .pool = pool, .progress = progress, .user = user,
                .width = options->width ? options->width : scene->size, .height = options->height ? options->height : scene->size,
                .error = error};
    if (w.width < 1 || w.height < 1 || w.width > 16384 || w.height > 16384)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scenes: size %dx%d, expected 1..16384 each", w.width, w.height);
    ADCGS_TRY(make_directory(directory, error));
    w.rgb = adcgs_alloc(NULL, (size_t)w.width * (size_t)w.height, 3 * sizeof *w.rgb, error);
    if (!w.rgb)
        return adcgs_alloc_status(error);
    adcgs_status status = ADCGS_OK;
    for (int split = 0; status == ADCGS_OK && split < ADCGS_SPLITS; split++)
        status = write_split(&w, split);
    adcgs_free(NULL, w.rgb);
    return status;
}
