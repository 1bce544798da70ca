/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Where sparse models lie. COLMAP writes several where images fall apart into groups that it cannot join, and the first need not
 * be the largest. Each has a world of its own, so that one is taken: the one with most images.
 */
#include "config.h"

#include "layouts/colmap_files.h"

#include "data/paths.h"
#include "layouts/colmap.h"
#include "layouts/listing.h"

#include <stdlib.h>

/** Places of the first group of which any is there count; later ones hold what was made on the way to them. */
static const struct {
    const char *whole[3]; /**< folders with a model each */
    const char *parent;   /**< of numbered folders, each with a model */
} groups[] = {
    {{"sparse/0/", "sparse/", ""}, "sparse/"},
    {{"colmap/sparse/0/", "colmap/sparse/", "colmap/"}, "colmap/sparse/"},  /* nerfstudio */
    {{"distorted/sparse/0/", "distorted/sparse/", NULL}, "distorted/sparse/"}, /* before images are straightened */
};

typedef struct search {
    const char *directory;
    int first; /**< the first is enough */
    adcgs_colmap_models *found;
    adcgs_error *error;
} search;

/** Images of a model; 0 where its list cannot be read. */
static size_t count_images(const adcgs_colmap_place *place)
{
    adcgs_colmap model = {0};
    adcgs_error unused;
    const int is_read = adcgs_colmap_has(place, ADCGS_COLMAP_IMAGES) &&
                        adcgs_colmap_load(&model, place, ADCGS_COLMAP_IMAGES, &unused) == ADCGS_OK;
    const size_t n = is_read ? model.n_images : 0;
    adcgs_colmap_clear(&model);
    return n;
}

/** Take a model in place of what was found, or leave it. Only where there are two is any counted. */
static void weigh(search *s, adcgs_colmap_place *here)
{
    adcgs_colmap_models *f = s->found;
    if (f->n++ == 0) {
        f->place = *here;
        return;
    }
    if (f->n == 2)
        f->images = count_images(&f->place);
    const size_t n = count_images(here);
    const int is_larger = n > f->images;
    if (is_larger || !f->other.folder || n > f->other_images) {
        adcgs_colmap_leave(&f->other);
        f->other = is_larger ? f->place : *here;
        f->other_images = is_larger ? f->images : n;
    } else
        adcgs_colmap_leave(here);
    if (is_larger) {
        f->place = *here;
        f->images = n;
    }
}

/** Look into "DIRECTORY/PLACE". */
static adcgs_status look(search *s, const char *place)
{
    adcgs_colmap_place here = {0};
    if (s->first && s->found->n)
        return ADCGS_OK;
    if (!adcgs_colmap_format(s->directory, place, &here.format))
        return ADCGS_OK;
    if (!(here.folder = adcgs_path("%s/%s", s->directory, place)))
        return adcgs_fail(s->error, ADCGS_ERR_MEMORY, "%s: out of memory", s->directory);
    weigh(s, &here);
    return ADCGS_OK;
}

static int is_later_number(const char *name)
{
    return strcmp(name, "0") && name[strspn(name, "0123456789")] == 0;
}

/** Numbered folders from 1 on. */
static adcgs_status look_at_numbers(search *s, const char *parent)
{
    adcgs_listing numbers;
    char *folder = adcgs_path("%s/%s", s->directory, parent), *place = NULL;
    adcgs_status status = folder ? ADCGS_OK : adcgs_fail(s->error, ADCGS_ERR_MEMORY, "%s: out of memory", s->directory);
    const int is_there = status == ADCGS_OK && adcgs_is_folder(folder);
    if (is_there && (status = adcgs_listing_read(&numbers, folder, is_later_number, s->error)) == ADCGS_OK) {
        for (size_t i = 0; status == ADCGS_OK && i < numbers.n; i++) {
            place = adcgs_path("%s%s/", parent, numbers.names[i]);
            status = place ? look(s, place) : adcgs_fail(s->error, ADCGS_ERR_MEMORY, "%s: out of memory", s->directory);
            free(place);
        }
        adcgs_listing_free(&numbers);
    }
    free(folder);
    return status;
}

adcgs_status adcgs_colmap_find(adcgs_colmap_models *out, const char *directory, int first, adcgs_error *error)
{
    search s = {.directory = directory, .first = first, .found = out, .error = error};
    adcgs_status status = ADCGS_OK;
    *out = (adcgs_colmap_models){.n = 0};
    for (size_t g = 0; status == ADCGS_OK && !out->n && g < ADCGS_COUNTOF(groups); g++) {
        for (size_t i = 0; status == ADCGS_OK && i < ADCGS_COUNTOF(groups[g].whole); i++)
            if (groups[g].whole[i])
                status = look(&s, groups[g].whole[i]);
        if (status == ADCGS_OK)
            status = look_at_numbers(&s, groups[g].parent);
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
    adcgs_colmap_models models;
    adcgs_error unused;
    const int found = adcgs_colmap_find(&models, folder, 1, &unused) == ADCGS_OK && models.n;
    adcgs_colmap_forget(&models);
    return found;
}
