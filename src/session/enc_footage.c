/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Messages on faults of footage. */
#include "session/enc_footage.h"

#include "check/faults.h"

#include <stdlib.h>

/* Reports that were made, as bits; definition. */
enum { GAPS = 1, DOUBLED = 2, LIGHT = 4, CLOCKS = 8, COPIED = 16, POSES = 32, TIMES = 64, AXES = 128 };

/** A path relative to the scene's folder, if it lies there. */
static const char *short_name(const adcgs_scene *scene, const char *path)
{
    const size_t length = strlen(scene->directory);
    if (strncmp(path, scene->directory, length) != 0 || path[length] != '/')
        return path;
    path += length + 1;
    return strncmp(path, "./", 2) ? path : path + 2;
}

/** Writes the given words followed by "another camera" or "N other cameras", or nothing for a single camera. */
static const char *others(char text[64], const char *what, const adcgs_fault *f)
{
    *text = '\0';
    if (f->cameras == 2)
        snprintf(text, 64, "%s another camera", what);
    else if (f->cameras > 2)
        snprintf(text, 64, "%s %u other cameras", what, f->cameras - 1);
    return text;
}

static void report_gaps(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *f)
{
    char more[64];
    if (!f->path)
        adcgs_cli_note(cli,
                       "%s: no camera has an image between %.3f and %.3f s: motion there is unknown; check for missing "
                       "files",
                       scene->directory, f->from, f->to);
    else
        adcgs_cli_note(cli, "%s: its camera has no image between %.3f and %.3f s, where %.0f would be expected%s",
                       short_name(scene, f->path), f->from, f->to, f->size, others(more, "; gaps also in", f));
}

/** Writes ", as do N others", or nothing. */
static const char *so_are(char text[64], double n)
{
    snprintf(text, 64, n > 0 ? ", as does another" : "");
    if (n > 1)
        snprintf(text, 64, ", as do %.0f others", n);
    return text;
}

static void report_duplicates(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *f, double begins)
{
    char more[64], of_this[64] = "";
    if (f->size > 1)
        snprintf(of_this, sizeof of_this, ", %u of this camera", f->count - 1);
    adcgs_cli_note(cli,
                   "%s: the image at %.3f s repeats the previous one%s%s: check for doubled frames (--set retime_duplicates)",
                   short_name(scene, f->path), begins + f->from, so_are(more, f->size - 1), of_this);
}

static void report_copies(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *f, double begins)
{
    char more[64];
    adcgs_cli_note(cli, "%s: the image at %.3f s repeats the previous image of another camera%s: check for mixed-up files",
                   short_name(scene, f->path), begins + f->from, so_are(more, f->size - 1));
}

/** is_evened: the step was removed from the images. */
static void report_light(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *f, double begins, int is_evened)
{
    static const char *const what[ADCGS_LIGHTS][2] = {{"bright", "exposure"},
                                                      {"red relative to green", "white balance"},
                                                      {"blue relative to green", "white balance"}};
    char more[64], question[80];
    snprintf(question, sizeof question, "check %s and light (--set exposure_step_compensation)", what[f->light][1]);
    adcgs_cli_note(cli, "%s: at %.3f s the images of %s become %.2f times as %s%s: %s", short_name(scene, f->path),
                   begins + f->to, f->cameras == f->of && f->of > 1 ? "all cameras" : "its camera", f->size, what[f->light][0],
                   f->cameras == f->of ? "" : others(more, ", and those of", f),
                   is_evened ? "this and all other steps of light are evened out" : question);
}

void adcgs_enc_report_light(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *light)
{
    if (light->cameras)
        report_light(cli, scene, light, 0, 1);
    else
        adcgs_cli_note(cli, "%s: exposure_step_compensation: no steps of light found", scene->directory);
}

static void report_clocks(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_fault *f)
{
    char more[64];
    adcgs_cli_note(cli, "%s: its camera appears %u frame%s %s than others%s: check synchronisation", short_name(scene, f->path),
                   f->count, f->count > 1 ? "s" : "", f->size > 0 ? "later" : "earlier", others(more, "; also", f));
}

static void report_poses(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_stereo_pose_error *poses)
{
    adcgs_cli_note(cli, "%s: matched points of cameras lie %.1f pixels apart (median): check poses and lenses", scene->directory,
                   poses->median * poses->pixels);
}

/** Reports the convention that fits the poses, if it is not the given one. */
static void report_axes(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_axes_check *d)
{
    static const char *const changes[ADCGS_READINGS] = {"", "y and z of all cameras are flipped", "all poses are inverted",
                                                        "all poses are inverted"};
    static const char *const questions[ADCGS_READINGS] = {"", "axes are OpenGL's instead of OpenCV's, or the reverse",
                                                          "matrices map world to camera instead of camera to world",
                                                          "matrices map world to camera instead of camera to world"};
    const char *const change = changes[d->meant], *const question = questions[d->meant], *const where = scene->directory;
    if (d->by == ADCGS_BY_POINTS)
        adcgs_cli_note(cli,
                       "%s: a camera sees %.0f %% of the points, and %.0f %% if %s: check whether "
                       "%s",
                       where, 100.0 * d->here, 100.0 * d->there, change, question);
    else if (d->by == ADCGS_BY_IMAGES)
        adcgs_cli_note(cli,
                       "%s: the cameras' images contradict each other, but not if %s: check whether "
                       "%s",
                       where, change, question);
    else
        adcgs_cli_note(cli, "%s: all cameras %s; if they should surround the scene, check whether %s", where,
                       d->meant == ADCGS_READ_TURNED ? "look away from each other" : "are in one place", question);
}

