/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Masks given with images: found by name, and transformed like the images. */
#include "config.h"

#include "apps/import/scene_images.h"

#include "media/image/image.h"
#include "media/image/photo.h"
#include "scene/mask.h"
#include "system/paths.h"

#include <math.h>
#include <stdlib.h>

#define SHAPE_TOLERANCE 0.01 /* relative difference of aspect ratios; chosen by hand, not measured */

/** Finds a mask by its name without or with the extension of an image; *out is NULL if there is none. */
static adcgs_status find(const adcgs_import_job *job, const char *name, int length, char **out)
{
    char *path = adcgs_path("%s/%.*s", job->options->masks, length, name);
    const adcgs_status status = path ? adcgs_find_image(out, path, job->error)
                                     : adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", job->options->masks);
    free(path);
    return status;
}

/**
 * Finds an image's mask: by the image's file name with or without its extension, by the name of the image in the scene, or else
 * by its camera's name.
 */
static adcgs_status find_mask(const adcgs_import_job *job, const adcgs_source_image *source, char **out)
{
    const char *slash = source->path ? strrchr(source->path, '/') : NULL, *file = slash ? slash + 1 : source->path;
    const char *const camera = job->sources.cameras[source->camera].name;
    *out = NULL;
    if (file) {
        const char *dot = strrchr(file, '.');
        ADCGS_TRY(find(job, file, dot && dot > file ? (int)(dot - file) : (int)strlen(file), out));
        char *whole = *out ? NULL : adcgs_path("%s/%s.png", job->options->masks, file); /* COLMAP's convention */
        if (adcgs_is_there(whole))
            *out = whole;
        else
            free(whole);
    }
    if (!*out)
        ADCGS_TRY(find(job, source->stem, (int)strlen(source->stem), out));
    return *out ? ADCGS_OK : find(job, camera, (int)strlen(camera), out);
}

/** Checks that the mask has the aspect ratio of the image before rotation. */
static adcgs_status check_shape(const adcgs_import_job *job, const adcgs_source_image *source, const char *path,
                                const adcgs_image *mask)
{
    const int lies = adcgs_photo_lies(source->turn);
    const int width = lies ? source->height : source->width, height = lies ? source->width : source->height;
    const double ratio = (double)mask->width * height / ((double)mask->height * width);
    return fabs(ratio - 1.0) <= SHAPE_TOLERANCE ? ADCGS_OK
                                                : adcgs_fail(job->error, ADCGS_ERR_DATA,
                                                             "%s: %dx%d pixels, another aspect ratio than its image, which "
                                                             "becomes %dx%d",
                                                             path, mask->width, mask->height, width, height);
}

/**
 * Makes pixels above the threshold 1, others 0. With threshold 0 all that is not black counts; values in between arise only at
 * edges, by reduction.
 */
static void make_plain(adcgs_image *mask, float threshold)
{
    const int colours = mask->channels < 3 ? 1 : 3;
    for (size_t i = 0, n = (size_t)mask->width * (size_t)mask->height; i < n; i++) {
        const float *at = mask->data + i * (size_t)mask->channels;
        const float most = colours == 1 ? at[0] : fmaxf(at[0], fmaxf(at[1], at[2]));
        mask->data[i] = most > threshold;
    }
    mask->channels = 1;
}

static adcgs_status make_mask(const adcgs_import_job *job, const adcgs_source_image *source, const char *from, const char *to)
{
    adcgs_image mask;
    ADCGS_TRY(adcgs_image_read(&mask, from, job->error));
    adcgs_status status = check_shape(job, source, from, &mask);
    if (status == ADCGS_OK)
        status = adcgs_mask_settle(&mask, from, job->error);
    make_plain(&mask, 0.0f);
    if (status == ADCGS_OK)
        status = adcgs_photo_shape(&mask, source->turn, source->width, source->height, from, job->error);
    make_plain(&mask, 0.5f);
    if (status == ADCGS_OK)
        status = adcgs_image_write(&mask, to, 0, job->error);
    adcgs_image_free(&mask);
    return status;
}

adcgs_status adcgs_import_mask(adcgs_import_job *job, const adcgs_source_image *source)
{
    char *from;
    ADCGS_TRY(find_mask(job, source, &from));
    if (!from)
        return ADCGS_OK;
    job->has_masks = 1;
    char *to =
        adcgs_path("%s/masks/%s/%s.%s.png", job->folder, job->sources.cameras[source->camera].folder, source->stem, source->end);
    adcgs_status status = !to                  ? adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", from)
                          : adcgs_is_there(to) ? ADCGS_OK
                                               : make_mask(job, source, from, to);
    free(to);
    free(from);
    return status;
}

adcgs_status adcgs_import_camera_mask(adcgs_import_job *job, uint32_t camera)
{
    const char *const name = job->sources.cameras[camera].name;
    adcgs_image mask;
    char *from;
    ADCGS_TRY(find(job, name, (int)strlen(name), &from));
    if (!from)
        return ADCGS_OK;
    char *to = adcgs_path("%s/masks/%s.png", job->folder, name);
    adcgs_status status =
        to ? adcgs_image_read(&mask, from, job->error) : adcgs_fail(job->error, ADCGS_ERR_MEMORY, "%s: out of memory", from);
    if (status == ADCGS_OK) {
        status = adcgs_mask_settle(&mask, from, job->error);
        if (status == ADCGS_OK)
            status = adcgs_image_write(&mask, to, 0, job->error);
        adcgs_image_free(&mask);
    }
    free(to);
    free(from);
    return status;
}
