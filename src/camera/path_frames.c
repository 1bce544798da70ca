/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Memory of paths, and a default camera. */
#include "config.h"

#include "camera/path.h"

#include "geometry/rotation.h"

#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define ORBIT_DISTANCE 2.5   /* scene units */
#define ORBIT_ELEVATION 0.35 /* radians */
#define ORBIT_FOCAL 1.2      /* focal length per image width */

adcgs_status adcgs_camera_path_alloc(adcgs_camera_path *frames, double n, const char *who, adcgs_error *error)
{
    *frames = (adcgs_camera_path){0};
    if (!(n >= 1.0 && n <= ADCGS_PATH_FRAMES_MAX))
        return adcgs_fail(error, who ? ADCGS_ERR_DATA : ADCGS_ERR_USAGE, "%s%s%.0f frames requested, expected 1 to %d",
                          who ? who : "", who ? ": " : "", n, ADCGS_PATH_FRAMES_MAX);
    frames->frame = calloc((size_t)n, sizeof *frames->frame);
    if (!frames->frame)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %.0f frames", n);
    frames->n = (int)n;
    return ADCGS_OK;
}

void adcgs_camera_path_free(adcgs_camera_path *frames)
{
    free(frames->frame);
    *frames = (adcgs_camera_path){0};
}

/** A camera outside the scene, looking at its centre from slightly above. */
void adcgs_camera_path_default(adcgs_camera *camera, const adcgs_info *info, const double up[3])
{
    *camera = (adcgs_camera){.width = ADCGS_ORBIT_WIDTH,
                             .height = ADCGS_ORBIT_HEIGHT,
                             .fx = ORBIT_FOCAL * ADCGS_ORBIT_WIDTH,
                             .fy = ORBIT_FOCAL * ADCGS_ORBIT_WIDTH,
                             .cx = 0.5 * ADCGS_ORBIT_WIDTH,
                             .cy = 0.5 * ADCGS_ORBIT_HEIGHT,
                             .near_plane = ADCGS_NEAR_PER_SCALE * info->scene_scale,
                             .name = "orbit"};
    double eye[3];
    for (int i = 0; i < 3; i++) /* up is never x */
        eye[i] = info->scene_origin[i] +
                 ORBIT_DISTANCE * info->scene_scale * (up[i] * sin(ORBIT_ELEVATION) + (i == 0) * cos(ORBIT_ELEVATION));
    adcgs_look_at(camera->cam_to_world, eye, info->scene_origin, up);
}
