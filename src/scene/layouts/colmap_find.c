/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Locations of sparse models. COLMAP writes several models if images form groups that it cannot join, and the first need not be
 * the largest. Each model has a world of its own, so only one is used: the one with most images.
 */
#include "config.h"

#include "scene/layouts/colmap_files.h"

#include "scene/layouts/colmap.h"
#include "system/paths.h"

#include <stdio.h>
#include <stdlib.h>

#define NUMBERS 64 /* of models below one folder; COLMAP writes at most 50 by default; chosen by hand, not measured */

/** Only the first group with any model counts: later groups hold intermediate models. */
static const struct {
    const char *whole[3]; /**< folders with a model each */
    const char *parent;   /**< of numbered folders, each with a model */
} groups[] = {
    {{"sparse/0/", "sparse/", ""}, "sparse/"},
    {{"colmap/sparse/0/", "colmap/sparse/", "colmap/"}, "colmap/sparse/"},     /* nerfstudio */
    {{"distorted/sparse/0/", "distorted/sparse/", NULL}, "distorted/sparse/"}, /* before images are undistorted */
};

typedef struct search {
    const char *directory;
    int first; /**< stop at the first model */
    adcgs_colmap_models *found;
    adcgs_error *error;
} search;

/** Counts the images of a model; 0 if their list cannot be read. */
static adcgs_status count_images(const search *s, const adcgs_colmap_place *place, size_t *n)
{
    adcgs_colmap model = {0};
    const adcgs_status status =
        adcgs_colmap_has(place, ADCGS_COLMAP_IMAGES) ? adcgs_colmap_load(&model, place, ADCGS_COLMAP_IMAGES, s->error) : ADCGS_OK;
    *n = status == ADCGS_OK ? model.n_images : 0;
    adcgs_colmap_clear(&model);
    return status == ADCGS_ERR_MEMORY ? status : ADCGS_OK;
}

/** Keeps the larger of two models. */
static void weigh(adcgs_colmap_models *f, adcgs_colmap_place *here, size_t images)
{
    const int is_larger = images > f->images;
    if (is_larger || !f->other.folder || images > f->other_images) {
        adcgs_colmap_leave(&f->other);
        f->other = is_larger ? f->place : *here;
        f->other_images = is_larger ? f->images : images;
    } else
        adcgs_colmap_leave(here);
    if (is_larger) {
        f->place = *here;
        f->images = images;
    }
}

/** Adds a model that exists. Images are counted only if there are two or more models. */
static adcgs_status add(search *s, adcgs_colmap_place *here)
{
    adcgs_colmap_models *f = s->found;
    size_t images = 0;
    adcgs_status status = f->n == 1 ? count_images(s, &f->place, &f->images) : ADCGS_OK;
    if (status == ADCGS_OK && f->n)
        status = count_images(s, here, &images);
    if (status != ADCGS_OK)
        adcgs_colmap_leave(here);
    else if (f->n++)
        weigh(f, here, images);
    else
        f->place = *here;
    return status;
}

/** Looks into "DIRECTORY/PLACE". */
static adcgs_status search_folder(search *s, const char *place)
{
    adcgs_colmap_place here = {0};
    if ((s->first && s->found->n) || !adcgs_colmap_format(s->directory, place, &here.format))
        return ADCGS_OK;
    if (!(here.folder = adcgs_path("%s/%s", s->directory, place)))
        return adcgs_fail(s->error, ADCGS_ERR_MEMORY, "%s: out of memory", s->directory);
    return add(s, &here);
}

adcgs_status adcgs_colmap_find(adcgs_colmap_models *out, const char *directory, int first, adcgs_error *error)
{
    search s = {.directory = directory, .first = first, .found = out, .error = error};
    adcgs_status status = ADCGS_OK;
    *out = (adcgs_colmap_models){.n = 0};
    for (size_t g = 0; status == ADCGS_OK && !out->n && g < ADCGS_COUNTOF(groups); g++) {
        for (size_t i = 0; status == ADCGS_OK && i < ADCGS_COUNTOF(groups[g].whole); i++)
            if (groups[g].whole[i])
                status = search_folder(&s, groups[g].whole[i]);
        for (int number = 1; status == ADCGS_OK && number < NUMBERS; number++) {
            char place[64];
            snprintf(place, sizeof place, "%s%d/", groups[g].parent, number);
            status = search_folder(&s, place);
        }
    }
    if (status != ADCGS_OK)
        adcgs_colmap_forget(out);
    return status;
}

void adcgs_colmap_leave(adcgs_colmap_place *place)
{
    free(place->folder);
    place->folder = NULL;
}

void adcgs_colmap_forget(adcgs_colmap_models *models)
{
    adcgs_colmap_leave(&models->place);
    adcgs_colmap_leave(&models->other);
    models->n = 0;
}

int adcgs_is_colmap(const char *folder)
{
    int format;
    for (size_t g = 0; g < ADCGS_COUNTOF(groups); g++) {
        for (size_t i = 0; i < ADCGS_COUNTOF(groups[g].whole); i++)
            if (groups[g].whole[i] && adcgs_colmap_format(folder, groups[g].whole[i], &format))
                return 1;
        for (int number = 1; number < NUMBERS; number++) {
            char place[64];
            snprintf(place, sizeof place, "%s%d/", groups[g].parent, number);
            if (adcgs_colmap_format(folder, place, &format))
                return 1;
        }
    }
    return 0;
}
