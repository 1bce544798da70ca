/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Files of a COLMAP model that exist in both formats. COLMAP, 3DGS and nerfstudio read the binary one, so that edits of the text
 * have no effect; a remark reports them.
 */
#include "config.h"

#include "scene/layouts/colmap_twice.h"

#include <math.h>

#define SAME 1e-4 /* tolerance of numbers in text, relative to 1 plus their size; chosen by hand, not measured */

static int are_same(double a, double b)
{
    return fabs(a - b) <= SAME * (1.0 + fabs(a));
}

static int same_lens(const adcgs_lens *a, const adcgs_lens *b)
{
    int same = a->width == b->width && a->height == b->height && a->is_fisheye == b->is_fisheye;
    same &= are_same(a->fx, b->fx) && are_same(a->fy, b->fy) && are_same(a->cx, b->cx) && are_same(a->cy, b->cy);
    for (size_t i = 0; i < ADCGS_COUNTOF(a->k); i++)
        same &= are_same(a->k[i], b->k[i]);
    return same && are_same(a->p[0], b->p[0]) && are_same(a->p[1], b->p[1]);
}

static int same_image(const adcgs_colmap_image *a, const adcgs_colmap_image *b)
{
    int same = a->camera_id == b->camera_id && !strcmp(a->name, b->name);
    for (int i = 0; i < 12; i++)
        same &= are_same(a->cam_to_world[i], b->cam_to_world[i]);
    return same;
}

/** Compares the contents of one file; both are sorted. */
static int same_models(const adcgs_colmap *a, const adcgs_colmap *b, adcgs_colmap_file file)
{
    const size_t n = file == ADCGS_COLMAP_CAMERAS ? a->n_cameras : a->n_images;
    int same = n == (file == ADCGS_COLMAP_CAMERAS ? b->n_cameras : b->n_images);
    for (size_t i = 0; i < n && same; i++)
        same = file == ADCGS_COLMAP_CAMERAS
                   ? a->cameras[i].id == b->cameras[i].id && same_lens(&a->cameras[i].lens, &b->cameras[i].lens)
                   : same_image(&a->images[i], &b->images[i]);
    return same;
}

adcgs_status adcgs_colmap_twice_remark(adcgs_scene *scene, const adcgs_colmap *model, const adcgs_colmap_place *place,
                                       adcgs_colmap_file file, adcgs_error *error)
{
    const adcgs_colmap_place other = {place->folder, !place->format};
    const char *const name = file == ADCGS_COLMAP_CAMERAS ? "cameras" : "images", *const end = adcgs_colmap_end(place, file);
    adcgs_colmap second = {0};
    if (scene->is_outline || !strcmp(end, adcgs_colmap_end(&other, file)))
        return ADCGS_OK;
    const adcgs_status status = adcgs_colmap_load(&second, &other, file, error);
    if (status == ADCGS_OK && !same_models(model, &second, file))
        adcgs_scene_remark(scene, "%s.%s is read, but %s.%s differs from it: remove one of them", name, end, name,
                           adcgs_colmap_end(&other, file));
    adcgs_colmap_clear(&second);
    return status == ADCGS_ERR_MEMORY ? status : ADCGS_OK;
}
