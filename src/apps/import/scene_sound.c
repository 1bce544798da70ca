/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The sound of a video, kept next to the scene. */
#include "config.h"

#include "apps/import/scene_sound.h"

#include "apps/import/child.h"
#include "system/interrupt.h"
#include "system/paths.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#define BIT_RATE "96k" /* of Opus: music in stereo; one channel needs less, and gets less */

double adcgs_import_begin(const adcgs_poses *poses, const adcgs_import_job *job)
{
    double begin = INFINITY;
    if (job->sources.kind == ADCGS_FOOTAGE_RIG) /* the scene has all frames of the videos */
        return 0.0;
    for (uint32_t i = 0; i < poses->n; i++)
        if (!poses->posed[i].is_test)
            begin = fmin(begin, job->sources.list[poses->posed[i].source].time);
    return isfinite(begin) ? begin : 0.0;
}

static int hear(void *user, const char *line)
{
    adcgs_import_report *report = user;
    if (*line)
        snprintf(report->sound_fault, sizeof report->sound_fault, "ffmpeg: %.180s", line);
    return adcgs_interrupted();
}

/**
 * Converts a part of a video's sound, which begins at a time of the file. Silence replaces samples that are missing at the
 * beginning. FFmpeg may open this file alone.
 */
static adcgs_status convert(adcgs_import_job *job, const char *video, const char *output, double from, double seconds, int *code)
{
    char filter[200], *const input = adcgs_path("file:%s", video), *const target = adcgs_path("file:%s", output);
    snprintf(filter, sizeof filter, "asetpts=PTS-(%.6f)/TB,aresample=async=1:first_pts=0,atrim=end=%.6f", from, seconds);
    const char *const words[] = {"ffmpeg",        "-nostdin", "-v",      "error",     "-y",   "-protocol_whitelist",
                                 "file",          "-copyts",  "-i",      input,       "-map", "0:a:0",
                                 "-af",           filter,     "-c:a",    "libopus",   "-b:a", BIT_RATE,
                                 "-map_metadata", "-1",       "-fflags", "+bitexact", "-f",   "ogg",
                                 target,          NULL};
    char *argv[ADCGS_COUNTOF(words)];
    memcpy(argv, words, sizeof argv); /* posix_spawnp() takes pointers to char but does not modify the characters */
    adcgs_progress_show(job->progress, "sound");
    const adcgs_status status = input && target ? adcgs_child_run(argv, NULL, hear, job->report, code, job->error)
                                                : adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", video);
    free(input);
    free(target);
    return status;
}

adcgs_status adcgs_import_sound(const adcgs_poses *poses, adcgs_import_job *job)
{
    const adcgs_source_image_camera *camera = job->sources.cameras, *const end = camera + job->sources.n_cameras;
    adcgs_import_report *const report = job->report;
    const double begin = adcgs_import_begin(poses, job);
    char *output;
    int code = 0;
    while (camera < end && !(camera->video && camera->has_sound))
        camera++;
    if (camera == end)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_import_path(&output, job, ADCGS_IMPORT_SOUND));
    const double length = (double)camera->frames / adcgs_fps_value(camera->rate) - begin;
    adcgs_status status = convert(job, camera->video, output, camera->start + begin, length, &code);
    if (status == ADCGS_ERR_UNSUPPORTED) {
        snprintf(report->sound_fault, sizeof report->sound_fault, "no program ffmpeg, which converts it");
        status = ADCGS_OK;
    }
    report->has_sound = status == ADCGS_OK && !code && !*report->sound_fault;
    if (!report->has_sound) {
        unlink(output);
        if (!*report->sound_fault)
            snprintf(report->sound_fault, sizeof report->sound_fault, "ffmpeg failed with exit code %d", code);
    }
    free(output);
    ADCGS_TRY(status);
    return adcgs_import_goes_on(job);
}
