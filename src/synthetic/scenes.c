/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Prepares a scene's cameras and motion by the options, and writes the scene to a folder. */
#include "config.h"

#include "synthetic/scenes.h"

#include "media/image/image.h"
#include "synthetic/scene_views.h"
#include "synthetic/table.h"
#include "synthetic/texture.h"
#include "system/atomic.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <sys/stat.h>

/* Bounds of options and sizes; chosen by hand. */
#define OBJECTS_MAX 32    /* objects of a scene */
#define SAMPLES 3         /* rays along a side of a pixel, where a scene says nothing else */
#define PATH_BYTES 4096   /* bytes of a file name */
#define FRAMES_MAX 100000 /* frames */
#define CAMERAS_MAX 1000  /* cameras */
#define MOTION_MIN 0.001  /* factor of the scene's motion */
#define MOTION_MAX 10.0   /* the same */
#define NOISE_MAX 64.0    /* levels of 255 */
#define NOISE_SEED 29     /* any number */
#define WATCH_MAX 1000    /* views of --watch */
#define ASIDE_MAX 0.5     /* turns: --aside */
/* The layout needs the angle, radians: 2 atan(1 / ADCGS_SCENES_FOCAL), 2 atan(1 / ADCGS_SCENES_WIDE); geometry. */
#define CAMERA_ANGLE_X "0.7610127542247298"
#define CAMERA_ANGLE_WIDE "1.3494818844471053"

static const char *const split_names[ADCGS_SPLITS] = {"train", "val", "test"};

