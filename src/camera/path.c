/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera paths: a camera and a time for each frame to render. */
#include "config.h"

#include "camera/path.h"

#include "camera/follow.h"
#include "camera/pivot.h"
#include "geometry/rotation.h"
#include "system/numbers.h"

#include <adcgs/decoder.h>

#include <math.h>
#include <stdlib.h>

#define FULL_TURN 6.283185307179586 /* radians; definition */

adcgs_status adcgs_camera_path_rendered(const adcgs_camera *camera, adcgs_status status, adcgs_error *error)
{
    static const char general[] = "camera: ";
    if (status != ADCGS_ERR_USAGE)
        return status;
    const adcgs_error why = *error;
    const size_t skip = strncmp(why.text, general, sizeof general - 1) ? 0 : sizeof general - 1;
    return adcgs_fail(error, ADCGS_ERR_DATA, "camera \"%s\": %.150s", camera->name, why.text + skip);
}

/** Allow one frame of tolerance: times are given with few digits, and the last frame lasts, too. */
static int is_outside(const adcgs_info *info, double begin, double end)
{
    const double frame = 1.0 / info->frame_rate;
    return begin > info->time_end + frame || end < info->time_start - frame;
}

adcgs_status adcgs_camera_path_check_times(const adcgs_info *info, const adcgs_camera_path_request *request, adcgs_error *error)
{
    if (request->has_times && is_outside(info, request->begin, request->end))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--time %g%s: the stream lasts from %g to %g s",
                          request->begin > info->time_end ? request->begin : request->end,
                          request->begin == request->end    ? ""
                          : request->begin > info->time_end ? " and later"
                                                            : " and earlier",
                          info->time_start, info->time_end);
    return ADCGS_OK;
}

/** Turn a camera about the axis through a point. */
static void turn_camera(adcgs_camera *camera, const double centre[3], const double up[3], double angle)
{
    double *m = camera->cam_to_world;
    for (int c = 0; c < 4; c++) {
        double v[3];
        for (int i = 0; i < 3; i++)
            v[i] = m[4 * i + c] - (c == 3 ? centre[i] : 0.0);
        adcgs_rotate_about(up, angle, v);
        for (int i = 0; i < 3; i++)
            m[4 * i + c] = v[i] + (c == 3 ? centre[i] : 0.0);
    }
}

adcgs_status adcgs_camera_find_stored(int *index, const adcgs_decoder *decoder, const adcgs_info *info, const char *wanted,
                                      const char *advice, adcgs_error *error)
{
    adcgs_camera camera;
    for (*index = 0; *index < info->cameras; ++*index) {
        ADCGS_TRY(adcgs_get_camera(decoder, *index, &camera, error));
        if (!strcmp(camera.name, wanted))
            return ADCGS_OK;
    }
    if (!info->cameras)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--camera %s: the stream stores no cameras%s", wanted, advice);
    if (adcgs_parse_int(wanted, 0, info->cameras - 1, index))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--camera %s: neither a stored camera's name nor an index from 0 to %d", wanted,
                          info->cameras - 1);
    return ADCGS_OK;
}

adcgs_status adcgs_camera_path_times(adcgs_camera_path *out, const adcgs_info *info, const adcgs_camera_path_request *request,
                                     adcgs_camera_path_motion motion, adcgs_error *error)
{
    const double begin = request->has_times ? request->begin : info->time_start;
    const double end = request->has_times ? request->end : info->time_end;
    const int is_frozen = motion == ADCGS_PATH_FROZEN;
    if (is_frozen && request->has_times && begin != end)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--time: time is frozen with --camera %s, expected a single time",
                          request->camera);
    const int is_still = is_frozen || (!request->has_times && motion == ADCGS_PATH_MOVING && begin == end);
    const double n = is_still ? ADCGS_PATH_SECONDS * info->frame_rate : (end - begin) * info->frame_rate + 1.0;
    ADCGS_TRY(adcgs_camera_path_alloc(out, fmax(floor(n + 1e-6), is_still), request->has_times ? NULL : "the stream", error));
    for (int i = 0; i < out->n; i++)
        out->frame[i].time = is_still ? begin : begin + i / info->frame_rate;
    return ADCGS_OK;
}

