/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Checks whether a stream was made of a scene. A mismatch is worth a warning, since the figures would be correct but meaningless.
 */
#include "config.h"

#include "apps/eval/eval_match.h"

#include "system/text.h"

#include <adcgs/decoder.h>

#include <math.h>

#define PLACE_WITHIN 1e-3 /* scene units, and elements of rotations: streams store poses in binary32, scenes in decimal digits */
/* Of focal length per width: images may have been reduced; chosen by hand, not measured. */
#define LENS_WITHIN 0.02
#define PSNR_OF_NOTHING 10.0 /* dB below which a stream shows another scene; chosen by hand, not measured */

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

/** Returns 0 if no view of the scene has the camera's pose, 1 if one has, with another lens, 2 if the lens is the same. */
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

static void match_cameras(const adcgs_match *m, const adcgs_info *info)
{
    int n[3] = {0, 0, 0};
    adcgs_camera camera;
    for (int i = 0; i < info->cameras; i++)
        if (adcgs_get_camera(m->decoder, i, &camera, NULL) == ADCGS_OK)
            n[find_camera(&camera, m->scene, info->scene_scale)]++;
    if (2 * n[0] > info->cameras)
        adcgs_cli_note(m->cli, "%s: %d of its %d camera%s %s not in %s: check that it was made of this scene", m->file, n[0],
                       info->cameras, adcgs_s((uint64_t)info->cameras), n[0] == 1 ? "is" : "are", m->scene_name);
    else if (2 * n[1] > info->cameras)
        adcgs_cli_note(m->cli,
                       "%s: %d of its %d camera%s %s other lenses in %s: check that it was made of these "
                       "images",
                       m->file, n[1], info->cameras, adcgs_s((uint64_t)info->cameras), n[1] == 1 ? "has" : "have", m->scene_name);
}

/** Counts the views of the split outside the stream's time, with a tolerance of one frame. */
static uint32_t count_outside(const adcgs_match *m, const adcgs_info *info)
{
    const double frame = 1.0 / info->frame_rate;
    uint32_t outside = 0;
    for (uint32_t i = 0; i < m->scene->n_views[m->split]; i++) {
        const double time = m->scene->views[m->split][i].time;
        outside += time > info->time_end + frame || time < info->time_start - frame;
    }
    return outside;
}

adcgs_status adcgs_match_check(const adcgs_match *m, adcgs_error *error)
{
    adcgs_info info;
    ADCGS_TRY(adcgs_get_info(m->decoder, &info, sizeof info, error));
    const uint32_t outside = count_outside(m, &info);
    if (outside && outside == m->scene->n_views[m->split])
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%.80s lasts from %g to %g s, and no %s view of %.80s lies in that time: give its scene, or its "
                          "--frames",
                          m->file, info.time_start, info.time_end, adcgs_split_name(m->split), m->scene_name);
    return ADCGS_OK;
}

void adcgs_match_report(const adcgs_match *m, const adcgs_evaluation *evaluation)
{
    adcgs_info info;
    if (adcgs_get_info(m->decoder, &info, sizeof info, NULL) != ADCGS_OK)
        return;
    const uint32_t outside = count_outside(m, &info);
    if (outside)
        adcgs_cli_note(m->cli, "%s: lasts from %g to %g s, but %u of the %u %s views of %s lie outside that time: check --frames",
                       m->file, info.time_start, info.time_end, outside, m->scene->n_views[m->split], adcgs_split_name(m->split),
                       m->scene_name);
    match_cameras(m, &info);
    if (evaluation->psnr < PSNR_OF_NOTHING)
        adcgs_cli_note(m->cli, "%s: its views are nothing like the images of %s (%.1f dB): check that it was made of this scene",
                       m->file, m->scene_name, evaluation->psnr);
}
