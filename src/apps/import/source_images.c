/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Lists of images and cameras. */
#include "config.h"

#include "apps/import/source_images.h"

#include "media/image/photo.h"
#include "system/paths.h"

#include <ctype.h>
#include <stdlib.h>

#define SHOTS_MAX 10000 /* images: limit of cameras in a scene file; chosen by hand, not measured */

void adcgs_source_images_clear(adcgs_source_images *sources)
{
    for (uint32_t i = 0; i < sources->n; i++)
        free(sources->list[i].path);
    for (uint32_t i = 0; i < sources->n_cameras; i++)
        free(sources->cameras[i].video);
    free(sources->list);
    free(sources->cameras);
    *sources = (adcgs_source_images){0};
}

char *adcgs_source_image_path(const adcgs_source_images *sources, const adcgs_source_image *source, const char *folder)
{
    return adcgs_path("%s/%s/%s.%s", folder, sources->cameras[source->camera].folder, source->stem, source->end);
}

void adcgs_source_image_fit(int *width, int *height, int side)
{
    const int longer = ADCGS_MAX(*width, *height);
    if (longer <= side)
        return;
    *width = ADCGS_MAX(1, (int)(((int64_t)*width * side + longer / 2) / longer));
    *height = ADCGS_MAX(1, (int)(((int64_t)*height * side + longer / 2) / longer));
}

/* ---- Lists that grow ---- */

/**
 * Makes a name that every program accepts: letters, digits and -, with _ for others. It is cut so that a number fits behind it.
 */
static void clean_name(char out[ADCGS_SOURCE_IMAGE_NAME], const char *text)
{
    snprintf(out, ADCGS_SOURCE_IMAGE_NAME, "%.50s", text);
    for (char *c = out; *c; c++)
        *c = isalnum((unsigned char)*c) || *c == '-' ? *c : '_';
    if (!*out)
        strcpy(out, "_");
}

/** Makes a name unique by appending a number. names are `size` bytes apart; the first n are used. */
static void make_unique(char name[ADCGS_SOURCE_IMAGE_NAME], const char *names, uint32_t n, size_t size)
{
    char wanted[ADCGS_SOURCE_IMAGE_NAME];
    memcpy(wanted, name, sizeof wanted);
    for (uint32_t i = 0, number = 2; i < n;) {
        if (strcmp(name, names + i * size)) {
            i++;
            continue;
        }
        snprintf(name, ADCGS_SOURCE_IMAGE_NAME, "%.50s-%u", wanted, number++);
        i = 0;
    }
}

/** Makes room for one more element in an array that grows by doubling; NULL, with a message, on failure. */
static void *grow_array(void *array, uint32_t n, size_t element, adcgs_error *error)
{
    if (n >= SHOTS_MAX) {
        adcgs_fail(error, ADCGS_ERR_DATA, "more than %d images: give fewer, or for a video use --frames", SHOTS_MAX);
        return NULL;
    }
    void *more = n & (n - 1) ? array : realloc(array, (n ? 2 * (size_t)n : 1) * element);
    if (!more)
        adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the list of images");
    return more;
}

adcgs_source_image *adcgs_source_images_add(adcgs_source_images *sources, uint32_t camera, const char *stem, adcgs_error *error)
{
    adcgs_source_image *all = grow_array(sources->list, sources->n, sizeof *all, error);
    if (!all)
        return NULL;
    sources->list = all;
    adcgs_source_image *source = &all[sources->n];
    *source = (adcgs_source_image){.camera = camera, .turn = ADCGS_PHOTO_UPRIGHT};
    clean_name(source->stem, stem);
    if (sources->kind != ADCGS_FOOTAGE_FILM || !sources->cameras[camera].video) /* frames of one video have numbers */
        make_unique(source->stem, all[0].stem, sources->n, sizeof *all);
    sources->n++;
    sources->cameras[camera].images++;
    return source;
}

adcgs_source_image_camera *adcgs_source_images_add_camera(adcgs_source_images *sources, const char *name, adcgs_error *error)
{
    adcgs_source_image_camera *all = grow_array(sources->cameras, sources->n_cameras, sizeof *all, error);
    if (!all)
        return NULL;
    sources->cameras = all;
    adcgs_source_image_camera *camera = &all[sources->n_cameras];
    *camera = (adcgs_source_image_camera){.frames = 0};
    clean_name(camera->name, name);
    make_unique(camera->name, all[0].name, sources->n_cameras, sizeof *all);
    memcpy(camera->folder, camera->name, sizeof camera->folder);
    sources->n_cameras++;
    return camera;
}
