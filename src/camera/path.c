/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Which frames to render. */
#include "config.h"

#include "camera/path.h"

#include "camera/rotation.h"
#include "cli/cli.h"

#include <math.h>

#define FULL_TURN 6.283185307179586

adcgs_status adcgs_shots_rendered(const adcgs_camera *camera, adcgs_status status, adcgs_error *error)
{
    static const char general[] = "camera: ";
    if (status != ADCGS_ERR_USAGE)
        return status;
    const adcgs_error why = *error;
    const size_t skip = strncmp(why.text, general, sizeof general - 1) ? 0 : sizeof general - 1;
    return adcgs_fail(error, ADCGS_ERR_DATA, "camera \"%s\": %.150s", camera->name, why.text + skip);
}

/** Times are given in few digits, and the last frame lasts, too: a frame more or less is no mistake. */
static int is_outside(const adcgs_info *info, double begin, double end)
{
    const double frame = 1.0 / info->frame_rate;
    return begin > info->time_end + frame || end < info->time_start - frame;
}

adcgs_status adcgs_shots_check_times(const adcgs_info *info, const adcgs_shots_request *request, adcgs_error *error)
{
    if (request->has_times && is_outside(info, request->begin, request->end))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--time %g%s: the stream lasts from %g to %g s",
                          request->begin > info->time_end ? request->begin : request->end,
                          request->begin == request->end     ? ""
                          : request->begin > info->time_end ? " and later"
                                                            : " and earlier",
                          info->time_start, info->time_end);
    return ADCGS_OK;
}

/** Turn a camera about the axis through the scene's centre. */
static void turn_camera(adcgs_camera *camera, const adcgs_info *info, const double up[3], double angle)
{
    double *m = camera->cam_to_world;
    for (int c = 0; c < 4; c++) {
        double v[3];
        for (int i = 0; i < 3; i++)
            v[i] = m[4 * i + c] - (c == 3 ? info->scene_origin[i] : 0.0);
        adcgs_v3_turn(up, angle, v);
        for (int i = 0; i < 3; i++)
            m[4 * i + c] = v[i] + (c == 3 ? info->scene_origin[i] : 0.0);
    }
}

static adcgs_status find_stored(const adcgs_decoder *decoder, const adcgs_info *info, const char *wanted, adcgs_camera *camera,
                                adcgs_error *error)
{
    int index;
    for (int i = 0; i < info->cameras; i++) {
        ADCGS_TRY(adcgs_get_camera(decoder, i, camera));
        if (!strcmp(camera->name, wanted))
            return ADCGS_OK;
    }
    if (!info->cameras)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--camera %s: the stream stores no cameras; try --camera orbit", wanted);
    if (adcgs_parse_int(wanted, 0, info->cameras - 1, &index))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--camera %s: neither a stored camera's name nor an index from 0 to %d", wanted,
                          info->cameras - 1);
    return adcgs_get_camera(decoder, index, camera);
}

adcgs_status adcgs_shots_times(adcgs_shots *out, const adcgs_info *info, const adcgs_shots_request *request,
                               adcgs_shots_motion motion, adcgs_error *error)
{
    const double begin = request->has_times ? request->begin : info->time_start;
    const double end = request->has_times ? request->end : info->time_end;
    const int is_frozen = motion == ADCGS_SHOTS_FROZEN;
    if (is_frozen && request->has_times && begin != end)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--time: time stands still with --camera %s, expected one moment",
                          request->camera);
    const int is_still = is_frozen || (!request->has_times && motion == ADCGS_SHOTS_MOVING && begin == end);
    const double n = is_still ? ADCGS_SHOTS_SECONDS * info->frame_rate : (end - begin) * info->frame_rate + 1.0;
    ADCGS_TRY(adcgs_shots_alloc(out, fmax(floor(n + 1e-6), is_still), request->has_times ? NULL : "the stream", error));
    for (int i = 0; i < out->n; i++)
        out->shot[i].time = is_still ? begin : begin + i / info->frame_rate;
    return ADCGS_OK;
}

#ifndef HAVE_ENCODER
adcgs_status adcgs_shots_read_path(adcgs_shots *out, const adcgs_info *info, const adcgs_shots_request *request,
                                   double near_plane, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build reads no camera paths", request->camera);
}

