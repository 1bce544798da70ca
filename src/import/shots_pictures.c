/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Which pictures there are in files and folders, and of which camera. */
#include "config.h"

#include "import/shots.h"

#include "cli/text.h"
#include "data/paths.h"
#include "io/extension.h"
#include "io/photo.h"
#include "layouts/listing.h"

#include <stdlib.h>
#include <strings.h>

/** The camera that pictures of a kind are of: told by the size of its pictures and by what they say of maker, model and lens. */
static adcgs_status find_camera(adcgs_shots *shots, const adcgs_photo *photo, uint32_t *camera, adcgs_error *error)
{
    char key[sizeof shots->cameras->key], name[ADCGS_SHOT_NAME];
    snprintf(key, sizeof key, "%dx%d %d %s", photo->width, photo->height, photo->turn, photo->camera);
    for (*camera = 0; *camera < shots->n_cameras; ++*camera)
        if (!strcmp(shots->cameras[*camera].key, key))
            return ADCGS_OK;
    snprintf(name, sizeof name, "camera%u", shots->n_cameras + 1);
    adcgs_shot_camera *added = adcgs_shots_add_camera(shots, name, error);
    if (!added)
        return error->status;
    memcpy(added->key, key, sizeof key);
    added->focal = photo->focal;
    return ADCGS_OK;
}

static int ends_like(const char *path, const char *a, const char *b)
{
    const char *end = adcgs_extension(path);
    return !strcasecmp(end, a) || !strcasecmp(end, b);
}

static adcgs_status add_picture(adcgs_shots *shots, const char *path, const adcgs_import_options *options, adcgs_error *error)
{
    adcgs_photo photo;
    char stem[256];
    uint32_t camera;
    ADCGS_TRY(adcgs_photo_probe(&photo, path, error));
    ADCGS_TRY(find_camera(shots, &photo, &camera, error));
    adcgs_stem(stem, sizeof stem, path);
    adcgs_shot *shot = adcgs_shots_add(shots, camera, stem, error);
    if (!shot)
        return error->status;
    const int is_jpeg = ends_like(path, "jpg", "jpeg"), is_png = ends_like(path, "png", "png");
    const int lies = adcgs_photo_lies(photo.turn);
    shot->turn = photo.turn;
    shot->width = lies ? photo.height : photo.width;
    shot->height = lies ? photo.width : photo.height;
    adcgs_shot_fit(&shot->width, &shot->height, options->side);
    shot->as_is = (is_jpeg || is_png) && photo.turn == ADCGS_PHOTO_UPRIGHT && shot->width == photo.width &&
                  shot->height == photo.height;
    snprintf(shot->end, sizeof shot->end, "%s", is_jpeg ? "jpg" : "png");
    shot->time = options->fps.den ? (double)(shots->n - 1) / adcgs_fps_value(options->fps) : 0.0;
    shot->path = strdup(path);
    return shot->path ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

static adcgs_status add_folder(adcgs_shots *shots, const char *folder, const adcgs_import_options *options,
                               adcgs_progress *progress, adcgs_error *error)
{
    adcgs_listing listing;
    ADCGS_TRY(adcgs_listing_read(&listing, folder, adcgs_is_image_name, error));
    adcgs_status status = listing.n ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_DATA, "%s: no picture in this folder", folder);
    for (size_t i = 0; status == ADCGS_OK && i < listing.n; i++) {
        char *path = adcgs_path("%s/%s", folder, listing.names[i]);
        status = path ? add_picture(shots, path, options, error)
                      : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", folder);
        free(path);
        adcgs_progress_show(progress, "looking   %6u pictures", shots->n);
    }
    adcgs_listing_free(&listing);
    return status;
}

adcgs_status adcgs_shots_pictures(adcgs_shots *shots, const adcgs_import_options *options, adcgs_progress *progress,
                                  adcgs_error *error)
{
    shots->kind = options->fps.den ? ADCGS_FOOTAGE_FILM : ADCGS_FOOTAGE_PICTURES;
    shots->rate = options->fps;
    for (int i = 0; i < options->n_inputs; i++)
        ADCGS_TRY(adcgs_is_folder(options->inputs[i]) ? add_folder(shots, options->inputs[i], options, progress, error)
                                                      : add_picture(shots, options->inputs[i], options, error));
    adcgs_counting counting = {.n = 0};
    for (uint32_t i = 0; i < shots->n; i++)
        adcgs_counting_add(&counting, shots->shots[i].stem);
    shots->is_numbered = adcgs_counting_holds(&counting);
    return shots->n >= 3 ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_DATA, "%s: %u image%s, expected at least three",
                                                 options->inputs[0], shots->n, adcgs_s(shots->n));
}
