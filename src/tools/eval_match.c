/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Whether a stream may have been made of a scene. What differs is worth a word:
 * figures would be right, and mean nothing.
 */
#include "config.h"

#include "tools/eval_match.h"

#include <math.h>

#define PLACE_WITHIN 1e-3 /* scene units, and elements of rotations: streams keep poses in binary32, scenes in decimal digits */
#define LENS_WITHIN 0.02  /* of the focal length per width: pictures may have been reduced */
#define PSNR_OF_NOTHING 10.0

static int is_same_place(const adcgs_camera *a, const adcgs_camera *b, double scale)
{
    for (int i = 0; i < 12; i++)
        if (!(fabs(a->cam_to_world[i] - b->cam_to_world[i]) <= PLACE_WITHIN * (i % 4 == 3 ? scale : 1.0)))
            return 0;
    return 1;
}

static int is_same_lens(const adcgs_camera *a, const adcgs_camera *b)
{
    const double x = b->fx * a->width / (a->fx * b->width), y = b->fy * a->height / (a->fy * b->height);
    return fabs(x - 1.0) <= LENS_WITHIN && fabs(y - 1.0) <= LENS_WITHIN;
}

/** 0: no view of the scene was taken from where the camera is; 1: one was, through another lens; 2: through the same. */
static int find_camera(const adcgs_camera *camera, const adcgs_scene *scene, double scale)
{
    int found = 0;
    for (int split = 0; split < ADCGS_SPLITS; split++)
        for (uint32_t i = 0; i < scene->n_views[split] && found < 2; i++) {
            const adcgs_camera *const other = &scene->views[split][i].camera;
            if (is_same_place(camera, other, scale))
                found = is_same_lens(camera, other) ? 2 : 1;
        }
    return found;
}

static adcgs_status match_cameras(const adcgs_cli *cli, const char *file, const adcgs_decoder *decoder, const adcgs_info *info,
                                  const char *scene_name, const adcgs_scene *scene)
{
    int n[3] = {0, 0, 0};
    for (int i = 0; i < info->cameras; i++) {
        adcgs_camera camera;
        ADCGS_TRY(adcgs_get_camera(decoder, i, &camera));
        n[find_camera(&camera, scene, info->scene_scale)]++;
    }
    if (2 * n[0] > info->cameras)
        adcgs_cli_note(cli, "%s: %d of its %d cameras are none of %s: was it made of another scene?", file, n[0], info->cameras,
                       scene_name);
    else if (2 * n[1] > info->cameras)
        adcgs_cli_note(cli, "%s: %d of its %d cameras have other lenses in %s: was it made of other pictures?", file, n[1],
                       info->cameras, scene_name);
    return ADCGS_OK;
}

static adcgs_status match_times(const adcgs_cli *cli, const char *file, const adcgs_info *info, const char *scene_name,
                                const adcgs_scene *scene, adcgs_split split, adcgs_error *error)
{
    const double frame = 1.0 / info->frame_rate;
    const uint32_t n = scene->n_views[split];
    uint32_t outside = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double time = scene->views[split][i].time;
        outside += time > info->time_end + frame || time < info->time_start - frame;
    }
    if (outside && outside == n)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%.80s lasts from %g to %g s, and no %s view of %.80s is of that time: "
                          "another scene, or other --frames", file, info->time_start, info->time_end, adcgs_split_name(split), scene_name);
    if (outside)
        adcgs_cli_note(cli, "%s: lasts from %g to %g s, but %u of the %u %s views of %s are not of that time: other --frames?",
                       file, info->time_start, info->time_end, outside, n, adcgs_split_name(split), scene_name);
    return ADCGS_OK;
}

adcgs_status adcgs_eval_match(const adcgs_cli *cli, const char *file, const adcgs_decoder *decoder, const char *scene_name,
                              const adcgs_scene *scene, adcgs_split split, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(decoder, &info));
    ADCGS_TRY(match_times(cli, file, &info, scene_name, scene, split, error));
    return match_cameras(cli, file, decoder, &info, scene_name, scene);
}

void adcgs_eval_match_pictures(const adcgs_cli *cli, const char *file, const char *scene_name,
                               const adcgs_evaluation *evaluation)
{
    if (evaluation->psnr < PSNR_OF_NOTHING)
        adcgs_cli_note(cli, "%s: its views are nothing like the pictures of %s (%.1f dB): was it made of another scene?", file,
                       scene_name, evaluation->psnr);
}