adcgs_status adcgs_shots_write_path(const adcgs_decoder *decoder, const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build writes no camera paths", path);
}
#endif

static int is_path(const char *name)
{
    const size_t n = name ? strlen(name) : 0;
    return n > 5 && !strcmp(name + n - 5, ".json");
}

static int is_named(const adcgs_shots_request *request, const char *name)
{
    return request->camera && !strcmp(request->camera, name);
}

static void make_orbit(adcgs_shots *out, const adcgs_rig *rig, const adcgs_info *info, const double up[3])
{
    for (int i = 0; i < out->n; i++) {
        out->shot[i].camera = rig->cameras[0];
        turn_camera(&out->shot[i].camera, info, up, FULL_TURN * i / out->n);
    }
}

/** Paths that begin at the stored cameras, or at one of our own. */
static adcgs_status make_from_rig(adcgs_shots *out, const adcgs_decoder *decoder, const adcgs_info *info,
                                  const adcgs_shots_request *request, adcgs_error *error)
{
    const int is_bullet = is_named(request, "bullet");
    adcgs_rig rig;
    double up[3];
    adcgs_find_up(info, up);
    ADCGS_TRY(adcgs_shots_times(out, info, request, is_bullet ? ADCGS_SHOTS_FROZEN : ADCGS_SHOTS_MOVING, error));
    adcgs_status status = adcgs_rig_init(&rig, decoder, info, up, error);
    if (status == ADCGS_OK && is_bullet && rig.n >= 3)
        status = adcgs_rig_bullet(&rig, out, error);
    else if (status == ADCGS_OK && is_named(request, "spiral"))
        adcgs_rig_spiral(&rig, out);
    else if (status == ADCGS_OK)
        make_orbit(out, &rig, info, up);
    adcgs_rig_clear(&rig);
    return status;
}

static adcgs_status make_from_camera(adcgs_shots *out, const adcgs_decoder *decoder, const adcgs_info *info,
                                     const adcgs_shots_request *request, adcgs_error *error)
{
    adcgs_camera camera;
    if (request->camera)
        ADCGS_TRY(find_stored(decoder, info, request->camera, &camera, error));
    else
        ADCGS_TRY(adcgs_get_camera(decoder, 0, &camera));
    ADCGS_TRY(adcgs_shots_times(out, info, request, ADCGS_SHOTS_FIXED, error));
    for (int i = 0; i < out->n; i++)
        out->shot[i].camera = camera;
    return ADCGS_OK;
}

static adcgs_status make_shots(adcgs_shots *out, const adcgs_decoder *decoder, const adcgs_info *info,
                               const adcgs_shots_request *request, adcgs_error *error)
{
    if (is_path(request->camera))
        return adcgs_shots_read_path(out, info, request, ADCGS_NEAR_PER_SCALE * info->scene_scale, error);
    if (is_named(request, "orbit") || is_named(request, "spiral") || is_named(request, "bullet") ||
        (!request->camera && !info->cameras))
        return make_from_rig(out, decoder, info, request, error);
    return make_from_camera(out, decoder, info, request, error);
}

adcgs_status adcgs_shots_make(adcgs_shots *out, const adcgs_decoder *decoder, const adcgs_shots_request *request,
                              adcgs_error *error)
{
    adcgs_info info;
    *out = (adcgs_shots){0};
    ADCGS_TRY(adcgs_get_info(decoder, &info));
    ADCGS_TRY(adcgs_shots_check_times(&info, request, error));
    const adcgs_status status = make_shots(out, decoder, &info, request, error);
    if (status != ADCGS_OK)
        adcgs_shots_free(out);
    if (!(out->frame_rate > 0.0)) /* paths may have one of their own */
        out->frame_rate = info.frame_rate;
    for (int i = 0; i < out->n; i++) {
        out->outside += info.time_start < info.time_end && is_outside(&info, out->shot[i].time, out->shot[i].time);
        if (request->size[0])
            adcgs_camera_fit(&out->shot[i].camera, request->size[0], request->size[1], request->fill);
    }
    return status;
}
