/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Lists images in files and folders, with their cameras. */
#include "config.h"

#include "apps/import/source_images.h"

#include "media/image/panorama.h"
#include "media/image/photo.h"
#include "media/kind.h"
#include "media/listing.h"
#include "system/extension.h"
#include "system/paths.h"
#include "system/text.h"

#include <stdlib.h>
#include <strings.h>

/** Finds the camera of an image by the image's size and its metadata (maker, model and lens). */
static adcgs_status find_camera(adcgs_source_images *sources, const adcgs_photo *photo, uint32_t *camera, adcgs_error *error)
{
    char key[sizeof sources->cameras->key], name[ADCGS_SOURCE_IMAGE_NAME];
    snprintf(key, sizeof key, "%dx%d %d %s", photo->width, photo->height, photo->turn, photo->camera);
    for (*camera = 0; *camera < sources->n_cameras; ++*camera)
        if (!strcmp(sources->cameras[*camera].key, key))
            return ADCGS_OK;
    snprintf(name, sizeof name, "camera%u", sources->n_cameras + 1);
    adcgs_source_image_camera *added = adcgs_source_images_add_camera(sources, name, error);
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

/** Names the remedy for an HEIC or AVIF image that cannot be read: a command that converts it. */
static adcgs_status explain_heif(const char *path, adcgs_status status, adcgs_error *error)
{
    const adcgs_kind *const kind = adcgs_kind_at(path);
    char stem[256];
    if ((status != ADCGS_ERR_UNSUPPORTED && status != ADCGS_ERR_DATA) || !kind->reader || strcmp(kind->reader, "heif"))
        return status;
    adcgs_stem(stem, sizeof stem, path);
    return adcgs_fail(error, status,
                      "%.120s: %s that OpenImageIO cannot read here: convert it: heif-convert -q 95 %.40s.%.8s %.40s.jpg", path,
                      kind->name, stem, adcgs_extension(path), stem);
}

/** COLMAP has no lens model for panoramas. */
static adcgs_status refuse_panorama(const char *path, adcgs_error *error)
{
    char projection[ADCGS_PANORAMA_NAME];
    ADCGS_TRY(adcgs_panorama_of(projection, path, error));
    return !*projection
               ? ADCGS_OK
               : adcgs_fail(error, ADCGS_ERR_UNSUPPORTED,
                            "%.100s: a 360-degree image (%s), expected one of a plain lens: cut flat views from it, as by "
                            "ffmpeg -i IMAGE -vf v360=e:flat:h_fov=90:v_fov=60 flat.jpg",
                            path, projection);
}

static adcgs_status add_picture(adcgs_source_images *sources, const char *path, const adcgs_import_options *options,
                                adcgs_error *error)
{
    adcgs_photo photo;
    char stem[256];
    uint32_t camera;
    const adcgs_status status = adcgs_photo_probe(&photo, path, error);
    if (status != ADCGS_OK)
        return explain_heif(path, status, error);
    ADCGS_TRY(refuse_panorama(path, error));
    ADCGS_TRY(find_camera(sources, &photo, &camera, error));
    adcgs_stem(stem, sizeof stem, path);
    adcgs_source_image *source = adcgs_source_images_add(sources, camera, stem, error);
    if (!source)
        return error->status;
    const int is_jpeg = ends_like(path, "jpg", "jpeg"), is_png = ends_like(path, "png", "png");
    const int lies = adcgs_photo_lies(photo.turn);
    source->turn = photo.turn;
    source->width = lies ? photo.height : photo.width;
    source->height = lies ? photo.width : photo.height;
    adcgs_source_image_fit(&source->width, &source->height, options->side);
    source->as_is = (is_jpeg || is_png) && photo.turn == ADCGS_PHOTO_UPRIGHT && source->width == photo.width &&
                    source->height == photo.height;
    snprintf(source->end, sizeof source->end, "%s", is_jpeg ? "jpg" : "png");
    source->time = options->fps.den ? (double)(sources->n - 1) / adcgs_fps_value(options->fps) : 0.0;
    source->path = strdup(path);
    return source->path ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

static int is_heif_name(const char *name)
{
    return ends_like(name, "heic", "heif") || ends_like(name, "avif", "avifs");
}

static int any_name(const char *name)
{
    return 1;
}

/** Orders names by their stems with the dot, which is also the order of listings. */
static int compare_stems(const char *a, const char *b)
{
    const size_t n = strlen(a) - strlen(adcgs_extension(a)), m = strlen(b) - strlen(adcgs_extension(b));
    const int order = memcmp(a, b, n < m ? n : m);
    return order ? order : (n > m) - (n < m);
}

/** Merges names of images in order with names of HEIC and AVIF that have no other image of the same stem. */
static size_t merge(const char **out, const adcgs_listing *images, const adcgs_listing *heifs)
{
    size_t n = 0, i = 0;
    for (size_t k = 0; k < heifs->n; k++) {
        while (i < images->n && compare_stems(images->names[i], heifs->names[k]) < 0)
            out[n++] = images->names[i++];
        if (i == images->n || compare_stems(images->names[i], heifs->names[k]))
            out[n++] = heifs->names[k];
    }
    while (i < images->n)
        out[n++] = images->names[i++];
    return n;
}

/** Refuses a folder without images; names the kind of a file in it, if it is known. */
static adcgs_status refuse_folder(const char *folder, adcgs_error *error)
{
    adcgs_listing all;
    adcgs_status status = adcgs_listing_read(&all, folder, any_name, error);
    for (size_t i = 0; status == ADCGS_OK && i < all.n; i++) {
        char *const path = adcgs_path("%s/%s", folder, all.names[i]);
        const adcgs_kind *const kind = path ? adcgs_kind_at(path) : NULL;
        if (kind && kind->class != ADCGS_KIND_UNKNOWN && kind->class != ADCGS_KIND_FOLDER && !kind->reader)
            status = adcgs_kind_refuse(kind, path, ADCGS_WANT_IMAGE, error);
        free(path);
    }
    adcgs_listing_free(&all);
    return status == ADCGS_OK ? adcgs_fail(error, ADCGS_ERR_DATA, "%s: no image in this folder", folder) : status;
}

static adcgs_status add_names(adcgs_source_images *sources, const char *folder, const char *const *names, size_t n,
                              const adcgs_import_options *options, adcgs_progress *progress, adcgs_error *error)
{
    for (size_t i = 0; i < n; i++) {
        char *path = adcgs_path("%s/%s", folder, names[i]);
        const adcgs_status status =
            path ? add_picture(sources, path, options, error) : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", folder);
        free(path);
        ADCGS_TRY(status);
        adcgs_progress_show(progress, "scanning  %6u images", sources->n);
    }
    return ADCGS_OK;
}

static adcgs_status add_folder(adcgs_source_images *sources, const char *folder, const adcgs_import_options *options,
                               adcgs_progress *progress, adcgs_error *error)
{
    adcgs_listing images, heifs = {0};
    const char **names = NULL;
    ADCGS_TRY(adcgs_listing_read(&images, folder, adcgs_is_image_name, error));
    adcgs_status status = adcgs_listing_read(&heifs, folder, is_heif_name, error);
    if (status == ADCGS_OK && !images.n && !heifs.n)
        status = refuse_folder(folder, error);
    if (status == ADCGS_OK && !(names = malloc((images.n + heifs.n) * sizeof *names)))
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", folder);
    if (status == ADCGS_OK)
        status = add_names(sources, folder, names, merge(names, &images, &heifs), options, progress, error);
    free(names);
    adcgs_listing_free(&images);
    adcgs_listing_free(&heifs);
    return status;
}

adcgs_status adcgs_source_images_photos(adcgs_source_images *sources, const adcgs_import_options *options,
                                        adcgs_progress *progress, adcgs_error *error)
{
    sources->kind = options->fps.den ? ADCGS_FOOTAGE_FILM : ADCGS_FOOTAGE_PICTURES;
    sources->rate = options->fps;
    for (int i = 0; i < options->n_inputs; i++)
        ADCGS_TRY(adcgs_is_folder(options->inputs[i]) ? add_folder(sources, options->inputs[i], options, progress, error)
                                                      : add_picture(sources, options->inputs[i], options, error));
    adcgs_counting counting = {.n = 0};
    for (uint32_t i = 0; i < sources->n; i++)
        adcgs_counting_add(&counting, sources->list[i].stem);
    sources->is_numbered = adcgs_counting_holds(&counting);
    return sources->n >= 3 ? ADCGS_OK
                           : adcgs_fail(error, ADCGS_ERR_DATA, "%s: %u image%s, expected at least three", options->inputs[0],
                                        sources->n, adcgs_s(sources->n));
}