#ifndef HAVE_ENCODER
adcgs_status adcgs_camera_path_read(adcgs_camera_path *out, const adcgs_info *info, const adcgs_camera_path_request *request,
                                    const adcgs_camera *like, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build reads no camera paths", request->camera);
}

adcgs_status adcgs_camera_path_write(const adcgs_decoder *decoder, const adcgs_camera_path *frames, adcgs_rotation_order order,
                                     const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build writes no camera paths", path);
}
#endif

static int is_path(const char *name)
{
    static const char *const endings[] = {"json", "chan", "usda", "usd", "usdc"};
    const char *const dot = name ? strrchr(name, '.') : NULL;
    for (size_t i = 0; i < ADCGS_COUNTOF(endings) && dot && dot > name; i++)
        if (!strcmp(dot + 1, endings[i]))
            return 1;
    return 0;
}

static int is_named(const adcgs_camera_path_request *request, const char *name)
{
    return request->camera && !strcmp(request->camera, name);
}

/** Turns the first camera about the point in the middle of its image, or without one about the scene's centre. */
static void make_orbit(adcgs_camera_path *out, const adcgs_rig *rig, adcgs_decoder *decoder, const adcgs_info *info,
                       const double up[3])
{
    double centre[3];
    if (!out->n || adcgs_pivot_find(centre, decoder, &rig->cameras[0], out->frame[0].time, 0.5, 0.5, NULL) != ADCGS_OK)
        memcpy(centre, info->scene_origin, sizeof centre);
    for (int i = 0; i < out->n; i++) {
        out->frame[i].camera = rig->cameras[0];
        turn_camera(&out->frame[i].camera, centre, up, FULL_TURN * i / out->n);
    }
}

/** Paths based on the stored cameras, or on a default one. */
static adcgs_status make_from_rig(adcgs_camera_path *out, adcgs_decoder *decoder, const adcgs_info *info,
                                  const adcgs_camera_path_request *request, adcgs_error *error)
{
    const int is_bullet = is_named(request, "bullet");
    adcgs_rig rig;
    double up[3];
    adcgs_find_up(info, up);
    ADCGS_TRY(adcgs_camera_path_times(out, info, request, is_bullet ? ADCGS_PATH_FROZEN : ADCGS_PATH_MOVING, error));
    adcgs_status status = adcgs_rig_init(&rig, decoder, info, up, error);
    if (status == ADCGS_OK && is_bullet && rig.n >= 3)
        status = adcgs_rig_bullet(&rig, out, error);
    else if (status == ADCGS_OK && is_named(request, "spiral"))
        adcgs_rig_spiral(&rig, out);
    else if (status == ADCGS_OK)
        make_orbit(out, &rig, decoder, info, up);
    adcgs_rig_clear(&rig);
    return status;
}

/** The camera of a filmed path at each time. */
static adcgs_status make_from_film(adcgs_camera_path *out, const adcgs_follow *follow, const adcgs_info *info,
                                   const adcgs_camera_path_request *request, adcgs_error *error)
{
    ADCGS_TRY(adcgs_camera_path_times(out, info, request, ADCGS_PATH_FIXED, error));
    for (int i = 0; i < out->n; i++)
        adcgs_follow_at(follow, out->frame[i].time, &out->frame[i].camera);
    return ADCGS_OK;
}

/** The first filmed path; follow->spline.n is 0 if the stream has none. */
static adcgs_status find_film(adcgs_follow *follow, const adcgs_decoder *decoder, const adcgs_info *info, adcgs_error *error)
{
    adcgs_filmed_camera *cameras;
    *follow = (adcgs_follow){.begin = 0};
    adcgs_status status = adcgs_filmed_cameras_get(&cameras, decoder, info, error);
    if (status == ADCGS_OK)
        status = adcgs_follow_init(follow, cameras, info->cameras, 0, error);
    free(cameras);
    return status;
}

