/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Preview image of a run. */
#include "config.h"

#include "session/enc_preview.h"

#include "media/image/mosaic.h"
#include "train/train_views.h"

#include <math.h>
#include <stdlib.h>

#define EVERY 30.0        /* seconds between previews; chosen by hand, not measured */
enum { SIDE_MOST = 800 }; /* pixels: maximum width and height; chosen by hand, not measured */

/** The middle validation view, which is not trained on, or the middle training view. Test views are never used. */
static const adcgs_scene_view *choose(const adcgs_scene *scene)
{
    const adcgs_split split = scene->n_views[ADCGS_SPLIT_VAL] ? ADCGS_SPLIT_VAL : ADCGS_SPLIT_TRAIN;
    return &scene->views[split][scene->n_views[split] / 2];
}

/** Renders the view with the current model, without changing any state of the iterations. */
static adcgs_status draw(float *image, adcgs_trainer *t, const adcgs_scene_view *of, const adcgs_camera *camera,
                         adcgs_error *error)
{
    const adcgs_pass_mode mode = {.quant = t->stage.rounding && !t->stage.frozen ? ADCGS_QUANT_ROUND : ADCGS_QUANT_NONE,
                                  .deform = ADCGS_DEFORM_ALL};
    adcgs_view view;
    ADCGS_TRY(adcgs_view_init(&view, camera, t->origin, t->scale, error));
    adcgs_pass_forward(t->pass, t->f, adcgs_trainer_time(t, of->time), &mode);
    return adcgs_view_render(t, &view, ADCGS_MEAN_LIGHT, image, 0, error);
}

static adcgs_status place(adcgs_mosaic *mosaic, adcgs_trainer *t, const adcgs_scene_view *view, const adcgs_camera *camera,
                          const float *taken, adcgs_error *error)
{
    const size_t plane = (size_t)camera->width * (size_t)camera->height;
    adcgs_mosaic_place(mosaic, 0, 0, (adcgs_samples){taken, 1, plane});
    if (!t)
        return ADCGS_OK;
    float *image = adcgs_alloc(NULL, 3 * plane, sizeof *image, error);
    const adcgs_status status = image ? draw(image, t, view, camera, error) : adcgs_alloc_status(error);
    if (status == ADCGS_OK)
        adcgs_mosaic_place(mosaic, 1, 0, (adcgs_samples){image, 1, plane});
    adcgs_free(NULL, image);
    return status;
}

/** t NULL: no model yet. */
static adcgs_status write_preview(const char *path, const adcgs_scene *scene, adcgs_trainer *t, adcgs_error *error)
{
    const adcgs_scene_view *const view = choose(scene);
    const int side = ADCGS_MAX(view->camera.width, view->camera.height);
    adcgs_mosaic mosaic;
    adcgs_camera camera;
    float *taken;
    ADCGS_TRY(adcgs_scene_image(scene, view, (side + SIDE_MOST - 1) / SIDE_MOST, &taken, &camera, error));
    adcgs_status status = adcgs_mosaic_init(&mosaic, camera.width, camera.height, 2, 1, path, error);
    if (status == ADCGS_OK)
        status = place(&mosaic, t, view, &camera, taken, error);
    if (status == ADCGS_OK)
        status = adcgs_image_write(&mosaic.image, path, 0, error);
    adcgs_mosaic_clear(&mosaic);
    free(taken);
    return status;
}

adcgs_status adcgs_enc_preview_begin(const char *path, const adcgs_scene *scene, adcgs_error *error)
{
    return write_preview(path, scene, NULL, error);
}

void adcgs_enc_preview_show(adcgs_enc_preview *preview, adcgs_trainer *t, const char *stage, adcgs_progress *progress)
{
    const int another = !stage || !preview->stage || strcmp(stage, preview->stage);
    adcgs_error why = {ADCGS_OK, ""};
    if (!preview->path || !t->views.divide || (!another && fabs(t->run.elapsed.clock - preview->drawn) < EVERY))
        return;
    preview->stage = stage;
    preview->drawn = t->run.elapsed.clock;
    if (write_preview(preview->path, t->scene, t, &why) == ADCGS_OK || preview->failed)
        return;
    preview->failed = 1;
    adcgs_progress_clear(progress);
    adcgs_cli_error(progress->cli, ADCGS_OK, "%s; the run continues, and tries again later", why.text);
}
