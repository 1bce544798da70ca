/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The poster of a page. */
#include "config.h"

#include "apps/share/share_poster.h"

#include "camera/path.h"
#include "geometry/rotation.h"
#include "media/image/image.h"
#include "media/image/jpeg.h"
#include "media/kind.h"
#include "system/file.h"

#include <adcgs/adcgs.h>

#include <math.h>
#include <stdlib.h>

/* Chosen by hand, not measured. */
#define POSTER_PIXELS (640.0 * 360.0)       /* pixels of a rendered poster */
#define POSTER_BYTES 12000                  /* wanted size of a rendered poster */
#define POSTER_FILE_MAX ((uint64_t)2 << 20) /* bytes of a poster from a file */
/* JPEG qualities, tried in this order until the poster is small enough. */
static const int qualities[] = {80, 70, 60, 50, 40, 30};

/** The camera of the page's first view, at the poster's size. */
static adcgs_status make_view(adcgs_camera *camera, const adcgs_share_scene *scene, adcgs_decoder *decoder, double time,
                              adcgs_error *error)
{
    adcgs_camera_path path;
    const adcgs_camera_path_request request = {.has_times = 1, .begin = time, .end = time};
    if (scene->camera >= 0)
        ADCGS_TRY(adcgs_get_camera(decoder, scene->camera, camera, error));
    else {
        ADCGS_TRY(adcgs_camera_path_make(&path, decoder, &request, error));
        *camera = path.frame[0].camera;
        adcgs_camera_path_free(&path);
    }
    const double part = sqrt(POSTER_PIXELS / ((double)camera->width * camera->height));
    adcgs_camera_fit(camera, ADCGS_MAX(1, (int)(part * camera->width + 0.5)), ADCGS_MAX(1, (int)(part * camera->height + 0.5)),
                     0);
    return ADCGS_OK;
}

/** Encodes the frame with the best quality that the wanted size allows. */
static adcgs_status encode_poster(adcgs_share_poster *poster, const adcgs_image *image, adcgs_error *error)
{
    adcgs_buffer bytes;
    adcgs_status status = ADCGS_OK;
    adcgs_buffer_init(&bytes);
    for (size_t i = 0; i < ADCGS_COUNTOF(qualities) && status == ADCGS_OK && (i == 0 || bytes.size > POSTER_BYTES); i++) {
        const adcgs_image_options options = {.bits = 8, .quality = qualities[i]};
        bytes.size = 0;
        status = adcgs_jpeg_encode(&bytes, image, &options, "poster", error);
    }
    if (status == ADCGS_OK && bytes.failed)
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "poster: out of memory");
    if (status != ADCGS_OK) {
        adcgs_buffer_clear(&bytes);
        return status;
    }
    *poster = (adcgs_share_poster){.data = bytes.data,
                                   .bytes = bytes.size,
                                   .width = image->width,
                                   .height = image->height,
                                   .type = "image/jpeg"};
    return ADCGS_OK;
}

adcgs_status adcgs_share_render_poster(adcgs_share_scene *scene, adcgs_decoder *decoder, adcgs_error *error)
{
    adcgs_info info;
    adcgs_camera camera;
    adcgs_image image;
    ADCGS_TRY(adcgs_get_info(decoder, &info, sizeof info, error));
    const double time = scene->has_time ? scene->time : info.time_start;
    ADCGS_TRY(make_view(&camera, scene, decoder, time, error));
    ADCGS_TRY(adcgs_image_alloc(&image, camera.width, camera.height, 3, "poster", error));
    adcgs_frame frame = {.width = image.width, .height = image.height, .rgb = image.data};
    adcgs_status status = adcgs_camera_path_rendered(&camera, adcgs_render(decoder, &camera, time, &frame, error), error);
    if (status == ADCGS_OK)
        status = encode_poster(&scene->poster, &image, error);
    adcgs_image_free(&image);
    return status;
}

adcgs_status adcgs_share_load_poster(adcgs_share_scene *scene, const char *path, adcgs_error *error)
{
    adcgs_share_poster *poster = &scene->poster;
    int channels;
    ADCGS_TRY(adcgs_file_load(&poster->data, &poster->bytes, path, POSTER_FILE_MAX, error));
    const char *const format =
        adcgs_kind_of(poster->data, ADCGS_MIN(poster->bytes, ADCGS_KIND_BYTES), poster->bytes, NULL, path)->reader;
    if (format && !strcmp(format, "png"))
        poster->type = "image/png";
    else if (format && !strcmp(format, "jpeg"))
        poster->type = "image/jpeg";
    else
        return adcgs_fail(error, ADCGS_ERR_DATA, "%.160s: no poster, expected a JPEG or PNG image", path);
    return adcgs_image_probe(&poster->width, &poster->height, &channels, path, error);
}
