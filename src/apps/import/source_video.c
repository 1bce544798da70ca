/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Selects the video frames for COLMAP. */
#include "config.h"

#include "apps/import/source_images.h"

#include "media/video/video.h"
#include "media/listing.h"
#include "system/text.h"

#include <math.h>
#include <stdlib.h>

/* Chosen by hand, not measured. */
#define MOMENTS 3 /* frame times of fixed cameras: one time may have too few features to find the poses */

/** Adds a camera for an open video. */
static adcgs_status add_camera(adcgs_source_images *sources, const char *path, const adcgs_video *video,
                               const adcgs_import_options *options, adcgs_error *error)
{
    const adcgs_video_info *info = adcgs_video_get_info(video);
    char stem[256];
    if (info->round)
        return adcgs_fail(
            error, ADCGS_ERR_UNSUPPORTED,
            "%.100s: a 360-degree video (%.20s), expected one of a plain lens: cut flat views from it, as by ffmpeg "
            "-i VIDEO -vf v360=e:flat:h_fov=90:v_fov=60 flat.mp4",
            path, info->round);
    sources->hdr = info->hdr ? info->hdr : sources->hdr;
    adcgs_stem(stem, sizeof stem, path);
    adcgs_source_image_camera *camera = adcgs_source_images_add_camera(sources, stem, error);
    if (!camera)
        return error->status;
    if (sources->kind == ADCGS_FOOTAGE_RIG && !options->own_lens) /* cameras of a rig are usually of one type */
        snprintf(camera->folder, sizeof camera->folder, "lens-%dx%d", info->width, info->height);
    camera->frames = info->frames;
    camera->rate = info->rate;
    camera->has_sound = info->has_sound;
    camera->start = info->start;
    camera->video = strdup(path);
    return camera->video ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

/** Adds a frame of the last camera. */
static adcgs_status add_frame(adcgs_source_images *sources, const adcgs_video *video, int64_t frame, adcgs_error *error)
{
    char stem[2 * ADCGS_SOURCE_IMAGE_NAME];
    const uint32_t camera = sources->n_cameras - 1;
    snprintf(stem, sizeof stem, "%.40s_%06lld", sources->cameras[camera].name, (long long)frame);
    adcgs_source_image *source = adcgs_source_images_add(sources, camera, stem, error);
    if (!source)
        return error->status;
    strcpy(source->end, "jpg");
    source->frame = frame;
    source->time = adcgs_video_time(video, frame);
    return ADCGS_OK;
}

/** Adds at most options->frames frames: the first one and others at equal steps. */
static adcgs_status add_frames(adcgs_source_images *sources, const char *path, const adcgs_video *video,
                               const adcgs_import_options *options, adcgs_error *error)
{
    const adcgs_video_info *info = adcgs_video_get_info(video);
    const int64_t step = (info->frames + options->frames - 1) / options->frames;
    ADCGS_TRY(add_camera(sources, path, video, options, error));
    for (int64_t frame = 0; frame < info->frames; frame += step)
        ADCGS_TRY(add_frame(sources, video, frame, error));
    sources->rate = adcgs_fps_divide(info->rate, step);
    return sources->n >= 3 ? ADCGS_OK
                           : adcgs_fail(error, ADCGS_ERR_DATA, "%s: %u frame%s, expected at least three", path, sources->n,
                                        adcgs_s(sources->n));
}

adcgs_status adcgs_source_images_video(adcgs_source_images *sources, const char *path, const adcgs_import_options *options,
                                       adcgs_error *error)
{
    adcgs_video *video;
    sources->kind = ADCGS_FOOTAGE_FILM;
    ADCGS_TRY(adcgs_video_open(&video, path, error));
    const adcgs_status status = add_frames(sources, path, video, options, error);
    adcgs_video_close(&video);
    return status;
}

/** Adds frames at times that all cameras share, if the videos are as long as the first. */
static adcgs_status add_synchronous_frames(adcgs_source_images *sources, const char *path, const adcgs_video *video,
                                           const adcgs_import_options *options, adcgs_error *error)
{
    const adcgs_video_info *info = adcgs_video_get_info(video);
    ADCGS_TRY(add_camera(sources, path, video, options, error));
    const adcgs_source_image_camera *first = &sources->cameras[0];
    if (info->frames != first->frames || fabs(adcgs_fps_value(info->rate) / adcgs_fps_value(first->rate) - 1.0) > 0.001)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%s: %lld frames at %.6g per second, but %s has %lld at %.6g: expected "
                          "videos that begin and end together",
                          path, (long long)info->frames, adcgs_fps_value(info->rate), first->video, (long long)first->frames,
                          adcgs_fps_value(first->rate));
    for (int64_t m = 0, last = -1; m < MOMENTS; m++) {
        const int64_t frame = m * (info->frames - 1) / (MOMENTS - 1);
        if (frame != last)
            ADCGS_TRY(add_frame(sources, video, frame, error));
        last = frame;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_source_images_rig(adcgs_source_images *sources, const adcgs_import_options *options, adcgs_progress *progress,
                                     adcgs_error *error)
{
    char *const *const paths = options->inputs;
    const int n = options->n_inputs;
    sources->kind = ADCGS_FOOTAGE_RIG;
    for (int i = 0; i < n; i++) {
        adcgs_video *video;
        adcgs_progress_show(progress, "scanning  %6d/%d videos", i, n);
        ADCGS_TRY(adcgs_video_open(&video, paths[i], error));
        const adcgs_status status = add_synchronous_frames(sources, paths[i], video, options, error);
        adcgs_video_close(&video);
        ADCGS_TRY(status);
    }
    sources->rate = sources->cameras[0].rate;
    return ADCGS_OK;
}
