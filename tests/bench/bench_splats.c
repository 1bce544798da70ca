/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Evaluation of splats of any program on the images of a scene, and export of a scene for training by such a program; see
 * peers.sh.
 *
 *     moment SCENE         the timestamp, in seconds, with the most test views; of several the one nearest the middle
 *     psnr SCENE PLY TIME [clip [R,G,B]]  of a PLY file of splats in the scene's coordinates: mean PSNR of the test views at this
 *                          time, and their number; computed as in adcgs-eval, on images of 8 bits. TIME all: of all views. clip:
 *                          set negative colours to 0, as viewers of such files do; this project's decoder adds them unchanged.
 *                          R,G,B is the background, by default the scene's
 *     export SCENE FOLDER  the undistorted training views, and the initial points in nerfstudio's format, to the existing FOLDER;
 *                          no data of any other view. Dynamic scenes, scenes with masks and scenes without points are rejected
 */
#include "config.h"

#include "cli/cli.h"
#include "metric/metric.h"
#include "scene/layouts/open.h"
#include "scene/splat_views.h"
#include "system/json.h"
#include "system/numbers.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SAME_TIME 1e-9
#define OPACITY_MAX 0.99f /* largest opacity of a primitive */
#define PATH 4096
#define NAME 32
#define DIGITS 17

static int is_at(const adcgs_scene_view *view, double time)
{
    return fabs(view->time - time) <= SAME_TIME;
}

/* ---- moment ---- */

static void find_moment(const adcgs_scene *scene)
{
    const adcgs_scene_view *const v = scene->views[ADCGS_SPLIT_TEST];
    const double middle = scene->duration / 2;
    double best = 0;
    uint32_t most = 0;
    for (uint32_t i = 0; i < scene->n_views[ADCGS_SPLIT_TEST]; i++) {
        uint32_t n = 0;
        for (uint32_t j = 0; j < scene->n_views[ADCGS_SPLIT_TEST]; j++)
            n += is_at(&v[j], v[i].time) != 0;
        if (n < most || (n == most && fabs(v[i].time - middle) >= fabs(best - middle)))
            continue;
        most = n;
        best = v[i].time;
    }
    printf("%.17g\n", best);
}

/* ---- psnr ---- */

/** Limits values to the ranges of primitives, which splats of other programs may exceed. */
static void bound(adcgs_splats *s, int clip)
{
    for (uint32_t i = 0; i < s->n; i++) {
        s->opacity[i] = fminf(s->opacity[i], OPACITY_MAX);
        for (int c = 0; c < 3 && clip; c++)
            if (!s->degree) /* with a degree, colours are clipped when they are evaluated for a view */
                s->colour[c][i] = fmaxf(s->colour[c][i], 0.0f);
    }
}

static adcgs_status measure_view(double *psnr, adcgs_splat_scene *splats, const float background[3], const adcgs_scene *scene,
                                 const adcgs_scene_view *view, adcgs_error *error)
{
    adcgs_image picture;
    float *truth = NULL;
    ADCGS_TRY(adcgs_splat_scene_render(splats, background, &view->camera, 0.0, &picture, view->path, error));
    const size_t plane = (size_t)picture.width * (size_t)picture.height;
    uint8_t *const levels = malloc(3 * plane);
    float *const planar = malloc(3 * plane * sizeof *planar);
    adcgs_status status = levels && planar ? adcgs_scene_image(scene, view, 1, &truth, NULL, error)
                                           : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory");
    if (status == ADCGS_OK) {
        adcgs_image_to_u8(picture.data, 3 * plane, levels);
        for (size_t i = 0; i < 3 * plane; i++)
            planar[i % 3 * plane + i / 3] = (float)levels[i] / 255.0f;
        *psnr = adcgs_psnr(planar, truth, 3 * plane);
    }
    free(levels);
    free(planar);
    free(truth);
    adcgs_image_free(&picture);
    return status;
}

