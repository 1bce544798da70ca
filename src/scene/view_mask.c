/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Masks of views: compares their sizes with the images, and checks that they leave pixels for training. */
#include "config.h"

#include "scene/view_mask.h"

#include "scene/mask.h"

void adcgs_view_size(const adcgs_scene_view *view, int wanted[2])
{
    const int bends = view->lens.width > 0;
    wanted[0] = bends ? view->lens.width : view->camera.width;
    wanted[1] = bends ? view->lens.height : view->camera.height;
}

adcgs_status adcgs_view_mask_fits(const adcgs_scene_view *view, const char *path, int width, int height, adcgs_error *error)
{
    int wanted[2];
    adcgs_view_size(view, wanted);
    if (adcgs_mask_fits(width, height, wanted[0], wanted[1]))
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_DATA,
                      "%s: %dx%d pixels, expected %dx%d like its image, or another size of the "
                      "same aspect ratio",
                      path, width, height, wanted[0], wanted[1]);
}

static adcgs_status check_mask_size(const adcgs_scene_view *view, const char *path, int *channels, adcgs_error *error)
{
    int width, height;
    ADCGS_TRY(adcgs_image_probe(&width, &height, channels, path, error));
    return adcgs_view_mask_fits(view, path, width, height, error);
}

adcgs_status adcgs_view_mask_check(const adcgs_scene_view *view, const char *path, adcgs_error *error)
{
    int channels;
    return check_mask_size(view, path, &channels, error);
}

adcgs_status adcgs_view_mask_settle(const adcgs_scene_view *view, const char *path, adcgs_image *mask, adcgs_error *error)
{
    int wanted[2];
    adcgs_view_size(view, wanted);
    adcgs_status status = adcgs_mask_settle(mask, path, error);
    if (status == ADCGS_OK)
        status = adcgs_mask_resize(mask, wanted[0], wanted[1], path, error);
    if (status != ADCGS_OK)
        adcgs_image_free(mask);
    return status;
}

/** Reads a mask whose size was checked. */
static adcgs_status read_mask(const adcgs_scene_view *view, const char *path, adcgs_image *mask, adcgs_error *error)
{
    ADCGS_TRY(adcgs_image_read(mask, path, error));
    return adcgs_view_mask_settle(view, path, mask, error);
}

adcgs_status adcgs_view_mask_read(const adcgs_scene_view *view, const char *path, adcgs_image *mask, adcgs_error *error)
{
    ADCGS_TRY(adcgs_view_mask_check(view, path, error));
    return read_mask(view, path, mask, error);
}

adcgs_status adcgs_view_mask_probe(const adcgs_scene_view *view, const char *path, adcgs_error *error)
{
    int channels;
    adcgs_image mask;
    ADCGS_TRY(check_mask_size(view, path, &channels, error));
    if (channels % 2)
        return ADCGS_OK;
    ADCGS_TRY(read_mask(view, path, &mask, error));
    adcgs_image_free(&mask);
    return ADCGS_OK;
}

adcgs_status adcgs_scene_check_masks(const adcgs_scene *scene, adcgs_error *error)
{
    const adcgs_scene_view *const train = scene->views[ADCGS_SPLIT_TRAIN];
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    for (uint32_t i = 0; i < n; i++) {
        adcgs_image mask;
        if (!train[i].mask)
            return ADCGS_OK;
        ADCGS_TRY(adcgs_view_mask_read(&train[i], train[i].mask, &mask, error));
        const int shows = adcgs_mask_shows(&mask);
        adcgs_image_free(&mask);
        if (shows)
            return ADCGS_OK;
    }
    if (!n)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_DATA,
                      "%s: black everywhere, like the masks of all training images, so that no pixel "
                      "is left for training: invert the masks",
                      train[0].mask);
}
