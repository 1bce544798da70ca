/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Selects the video frames for COLMAP. */
#include "config.h"

#include "import/source_images.h"

#include "cli/text.h"
#include "io/video.h"
#include "layouts/listing.h"

#include <math.h>
#include <stdlib.h>

#define MOMENTS 3 /* frame times of fixed cameras: one time may have too few features to find the poses */

/** Adds a camera for an open video. */
static adcgs_status add_camera(adcgs_source_images *shots, const char *path, const adcgs_video *video,
                               const adcgs_import_options *options, adcgs_error *error)
{
    const adcgs_video_info *info = adcgs_video_get_info(video);
    char stem[256];
    adcgs_stem(stem, sizeof stem, path);
    adcgs_source_image_camera *camera = adcgs_source_images_add_camera(shots, stem, error);
    if (!camera)
        return error->status;
    if (shots->kind == ADCGS_FOOTAGE_RIG && !options->own_lens) /* cameras of a rig are usually of one type */
        snprintf(camera->folder, sizeof camera->folder, "lens-%dx%d", info->width, info->height);
    camera->frames = info->frames;
    camera->rate = info->rate;
    camera->video = strdup(path);
    return camera->video ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

/** Adds a frame of the last camera. */
static adcgs_status add_frame(adcgs_source_images *shots, const adcgs_video *video, int64_t frame, adcgs_error *error)
{
    char stem[2 * ADCGS_SOURCE_IMAGE_NAME];
    const uint32_t camera = shots->n_cameras - 1;
    snprintf(stem, sizeof stem, "%.40s_%06lld", shots->cameras[camera].name, (long long)frame);
    adcgs_source_image *shot = adcgs_source_images_add(shots, camera, stem, error);
    if (!shot)
        return error->status;
    strcpy(shot->end, "jpg");
    shot->frame = frame;
    shot->time = adcgs_video_time(video, frame);
    return ADCGS_OK;
}

/** Adds at most options->frames frames: the first one and others at equal steps. */
static adcgs_status add_frames(adcgs_source_images *shots, const char *path, const adcgs_video *video,
                               const adcgs_import_options *options, adcgs_error *error)
{
    const adcgs_video_info *info = adcgs_video_get_info(video);
    const int64_t step = (info->frames + options->frames - 1) / options->frames;
    ADCGS_TRY(add_camera(shots, path, video, options, error));
    for (int64_t frame = 0; frame < info->frames; frame += step)
        ADCGS_TRY(add_frame(shots, video, frame, error));
    shots->rate = adcgs_fps_divide(info->rate, step);
    return shots->n >= 3 ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_DATA, "%s: %u frame%s, expected at least three", path,
                                                 shots->n, adcgs_s(shots->n));
}

adcgs_status adcgs_source_images_video(adcgs_source_images *shots, const char *path, const adcgs_import_options *options,
                                       adcgs_error *error)
{
    adcgs_video *video;
    shots->kind = ADCGS_FOOTAGE_FILM;
    ADCGS_TRY(adcgs_video_open(&video, path, error));
    const adcgs_status status = add_frames(shots, path, video, options, error);
    adcgs_video_close(&video);
    return status;
}

/** Adds frames at times that all cameras share, if the videos are as long as the first. */
static adcgs_status add_moments(adcgs_source_images *shots, const char *path, const adcgs_video *video,
                                const adcgs_import_options *options, adcgs_error *error)
{
    const adcgs_video_info *info = adcgs_video_get_info(video);
    ADCGS_TRY(add_camera(shots, path, video, options, error));
    const adcgs_source_image_camera *first = &shots->cameras[0];
    if (info->frames != first->frames || fabs(adcgs_fps_value(info->rate) / adcgs_fps_value(first->rate) - 1.0) > 0.001)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %lld frames at %.6g per second, but %s has %lld at %.6g: expected "
                          "videos that begin and end together", path, (long long)info->frames, adcgs_fps_value(info->rate),
                          first->video, (long long)first->frames, adcgs_fps_value(first->rate));
    for (int64_t m = 0, last = -1; m < MOMENTS; m++) {
        const int64_t frame = m * (info->frames - 1) / (MOMENTS - 1);
        if (frame != last)
            ADCGS_TRY(add_frame(shots, video, frame, error));
        last = frame;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_source_images_rig(adcgs_source_images *shots, const adcgs_import_options *options, adcgs_progress *progress,
                                     adcgs_error *error)
{
    char *const *const paths = options->inputs;
    const int n = options->n_inputs;
    shots->kind = ADCGS_FOOTAGE_RIG;
    for (int i = 0; i < n; i++) {
        adcgs_video *video;
        adcgs_progress_show(progress, "scanning  %6d/%d videos", i, n);
        ADCGS_TRY(adcgs_video_open(&video, paths[i], error));
        const adcgs_status status = add_moments(shots, paths[i], video, options, error);
        adcgs_video_close(&video);
        ADCGS_TRY(status);
    }
    shots->rate = shots->cameras[0].rate;
    return ADCGS_OK;
}