/** time: NaN for all views. */
static adcgs_status measure(const adcgs_scene *scene, const char *path, double time, int clip, const float background[3],
                            adcgs_error *error)
{
    adcgs_splat_scene splats = {.radius = 1};
    double sum = 0;
    uint32_t n = 0;
    ADCGS_TRY(adcgs_splats_read(&splats.splats, path, error));
    bound(&splats.splats, clip);
    memcpy(splats.centre, splats.splats.offset, sizeof splats.centre);
    adcgs_status status = ADCGS_OK;
    for (uint32_t i = 0; i < scene->n_views[ADCGS_SPLIT_TEST] && status == ADCGS_OK; i++) {
        const adcgs_scene_view *const view = &scene->views[ADCGS_SPLIT_TEST][i];
        double psnr = 0;
        if (!isnan(time) && !is_at(view, time))
            continue;
        status = measure_view(&psnr, &splats, background, scene, view, error);
        sum += psnr;
        n++;
    }
    adcgs_splats_free(&splats.splats);
    ADCGS_TRY(status);
    if (!n)
        return adcgs_fail(error, ADCGS_ERR_DATA, "no test view at this time");
    printf("%.4f %u\n", sum / n, n);
    return ADCGS_OK;
}

static adcgs_status parse_and_measure(const adcgs_scene *scene, int argc, char **argv, adcgs_error *error)
{
    float background[3];
    double time = (double)NAN;
    memcpy(background, scene->background, sizeof background);
    if (strcmp(argv[4], "all") != 0 && adcgs_parse_real(argv[4], 0, 1e9, &time))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: expected seconds, or all", argv[4]);
    if (argc > 5 && strcmp(argv[5], "clip") != 0)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: expected clip", argv[5]);
    if (argc > 6 && sscanf(argv[6], "%f,%f,%f", &background[0], &background[1], &background[2]) != 3)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: expected R,G,B", argv[6]);
    return measure(scene, argv[3], time, argc > 5, background, error);
}

/* ---- export ---- */

static adcgs_status join(char path[PATH], const char *folder, const char *name, adcgs_error *error)
{
    if ((size_t)snprintf(path, PATH, "%s/%s", folder, name) >= PATH)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%.100s...: path too long", folder);
    return ADCGS_OK;
}

/** Generated names: those of the scene may contain any characters, and may be equal in two folders. */
static const char *name_view(char name[NAME], uint32_t i)
{
    snprintf(name, NAME, "train-%04u.png", i);
    return name;
}

static adcgs_status write_picture(const adcgs_scene *scene, const adcgs_scene_view *view, const char *path, adcgs_error *error)
{
    float *planar;
    adcgs_image picture;
    ADCGS_TRY(adcgs_scene_image(scene, view, 1, &planar, NULL, error));
    adcgs_status status = adcgs_image_alloc(&picture, view->camera.width, view->camera.height, 3, path, error);
    if (status == ADCGS_OK) {
        const size_t plane = (size_t)picture.width * (size_t)picture.height;
        for (size_t i = 0; i < 3 * plane; i++)
            picture.data[i] = planar[i % 3 * plane + i / 3];
        status = adcgs_image_write(&picture, path, 0, error);
        adcgs_image_free(&picture);
    }
    free(planar);
    return status;
}

/** Axes of OpenGL: y up, viewing direction -z. */
static void put_pose(adcgs_json *json, const adcgs_camera *camera)
{
    adcgs_json_open(json, "transform_matrix", '[');
    for (int row = 0; row < 4; row++) {
        adcgs_json_open(json, NULL, '[');
        for (int column = 0; column < 4; column++) {
            const double value = row == 3 ? column == 3 : camera->cam_to_world[4 * row + column];
            adcgs_json_real(json, NULL, row < 3 && (column == 1 || column == 2) ? -value : value);
        }
        adcgs_json_close(json);
    }
    adcgs_json_close(json);
}

static adcgs_status put_view(adcgs_json *json, const adcgs_scene *scene, uint32_t i, const char *folder, adcgs_error *error)
{
    const adcgs_scene_view *const view = &scene->views[ADCGS_SPLIT_TRAIN][i];
    char path[PATH], name[NAME];
    if (view->mask)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "the scene has masks");
    ADCGS_TRY(join(path, folder, name_view(name, i), error));
    ADCGS_TRY(write_picture(scene, view, path, error));
    adcgs_json_open(json, NULL, '{');
    adcgs_json_string(json, "file_path", name);
    adcgs_json_int(json, "w", view->camera.width);
    adcgs_json_int(json, "h", view->camera.height);
    adcgs_json_real(json, "fl_x", view->camera.fx);
    adcgs_json_real(json, "fl_y", view->camera.fy);
    adcgs_json_real(json, "cx", view->camera.cx);
    adcgs_json_real(json, "cy", view->camera.cy);
    put_pose(json, &view->camera);
    adcgs_json_close(json);
    return ADCGS_OK;
}

