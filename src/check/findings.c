/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Texts of the findings on footage. */
#include "config.h"

#include "check/findings.h"

#include "system/paths.h"

#include <stdio.h>
#include <stdlib.h>

const char *const adcgs_finding_names[ADCGS_FINDING_KINDS] = {"gap",       "times", "axes",  "poses", "pose_outlier",
                                                              "duplicate", "copy",  "light", "clock"};

void adcgs_findings_clear(adcgs_findings *findings)
{
    for (int i = 0; i < findings->n; i++)
        free(findings->list[i].text);
    findings->n = 0;
}

/** Takes text, from malloc() or NULL. */
static void append(adcgs_findings *findings, adcgs_finding_kind kind, char *text)
{
    if (text && findings->n < ADCGS_FINDINGS_MAX)
        findings->list[findings->n++] = (adcgs_finding){kind, text};
    else
        free(text);
}

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

void adcgs_find_gap(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *f)
{
    char more[64];
    append(findings, ADCGS_FINDING_GAP,
           f->path ? adcgs_path("%s: its camera has no image between %.3f and %.3f s, where %.0f would be expected%s",
                                short_name(scene, f->path), f->from, f->to, f->size, others(more, "; gaps also in", f))
                   : adcgs_path("%s: no camera has an image between %.3f and %.3f s: motion there is unknown; check for missing "
                                "files",
                                scene->directory, f->from, f->to));
}

void adcgs_find_times(adcgs_findings *findings, const adcgs_scene *scene)
{
    append(findings, ADCGS_FINDING_TIMES,
           adcgs_path("%s: the images' names are plain numbers, so the scene is static: if they are frames of a video, "
                      "adcgs-import makes a scene with times",
                      scene->directory));
}

void adcgs_find_axes(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_axes_check *d)
{
    static const char *const changes[ADCGS_READINGS] = {"", "y and z of all cameras are flipped", "all poses are inverted",
                                                        "all poses are inverted"};
    static const char *const questions[ADCGS_READINGS] = {"", "axes are OpenGL's instead of OpenCV's, or the reverse",
                                                          "matrices map world to camera instead of camera to world",
                                                          "matrices map world to camera instead of camera to world"};
    const char *const change = changes[d->meant], *const question = questions[d->meant], *const where = scene->directory;
    char *text;
    if (d->by == ADCGS_BY_POINTS)
        text = adcgs_path("%s: a camera sees %.0f %% of the points, and %.0f %% if %s: check whether "
                          "%s",
                          where, 100.0 * d->here, 100.0 * d->there, change, question);
    else if (d->by == ADCGS_BY_IMAGES)
        text = adcgs_path("%s: the cameras' images contradict each other, but not if %s: check whether "
                          "%s",
                          where, change, question);
    else
        text = adcgs_path("%s: all cameras %s; if they should surround the scene, check whether %s", where,
                          d->meant == ADCGS_READ_TURNED ? "look away from each other" : "are in one place", question);
    append(findings, ADCGS_FINDING_AXES, text);
}

void adcgs_find_poses(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_stereo_pose_error *poses)
{
    append(findings, ADCGS_FINDING_POSES,
           adcgs_path("%s: matched points of cameras lie %.1f pixels apart (median): check poses and lenses", scene->directory,
                      poses->median * poses->pixels));
}

void adcgs_find_pose_outlier(adcgs_findings *findings, const adcgs_scene *scene, const char *path, const adcgs_pose_outlier *o,
                             double pixels)
{
    append(findings, ADCGS_FINDING_POSE_OUTLIER,
           adcgs_path("%s: its camera disagrees with the others by %.1f pixels (rotation %.1f degrees, translation %.0f %% of "
                      "the distance to them): check its pose or lens",
                      short_name(scene, path), o->off * pixels, o->turned, 100.0 * o->moved));
}

/** Writes ", as do N others", or nothing. */
static const char *so_are(char text[64], double n)
{
    snprintf(text, 64, n > 0 ? ", as does another" : "");
    if (n > 1)
        snprintf(text, 64, ", as do %.0f others", n);
    return text;
}

void adcgs_find_duplicate(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *f, double begins)
{
    char more[64], of_this[64] = "";
    if (f->size > 1)
        snprintf(of_this, sizeof of_this, ", %u of this camera", f->count - 1);
    append(findings, ADCGS_FINDING_DUPLICATE,
           adcgs_path("%s: the image at %.3f s repeats the previous one%s%s: check for doubled frames (--set retime_duplicates)",
                      short_name(scene, f->path), begins + f->from, so_are(more, f->size - 1), of_this));
}

void adcgs_find_copy(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *f, double begins)
{
    char more[64];
    append(findings, ADCGS_FINDING_COPY,
           adcgs_path("%s: the image at %.3f s repeats the previous image of another camera%s: check for mixed-up files",
                      short_name(scene, f->path), begins + f->from, so_are(more, f->size - 1)));
}

void adcgs_find_light(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *f, double begins, int is_evened)
{
    static const char *const what[ADCGS_LIGHTS][2] = {{"bright", "exposure"},
                                                      {"red relative to green", "white balance"},
                                                      {"blue relative to green", "white balance"}};
    char more[64], question[80];
    snprintf(question, sizeof question, "check %s and light (--set exposure_step_compensation)", what[f->light][1]);
    append(findings, ADCGS_FINDING_LIGHT,
           adcgs_path("%s: at %.3f s the images of %s become %.2f times as %s%s: %s", short_name(scene, f->path), begins + f->to,
                      f->cameras == f->of && f->of > 1 ? "all cameras" : "its camera", f->size, what[f->light][0],
                      f->cameras == f->of ? "" : others(more, ", and those of", f),
                      is_evened ? "this and all other steps of light are evened out" : question));
}

void adcgs_find_clock(adcgs_findings *findings, const adcgs_scene *scene, const adcgs_fault *f)
{
    char more[64];
    append(findings, ADCGS_FINDING_CLOCK,
           adcgs_path("%s: its camera appears %u frame%s %s than others%s: check synchronisation", short_name(scene, f->path),
                      f->count, f->count > 1 ? "s" : "", f->size > 0 ? "later" : "earlier", others(more, "; also", f)));
}