/** Follows the filmed path if it is requested, or by default if there is one; *done: whether it does. */
static adcgs_status try_film(adcgs_camera_path *out, const adcgs_decoder *decoder, const adcgs_info *info,
                             const adcgs_camera_path_request *request, int *done, adcgs_error *error)
{
    const int wanted = is_named(request, "follow");
    adcgs_follow follow;
    *done = 0;
    if (request->camera && !wanted)
        return ADCGS_OK;
    ADCGS_TRY(find_film(&follow, decoder, info, error));
    adcgs_status status = ADCGS_OK;
    if (follow.spline.n) {
        status = make_from_film(out, &follow, info, request, error);
        *done = 1;
    } else if (wanted)
        status = adcgs_fail(error, ADCGS_ERR_USAGE,
                            "--camera follow: the stream stores no filmed path, only %d camera%s; try --camera 0 or orbit",
                            info->cameras, info->cameras == 1 ? "" : "s");
    adcgs_follow_clear(&follow);
    return status;
}

static adcgs_status make_from_camera(adcgs_camera_path *out, const adcgs_decoder *decoder, const adcgs_info *info,
                                     const adcgs_camera_path_request *request, adcgs_error *error)
{
    adcgs_camera camera;
    int index = 0;
    if (request->camera)
        ADCGS_TRY(adcgs_camera_find_stored(&index, decoder, info, request->camera, "; try --camera orbit", error));
    ADCGS_TRY(adcgs_get_camera(decoder, index, &camera, error));
    ADCGS_TRY(adcgs_camera_path_times(out, info, request, ADCGS_PATH_FIXED, error));
    for (int i = 0; i < out->n; i++)
        out->frame[i].camera = camera;
    return ADCGS_OK;
}

/** A path from a file; missing values are those of the first stored camera, or of a default one. */
static adcgs_status make_from_file(adcgs_camera_path *out, const adcgs_decoder *decoder, const adcgs_info *info,
                                   const adcgs_camera_path_request *request, adcgs_error *error)
{
    adcgs_camera like;
    double up[3];
    adcgs_find_up(info, up);
    adcgs_camera_path_default(&like, info, up);
    if (info->cameras)
        ADCGS_TRY(adcgs_get_camera(decoder, 0, &like, error));
    like.near_plane = ADCGS_NEAR_PER_SCALE * info->scene_scale;
    return adcgs_camera_path_read(out, info, request, &like, error);
}

static adcgs_status make_shots(adcgs_camera_path *out, adcgs_decoder *decoder, const adcgs_info *info,
                               const adcgs_camera_path_request *request, adcgs_error *error)
{
    int done;
    ADCGS_TRY(try_film(out, decoder, info, request, &done, error));
    if (done)
        return ADCGS_OK;
    if (is_path(request->camera))
        return make_from_file(out, decoder, info, request, error);
    if (is_named(request, "orbit") || is_named(request, "spiral") || is_named(request, "bullet") ||
        (!request->camera && !info->cameras))
        return make_from_rig(out, decoder, info, request, error);
    return make_from_camera(out, decoder, info, request, error);
}

adcgs_status adcgs_camera_path_make(adcgs_camera_path *out, adcgs_decoder *decoder, const adcgs_camera_path_request *request,
                                    adcgs_error *error)
{
    adcgs_info info;
    *out = (adcgs_camera_path){0};
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    ADCGS_TRY(adcgs_camera_path_check_times(&info, request, error));
    const adcgs_status status = make_shots(out, decoder, &info, request, error);
    if (status != ADCGS_OK)
        adcgs_camera_path_free(out);
    if (!(out->frame_rate > 0.0)) /* paths may have their own */
        out->frame_rate = info.frame_rate;
    for (int i = 0; i < out->n; i++) {
        out->outside += info.time_start < info.time_end && is_outside(&info, out->frame[i].time, out->frame[i].time);
        if (request->size[0])
            adcgs_camera_fit(&out->frame[i].camera, request->size[0], request->size[1], request->fill);
    }
    return status;
}