/** train_filenames is for this project: read as a scene again, the export has no other views. */
static adcgs_status put_scene(adcgs_json *json, const adcgs_scene *scene, const char *folder, adcgs_error *error)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    char name[NAME];
    adcgs_json_open(json, NULL, '{');
    adcgs_json_string(json, "camera_model", "OPENCV");
    adcgs_json_string(json, "ply_file_path", "points.ply");
    adcgs_json_open(json, "train_filenames", '[');
    for (uint32_t i = 0; i < n; i++)
        adcgs_json_string(json, NULL, name_view(name, i));
    adcgs_json_close(json);
    adcgs_json_open(json, "frames", '[');
    for (uint32_t i = 0; i < n; i++)
        ADCGS_TRY(put_view(json, scene, i, folder, error));
    adcgs_json_close(json);
    adcgs_json_close(json);
    return ADCGS_OK;
}

static adcgs_status write_scene(const adcgs_scene *scene, const char *folder, adcgs_error *error)
{
    char path[PATH];
    adcgs_json json;
    adcgs_json_init(&json);
    json.digits = DIGITS;
    adcgs_status status = put_scene(&json, scene, folder, error);
    if (status == ADCGS_OK)
        status = join(path, folder, "transforms.json", error);
    FILE *const file = status == ADCGS_OK ? fopen(path, "w") : NULL;
    if (status == ADCGS_OK && !file)
        status = adcgs_fail(error, ADCGS_ERR_IO, "%s: %s", path, strerror(errno));
    if (file) {
        status = adcgs_json_write(&json, file, path, error);
        if (fclose(file) && status == ADCGS_OK)
            status = adcgs_fail(error, ADCGS_ERR_IO, "%s: %s", path, strerror(errno));
    }
    adcgs_json_clear(&json);
    return status;
}

static adcgs_status export(const adcgs_scene *scene, const char *folder, adcgs_error *error)
{
    char path[PATH];
    if (scene->duration > 0)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "the scene is dynamic");
    if (!scene->points.n)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "the scene has no points");
    ADCGS_TRY(join(path, folder, "points.ply", error));
    ADCGS_TRY(adcgs_ply_write(&scene->points, path, error));
    return write_scene(scene, folder, error);
}

/* ---- Command line ---- */

static adcgs_status answer(const adcgs_scene *scene, int argc, char **argv, adcgs_error *error)
{
    if (!strcmp(argv[1], "export"))
        return export(scene, argv[3], error);
    if (!scene->n_views[ADCGS_SPLIT_TEST])
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no test views", argv[2]);
    if (!strcmp(argv[1], "psnr"))
        return parse_and_measure(scene, argc, argv, error);
    find_moment(scene);
    return ADCGS_OK;
}

int main(int argc, char **argv)
{
    const char *const what = argc > 1 ? argv[1] : "";
    const adcgs_scene_options any = {0};
    adcgs_scene *scene = NULL;
    adcgs_error error = {0};
    if (!(argc == 3 && !strcmp(what, "moment")) && !(argc >= 5 && argc <= 7 && !strcmp(what, "psnr")) &&
        !(argc == 4 && !strcmp(what, "export"))) {
        fprintf(stderr, "expected moment SCENE, psnr SCENE PLY TIME|all [clip [R,G,B]], or export SCENE FOLDER\n");
        return 2;
    }
    adcgs_status status = adcgs_scene_open(&scene, argv[2], &any, &error);
    if (status == ADCGS_OK)
        status = answer(scene, argc, argv, &error);
    if (status != ADCGS_OK)
        fprintf(stderr, "%s\n", error.text);
    adcgs_scene_free(&scene);
    return status == ADCGS_OK ? 0 : 1;
}