/** Reports the pose of a single camera. */
static void report_pose_outlier(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_pose_outlier *o, double pixels)
{
    const char *const path = short_name(scene, scene->views[ADCGS_SPLIT_TRAIN][o->view].path);
    adcgs_cli_note(cli,
                   "%s: its camera disagrees with the others by %.1f pixels (rotation %.1f degrees, translation %.0f %% of "
                   "the distance to them): check its pose or lens",
                   path, o->off * pixels, o->turned, 100.0 * o->moved);
}

/** Reports wrong poses. */
static void look_at_poses(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_scene *whole, const adcgs_stereo *found,
                          adcgs_pool *pool, unsigned *told)
{
    adcgs_axes_check check;
    adcgs_error error;
    if (!(*told & AXES) && adcgs_axes_check_run(&check, scene, found, pool, &error) == ADCGS_OK &&
        check.meant != ADCGS_READ_AS_GIVEN) {
        report_axes(cli, whole, &check);
        *told |= POSES;
    }
    *told |= AXES; /* checked for the first part of a scene */
    if (!(*told & POSES) && found->poses.pairs >= ADCGS_STEREO_PAIRS && !adcgs_stereo_poses_fit(&found->poses)) {
        report_poses(cli, whole, &found->poses);
        *told |= POSES;
    }
    for (int i = 0; i < found->n_outliers && !(*told & POSES); i++)
        report_pose_outlier(cli, scene, &found->outlier[i], found->poses.pixels);
}

/** Reports faults of the images, each kind once. */
static void look_at_pictures(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_scene *whole,
                             const adcgs_camera_order *tracks, const adcgs_thumbnail *thumbnails, double begins, unsigned *told)
{
    const adcgs_scene_view *const views = scene->views[ADCGS_SPLIT_TRAIN];
    adcgs_fault f;
    adcgs_error error;
    if (!(*told & COPIED) && adcgs_fault_copied(&f, views, tracks, thumbnails, &error) == ADCGS_OK && f.cameras) {
        report_copies(cli, whole, &f, begins);
        *told |= COPIED;
    }
    if (!(*told & LIGHT) && adcgs_fault_light(&f, NULL, views, tracks, thumbnails, &error) == ADCGS_OK && f.cameras) {
        report_light(cli, whole, &f, begins, 0);
        *told |= LIGHT;
    }
    if (!(*told & CLOCKS) && adcgs_fault_clocks(&f, views, tracks, thumbnails, &error) == ADCGS_OK && f.cameras) {
        report_clocks(cli, whole, &f);
        *told |= CLOCKS;
    }
}

void adcgs_enc_report_remarks(const adcgs_cli *cli, const adcgs_scene *scene)
{
    for (int i = 0; i < scene->n_remarks; i++)
        adcgs_cli_note(cli, "%s", scene->remarks[i]);
}

/** Reports images that have no times, but seem to be frames. */
static void report_times(const adcgs_cli *cli, const adcgs_scene *scene)
{
    adcgs_cli_note(cli,
                   "%s: the images' names are plain numbers, so the scene is static: if they are frames of a video, "
                   "adcgs-import makes a scene with times",
                   scene->directory);
}

void adcgs_enc_diagnose_footage(const adcgs_cli *cli, const adcgs_scene *scene, const adcgs_stereo *found,
                                const adcgs_fault *doubled, adcgs_pool *pool, const adcgs_thumbnail *thumbnails, double begins,
                                unsigned *told)
{
    const adcgs_scene *const whole = scene->whole ? scene->whole : scene;
    adcgs_fault gaps;
    adcgs_camera_order tracks;
    adcgs_error error;
    if (!(*told & GAPS) && adcgs_fault_gaps(&gaps, whole, &error) == ADCGS_OK && gaps.cameras)
        report_gaps(cli, whole, &gaps);
    if (!(*told & TIMES) && whole->counts)
        report_times(cli, whole);
    *told |= GAPS | TIMES; /* checks of the whole scene, once */
    look_at_poses(cli, scene, whole, found, pool, told);
    if (!(*told & DOUBLED) && doubled->cameras) {
        report_duplicates(cli, whole, doubled, begins);
        *told |= DOUBLED;
    }
    if (adcgs_camera_order_find(&tracks, scene->views[ADCGS_SPLIT_TRAIN], scene->n_views[ADCGS_SPLIT_TRAIN], &error) != ADCGS_OK)
        return;
    look_at_pictures(cli, scene, whole, &tracks, thumbnails, begins, told);
    adcgs_camera_order_clear(&tracks);
}
