/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Visibility of points in the training views. */
#include "train/density/visibility.h"

#include "geometry/rotation.h"
#include "train/scene_frame.h"

#include <math.h>
#include <stdlib.h>

/* Difference from the background, summed over channels, of an empty pixel with alpha; chosen by hand, not measured. */
#define TRANSPARENT 0.02

void adcgs_visibility_clear(adcgs_visibility *s)
{
    for (uint32_t i = 0; i < s->n; i++)
        free(s->rgb[i]);
}

adcgs_status adcgs_visibility_init(adcgs_visibility *s, const adcgs_scene *scene, adcgs_error *error)
{
    const uint32_t all = scene->n_views[ADCGS_SPLIT_TRAIN], n = ADCGS_MIN(all, ADCGS_VISIBILITY_VIEWS);
    memset(s, 0, sizeof *s);
    s->scene = scene;
    ADCGS_TRY(adcgs_scene_frame(scene, s->origin, &s->scale, error));
    for (uint32_t i = 0; i < n; i++) {
        const adcgs_scene_view *view = &scene->views[ADCGS_SPLIT_TRAIN][(uint64_t)i * all / n];
        const adcgs_status status = adcgs_scene_image(scene, view, 4, &s->rgb[i], &s->camera[i], error);
        if (status != ADCGS_OK) {
            adcgs_visibility_clear(s);
            return status;
        }
        s->n = i + 1;
    }
    return ADCGS_OK;
}

adcgs_point_visibility adcgs_visibility_of(const adcgs_visibility *s, const double x[3])
{
    adcgs_point_visibility g = {0, 0, {0, 0, 0}};
    double world[3];
    for (int a = 0; a < 3; a++)
        world[a] = s->origin[a] + s->scale * x[a];
    for (uint32_t i = 0; i < s->n; i++) {
        const adcgs_camera *c = &s->camera[i];
        double place[2];
        if (!adcgs_camera_sees(c, world, c->near_plane, place))
            continue;
        const size_t plane = (size_t)c->width * (size_t)c->height;
        const size_t at = (size_t)place[1] * (size_t)c->width + (size_t)place[0];
        if (isnan(s->rgb[i][at])) /* masked */
            continue;
        double off = 0;
        for (int a = 0; a < 3; a++)
            off += fabs(s->rgb[i][(size_t)a * plane + at] - s->scene->background[a]);
        g.seen++;
        if (s->scene->has_alpha && off < TRANSPARENT)
            continue;
        g.covered++;
        for (int a = 0; a < 3; a++)
            g.rgb[a] += s->rgb[i][(size_t)a * plane + at];
    }
    for (int a = 0; a < 3; a++)
        g.rgb[a] = g.covered ? g.rgb[a] / g.covered : 0.5;
    return g;
}
