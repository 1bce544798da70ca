/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The three files of a sparse model. */
#include "config.h"

#include "scene/layouts/colmap_files.h"

#include "scene/layouts/colmap.h"
#include "system/file.h"
#include "system/paths.h"

#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define FILE_MAX ((uint64_t)8 << 30) /* bytes */
#define FILES 3                      /* of a model; definition of COLMAP */

static const char *const names[FILES] = {"cameras", "images", "points3D"};

static const struct {
    const char *end;
    int is_text;
    adcgs_colmap_parse *parse[FILES];
} formats[] = {
    {"bin", 0, {adcgs_colmap_binary_cameras, adcgs_colmap_binary_images, adcgs_colmap_binary_points}},
    {"txt", 1, {adcgs_colmap_text_cameras, adcgs_colmap_text_images, adcgs_colmap_text_points}},
};

int adcgs_colmap_format(const char *directory, const char *place, int *format)
{
    for (*format = 0; *format < (int)ADCGS_COUNTOF(formats); ++*format)
        for (int f = 0; f < FILES; f++)
            if (adcgs_is_there_at("%s/%s%s.%s", directory, place, names[f], formats[*format].end))
                return 1;
    return 0;
}

/** The format of one of the files: that of the place, or the other if the file exists only in that. */
static int format_of(const adcgs_colmap_place *place, adcgs_colmap_file file)
{
    const int other = !place->format;
    const int has_own = adcgs_is_there_at("%s%s.%s", place->folder, names[file], formats[place->format].end);
    return !has_own && adcgs_is_there_at("%s%s.%s", place->folder, names[file], formats[other].end) ? other : place->format;
}

int adcgs_colmap_has(const adcgs_colmap_place *place, adcgs_colmap_file file)
{
    return adcgs_is_there_at("%s%s.%s", place->folder, names[file], formats[format_of(place, file)].end);
}

const char *adcgs_colmap_end(const adcgs_colmap_place *place, adcgs_colmap_file file)
{
    return formats[format_of(place, file)].end;
}

adcgs_status adcgs_colmap_load(adcgs_colmap *model, const adcgs_colmap_place *place, adcgs_colmap_file file, adcgs_error *error)
{
    const int format = format_of(place, file);
    char *path = adcgs_path("%s%s.%s", place->folder, names[file], formats[format].end);
    uint8_t *data = NULL;
    size_t bytes;
    if (!path)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", place->folder);
    model->path = path;
    model->error = error;
    adcgs_status status = formats[format].is_text ? adcgs_file_load_text(&data, &bytes, path, FILE_MAX, error)
                                                  : adcgs_file_load(&data, &bytes, path, FILE_MAX, error);
    if (status == ADCGS_ERR_IO && !adcgs_colmap_has(place, file))
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: no such file; a COLMAP model has cameras, images, points3D", path);
    if (status == ADCGS_OK)
        status = formats[format].parse[file](model, data, bytes);
    if (status == ADCGS_OK && file == ADCGS_COLMAP_POINTS)
        adcgs_points_round(&model->points);
    if (status == ADCGS_OK && file == ADCGS_COLMAP_CAMERAS)
        status = adcgs_colmap_sort_cameras(model);
    if (status == ADCGS_OK && file == ADCGS_COLMAP_IMAGES)
        status = adcgs_colmap_sort_images(model);
    free(data);
    free(path);
    model->path = NULL;
    return status;
}
