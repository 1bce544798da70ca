/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Views taken through lenses, while scenes are read. */
#include "config.h"

#include "scene/layouts/view_lens.h"

#define LATEST 64 /* views of a split that are compared: as many as a rig has cameras; chosen by hand, not measured */

static const adcgs_scene_view *find_same(const adcgs_scene *scene, const adcgs_scene_view *view)
{
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t n = scene->n_views[s], i = n; i > 0 && n - i < LATEST; i--) {
            const adcgs_scene_view *other = &scene->views[s][i - 1];
            if (other != view && !memcmp(&other->lens, &view->lens, sizeof view->lens))
                return other;
        }
    return NULL;
}

adcgs_status adcgs_view_lens(const adcgs_scene *scene, adcgs_scene_view *view, const char *path, adcgs_error *error)
{
    const adcgs_scene_view *same = find_same(scene, view);
    if (!same)
        return adcgs_lens_pinhole(&view->lens, &view->camera, path, error);
    view->camera.width = same->camera.width;
    view->camera.height = same->camera.height;
    view->camera.fx = same->camera.fx;
    view->camera.fy = same->camera.fy;
    view->camera.cx = same->camera.cx;
    view->camera.cy = same->camera.cy;
    return ADCGS_OK;
}
