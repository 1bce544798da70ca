/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writes the scene file and its points. doc/scene-file.md describes the fields. */
#include "config.h"

#include "apps/import/scene_write.h"

#include "apps/import/scene_sound.h"
#include "media/points/points.h"
#include "system/atomic.h"
#include "system/extension.h"
#include "system/json.h"
#include "system/paths.h"

#include <stdlib.h>

#define DIGITS 12 /* significant digits of numbers: far more than the precision of any pose; chosen by hand, not measured */

static void write_pose(adcgs_json *json, const double pose[12])
{
    adcgs_json_open(json, "camera_to_world", '[');
    for (int row = 0; row < 3; row++) {
        adcgs_json_open(json, NULL, '[');
        for (int i = 0; i < 4; i++)
            adcgs_json_real(json, NULL, pose[4 * row + i]);
        adcgs_json_close(json);
    }
    adcgs_json_close(json);
}

/** Omits zero, the default. */
static void write_number(adcgs_json *json, const char *name, double value)
{
    if (value != 0.0)
        adcgs_json_real(json, name, value);
}

static void write_lens(adcgs_json *json, const adcgs_lens *lens)
{
    static const char *const radial[] = {"k1", "k2", "k3", "k4", "k5", "k6"}, *const tangential[] = {"p1", "p2"};
    adcgs_json_int(json, "width", lens->width);
    adcgs_json_int(json, "height", lens->height);
    adcgs_json_real(json, "fx", lens->fx);
    adcgs_json_real(json, "fy", lens->fy);
    adcgs_json_real(json, "cx", lens->cx);
    adcgs_json_real(json, "cy", lens->cy);
    if (lens->is_fisheye)
        adcgs_json_string(json, "lens", "fisheye");
    for (size_t i = 0; i < ADCGS_COUNTOF(radial); i++)
        write_number(json, radial[i], lens->k[i]);
    for (size_t i = 0; i < ADCGS_COUNTOF(tangential); i++)
        write_number(json, tangential[i], lens->p[i]);
}

/** File names are relative to the folder. */
static adcgs_status write_file(adcgs_json *json, const char *field, const adcgs_import_job *job, char *name)
{
    if (!name)
        return adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", job->folder);
    if (strcmp(field, "masks") || adcgs_is_there_at("%s/%s", job->folder, name))
        adcgs_json_string(json, field, name);
    free(name);
    return ADCGS_OK;
}

static adcgs_status write_footage(adcgs_json *json, const adcgs_import_job *job, const adcgs_posed *posed)
{
    const adcgs_source_image *source = &job->sources.list[posed->source];
    const adcgs_source_image_camera *camera = &job->sources.cameras[source->camera];
    if (job->sources.kind == ADCGS_FOOTAGE_RIG) {
        ADCGS_TRY(write_file(json, "video", job, adcgs_path("videos/%s.%s", camera->name, adcgs_extension(camera->video))));
        return write_file(json, "masks", job, adcgs_path("masks/%s.png", camera->name));
    }
    ADCGS_TRY(write_file(json, "images", job, adcgs_path("images/%s/%s.%s", camera->folder, source->stem, source->end)));
    write_number(json, "time_offset", source->time);
    return write_file(json, "masks", job, adcgs_path("masks/%s/%s.%s.png", camera->folder, source->stem, source->end));
}

static adcgs_status write_camera(adcgs_json *json, const adcgs_import_job *job, const adcgs_posed *posed)
{
    const adcgs_source_image *source = &job->sources.list[posed->source];
    adcgs_json_open(json, NULL, '{');
    adcgs_json_string(json, "name",
                      job->sources.kind == ADCGS_FOOTAGE_RIG ? job->sources.cameras[source->camera].name : source->stem);
    ADCGS_TRY(write_footage(json, job, posed));
    if (posed->is_test)
        adcgs_json_string(json, "split", "test");
    write_lens(json, posed->lens);
    write_pose(json, posed->cam_to_world);
    adcgs_json_close(json);
    return ADCGS_OK;
}

static adcgs_status fill(adcgs_json *json, const adcgs_poses *poses, const adcgs_import_job *job)
{
    char rate[32];
    adcgs_json_open(json, NULL, '{');
    adcgs_json_int(json, "adcgs_scene", 1);
    if (job->sources.rate.den) {
        snprintf(rate, sizeof rate, "%u/%u", job->sources.rate.num, job->sources.rate.den);
        adcgs_json_string(json, "frame_rate", rate);
    }
    adcgs_json_string(json, "up", "z");
    if (poses->model.points.n)
        adcgs_json_string(json, "points", "points.ply");
    if (job->report->has_sound) {
        adcgs_json_string(json, "sound", ADCGS_IMPORT_SOUND);
        write_number(json, "sound_offset", adcgs_import_begin(poses, job));
    }
    adcgs_json_open(json, "cameras", '[');
    for (uint32_t i = 0; i < poses->n; i++)
        ADCGS_TRY(write_camera(json, job, &poses->posed[i]));
    adcgs_json_close(json);
    adcgs_json_close(json);
    return ADCGS_OK;
}

/** Writes the scene file. adcgs_json_write() clears the value that is built. */
static adcgs_status write_json(const char *path, const adcgs_poses *poses, const adcgs_import_job *job)
{
    adcgs_json json;
    adcgs_atomic out;
    ADCGS_TRY(adcgs_atomic_open(&out, path, job->error));
    adcgs_json_init(&json);
    json.digits = DIGITS;
    adcgs_status status = fill(&json, poses, job);
    if (status == ADCGS_OK)
        status = adcgs_json_write(&json, out.file, path, job->error);
    else
        adcgs_json_clear(&json);
    if (status == ADCGS_OK)
        return adcgs_atomic_commit(&out, job->error);
    adcgs_atomic_abort(&out);
    return status;
}

adcgs_status adcgs_import_write(const adcgs_poses *poses, const adcgs_import_job *job)
{
    char *scene, *points;
    ADCGS_TRY(adcgs_import_path(&scene, job, "scene.json"));
    adcgs_status status = adcgs_import_path(&points, job, "points.ply");
    if (status == ADCGS_OK && poses->model.points.n)
        status = adcgs_ply_write(&poses->model.points, points, job->error);
    if (status == ADCGS_OK)
        status = write_json(scene, poses, job);
    free(scene);
    free(points);
    return status;
}