typedef struct writer {
    adcgs_scenes_entry scene; /* after the options were applied */
    double noise;             /* deviation of noise in training images; 1 is white */
    int watch;                /* number of validation views of one fixed camera */
    double aside;             /* turns from the end of the arc to the test cameras */
    adcgs_spoil spoil;
    adcgs_trace_object objects[OBJECTS_MAX]; /* the scene's, with the requested motion */
    const char *directory, *format;
    int width, height;
    adcgs_pool *pool;
    adcgs_scenes_progress_fn progress;
    void *user;
    int done;
    float *pixels; /* of an image or a mask, 3 planes; then alpha, 1 plane; then RGBA, 4 planes */
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

static int count_pictures(const adcgs_scenes_entry *scene)
{
    int n = 0;
    for (int split = 0; split < ADCGS_SPLITS; split++)
        n += adcgs_scenes_split_size(scene, split);
    return n;
}

/* Returns view i of a split. Validation views of one fixed camera and test views from outside the arc replace the scene's own. */
static adcgs_scenes_view view_at(const writer *w, int split, int i)
{
    adcgs_scenes_view v = adcgs_scenes_view_at(&w->scene, split, i, w->width);
    if (split == ADCGS_SPLIT_VAL && w->watch) {
        v.time = (double)i / (w->watch - 1);
        adcgs_scenes_place(&v.camera, &w->scene, 0.02, 0.080, w->width);
    } else if (split == ADCGS_SPLIT_TEST && w->aside > 0.0) {
        adcgs_scenes_place(&v.camera, &w->scene, 0.5 * ADCGS_SCENES_ARC + w->aside, 0.065 + 0.040 * (double)(i * 3 % 5) / 4.0,
                           w->width);
    }
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

static const char *mask_extension(const writer *w)
{
    return strcmp(w->format, "png") ? "pgm" : "png";
}

/* Scales the motion of moving objects by `motion`; the others keep the pose of time 0. */
static void take_objects(writer *w, double motion)
{
    for (int i = 0; i < w->scene.n_objects; i++) {
        adcgs_trace_object *const o = &w->objects[i];
        const double factor = w->scene.moving >> i & 1 ? motion : 0.0;
        *o = w->scene.objects[i];
        for (int c = 0; c < 3; c++) {
            o->velocity[c] *= factor;
            o->fade[c] *= factor;
            o->slide[c] *= factor;
        }
        o->zigs *= factor;
        o->beats *= factor;
        o->bounces *= factor;
        o->spin *= factor;
        o->orbit_turns *= factor;
        o->from *= factor;
        o->until *= factor;
    }
}

static adcgs_status write_pixels(writer *w, const char *name, const char *extension, int channels, float *pixels)
{
    char path[PATH_BYTES];
    const adcgs_image image = {.width = w->width, .height = w->height, .channels = channels, .data = pixels};
    ADCGS_TRY(join(path, w->directory, name, extension, w->error));
    return adcgs_image_write(&image, path, 0, w->error);
}

/* Adds sensor noise to image `number`. It is approximately normal: the sum of twelve random numbers. */
static void add_noise(const writer *w, int number)
{
    const int n = w->width * w->height * 3;
    for (int i = 0; i < n; i++) {
        double sum = -6.0;
        for (int k = 0; k < 12; k++)
            sum += adcgs_texture_random(i, k, number, NOISE_SEED);
        w->pixels[i] = (float)fmin(fmax((double)w->pixels[i] + w->noise * sum, 0.0), 1.0);
    }
}

static adcgs_spoil_picture picture_of(const writer *w, const adcgs_scenes_view *v, int i)
{
    const adcgs_spoil_picture picture = {.camera = v->number, .cameras = w->scene.cameras, .number = i, .width = w->width,
                                         .time = v->time, .step = w->scene.times > 1 ? 1.0 / (w->scene.times - 1) : 0.0,
                                         .stops = adcgs_scenes_stops(&w->scene, v->number)};
    return picture;
}

static size_t plane_of(const writer *w)
{
    return (size_t)w->width * (size_t)w->height;
}

static int samples_of(const adcgs_scenes_entry *scene)
{
    return scene->samples ? scene->samples : SAMPLES;
}

/* A camera exposes the object before compositing: divides the colours of objects by their coverage. */
static adcgs_status take_ground_off(writer *w, const adcgs_scenes_view *v, double time)
{
    float *const alpha = w->pixels + 3 * plane_of(w);
    ADCGS_TRY(adcgs_trace_alpha(w->objects, w->scene.n_objects, &v->camera, time, w->width, w->height, samples_of(&w->scene),
                                w->pool, alpha, w->error));
    for (size_t i = 0; i < 3 * plane_of(w); i++)
        w->pixels[i] = alpha[i / 3] > 0.0f ? fminf(w->pixels[i] / alpha[i / 3], 1.0f) : 0.0f;
    return ADCGS_OK;
}

static adcgs_status write_on_ground(writer *w, const char *name)
{
    const float *const alpha = w->pixels + 3 * plane_of(w), ground = w->scene.ground == ADCGS_GROUND_WHITE ? 1.0f : 0.0f;
    float *const rgba = w->pixels + 4 * plane_of(w);
    if (w->scene.ground != ADCGS_GROUND_ALPHA) {
        for (size_t i = 0; i < 3 * plane_of(w); i++)
            w->pixels[i] = alpha[i / 3] * w->pixels[i] + (1.0f - alpha[i / 3]) * ground;
        return write_pixels(w, name, w->format, 3, w->pixels);
    }
    for (size_t i = 0; i < 4 * plane_of(w); i++)
        rgba[i] = i % 4 == 3 ? alpha[i / 4] : w->pixels[3 * (i / 4) + i % 4];
    return write_pixels(w, name, w->format, 4, rgba);
}

static adcgs_status write_picture(writer *w, const adcgs_scenes_view *v, int split, int i, const char *name)
{
    const adcgs_spoil_picture picture = picture_of(w, v, i);
    const double time = split == ADCGS_SPLIT_TRAIN ? adcgs_spoil_time(&w->spoil, &picture) : v->time;
    const int is_open = w->scene.path == ADCGS_PATH_ROUND; /* part of an image may show no object */
    ADCGS_TRY(adcgs_trace_render(w->objects, w->scene.n_objects, &v->camera, time, w->width, w->height, samples_of(&w->scene),
                                 w->pool, w->pixels, w->error));
    if (is_open)
        ADCGS_TRY(take_ground_off(w, v, time));
    if (split == ADCGS_SPLIT_TRAIN)
        adcgs_spoil_pixels(&w->spoil, &picture, w->pixels, plane_of(w));
    if (split == ADCGS_SPLIT_TRAIN && w->noise > 0.0)
        add_noise(w, i);
    return is_open ? write_on_ground(w, name) : write_pixels(w, name, w->format, 3, w->pixels);
}

/* Writes the mask of moving regions. */
static adcgs_status write_mask(writer *w, const adcgs_scenes_view *v, const char *name)
{
    ADCGS_TRY(adcgs_trace_cover(w->objects, w->scene.n_objects, w->scene.moving, &v->camera, v->time, w->width, w->height,
                                samples_of(&w->scene), w->pool, w->pixels, w->error));
    return write_pixels(w, name, mask_extension(w), 1, w->pixels);
}

/* The layout omits ".png" in an image's name, but no other extension. A mask's name always has its extension. */
static void print_frame(const writer *w, FILE *file, const adcgs_scenes_view *v, const char *name, const char *mask)
{
    const double *const m = v->camera.to_world;
    fprintf(file, "    { \"file_path\": \"./%s%s\",", name, strcmp(w->format, "png") ? ".ppm" : "");
    if (w->scene.times > 1)
        fprintf(file, " \"time\": %.12g,", v->time);
    fprintf(file, "\n");
    if (mask)
        fprintf(file, "      \"moving_path\": \"./%s.%s\",\n", mask, mask_extension(w));
    fprintf(file, "      \"transform_matrix\": [");
    for (int r = 0; r < 3; r++)
        fprintf(file, "[%.12g, %.12g, %.12g, %.12g], ", m[4 * r], m[4 * r + 1], m[4 * r + 2], m[4 * r + 3]);
    fprintf(file, "[0, 0, 0, 1]] }");
}

/* The masks of moving regions are ground truth: training views get none. */
static adcgs_status write_view(writer *w, int split, int i, FILE *file)
{
    char name[32], mask[64];
    const adcgs_scenes_view v = view_at(w, split, i);
    adcgs_scenes_view said = v;
    const adcgs_spoil_picture picture = picture_of(w, &v, i);
    const int has_mask = split != ADCGS_SPLIT_TRAIN && w->scene.moving;
    snprintf(name, sizeof name, "%s/r_%03d", split_names[split], i);
    snprintf(mask, sizeof mask, "%s_moving", name);
    if (split == ADCGS_SPLIT_TRAIN)
        adcgs_spoil_pose(&w->spoil, &picture, v.camera.focal, said.camera.to_world);
    print_frame(w, file, &said, name, has_mask ? mask : NULL);
    ADCGS_TRY(write_picture(w, &v, split, i, name));
    return has_mask ? write_mask(w, &v, mask) : ADCGS_OK;
}

static int is_hidden(const writer *w, int split, int i)
{
    const adcgs_scenes_view v = view_at(w, split, i);
    const adcgs_spoil_picture picture = picture_of(w, &v, i);
    return split == ADCGS_SPLIT_TRAIN && adcgs_spoil_hides(&w->spoil, &picture);
}

static adcgs_status write_frames(writer *w, int split, FILE *file)
{
    const int n = adcgs_scenes_split_size(&w->scene, split), total = count_pictures(&w->scene);
    int written = 0;
    fprintf(file, "{\n  \"camera_angle_x\": %s,\n  \"frames\": [", w->scene.is_wide ? CAMERA_ANGLE_WIDE : CAMERA_ANGLE_X);
    for (int i = 0; i < n; i++) {
        if (!is_hidden(w, split, i)) {
            fprintf(file, written++ ? ",\n" : "\n");
            ADCGS_TRY(write_view(w, split, i, file));
        }
        w->done++;
        if (w->progress)
            w->progress(w->user, w->done, total);
    }
    fprintf(file, "\n  ]\n}\n");
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

/* Applies the requested numbers of times and cameras. */
static adcgs_status take_counts(adcgs_scenes_entry *scene, const adcgs_scenes_options *options, adcgs_error *error)
{
    if (options->frames < 0 || options->frames > FRAMES_MAX || options->cameras < 0 || options->cameras > CAMERAS_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scenes: %d frames, %d cameras, expected up to %d and %d", options->frames,
                          options->cameras, FRAMES_MAX, CAMERAS_MAX);
    if (options->cameras && scene->cameras == 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scene %s has one camera: their number cannot be changed", scene->name);
    const int each = scene->cameras / scene->turns; /* number of cameras that see each time */
    if (options->cameras > each && options->cameras % each)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%d cameras: in scene %s %d see each time, expected a multiple, or fewer",
                          options->cameras, scene->name, each);
    if (options->cameras) {
        scene->cameras = options->cameras;
        scene->turns = ADCGS_MAX(options->cameras / each, 1);
    }
    if (options->frames)
        scene->times = options->frames;
    if (options->watch)
        scene->n_val = options->watch;
    return ADCGS_OK;
}

static adcgs_status check_views(const adcgs_scenes_entry *scene, const adcgs_scenes_options *options, adcgs_error *error)
{
    if ((options->watch || options->aside != 0.0) && scene->path > ADCGS_PATH_HAND)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scene %s: cameras are not on an arc: --watch and --aside do not apply",
                          scene->name);
    if (options->watch && (options->watch < 2 || options->watch > WATCH_MAX))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scenes: %d views to watch, expected 2..%d", options->watch, WATCH_MAX);
    if (!(options->aside >= 0.0 && options->aside <= ASIDE_MAX))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scenes: test cameras %g turns aside, expected 0..%g", options->aside,
                          ASIDE_MAX);
    if (!(options->noise >= 0.0 && options->noise <= NOISE_MAX))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scenes: noise of %g levels, expected 0..%g", options->noise, NOISE_MAX);
    return ADCGS_OK;
}

adcgs_status adcgs_scenes_write(const char *directory, const adcgs_scenes_options *options, adcgs_pool *pool,
                                adcgs_scenes_progress_fn progress, void *user, adcgs_error *error)
{
    const adcgs_scenes_entry *const scene = adcgs_scenes_entry_find(options->name);
    const char *const format = options->format ? options->format : "png";
    if (!scene)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "unknown scene \"%s\"", options->name);
    if (strcmp(format, "png") && strcmp(format, "ppm"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scenes: format \"%s\", expected png or ppm", format);
    if (scene->ground == ADCGS_GROUND_ALPHA && strcmp(format, "png"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scene %s: its images have alpha, which %s cannot store: expected png",
                          scene->name, format);
    writer w = {.scene = *scene, .noise = options->noise / 255.0, .watch = options->watch,
                .aside = options->aside, .spoil = options->spoil, .directory = directory, .format = format,
                .width = options->width ? options->width : scene->size,
                .height = options->height ? options->height : scene->height ? scene->height : scene->size,
                .pool = pool, .progress = progress, .user = user, .error = error};
    if (w.width < 1 || w.height < 1 || w.width > 16384 || w.height > 16384)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scenes: size %dx%d, expected 1..16384 each", w.width, w.height);
    const double motion = options->motion != 0.0 ? options->motion : 1.0;
    if (!(motion >= MOTION_MIN && motion <= MOTION_MAX))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "scenes: motion %g, expected %g..%g", motion, MOTION_MIN, MOTION_MAX);
    ADCGS_TRY(check_views(scene, options, error));
    ADCGS_TRY(take_counts(&w.scene, options, error));
    take_objects(&w, motion);
    ADCGS_TRY(make_directory(directory, error));
    w.pixels = adcgs_alloc(NULL, plane_of(&w), 8 * sizeof *w.pixels, error);
    if (!w.pixels)
        return adcgs_alloc_status(error);
    adcgs_status status = ADCGS_OK;
    for (int split = 0; status == ADCGS_OK && split < ADCGS_SPLITS; split++)
        status = write_split(&w, split);
    adcgs_free(NULL, w.pixels);
    return status;
}
