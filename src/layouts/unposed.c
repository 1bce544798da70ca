/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images that lie beside those of a scene, without a pose. */
#include "config.h"

#include "layouts/unposed.h"

#include "data/paths.h"
#include "layouts/listing.h"

#include <stdlib.h>

#define DEPTH_MOST 4         /* folders below each other; also where links make a circle */
#define FOLDERS_MOST 1000    /* of one folder */

/** Stems of the views' paths, sorted. */
typedef struct stems {
    char **list;
    size_t n;
} stems;

/** A path without its extension, from malloc(). */
static char *stem_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    const size_t n = dot && (!slash || dot > slash + 1) ? (size_t)(dot - path) : strlen(path);
    return strndup(path, n);
}

static int compare(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void clear(stems *s)
{
    for (size_t i = 0; i < s->n; i++)
        free(s->list[i]);
    free(s->list);
}

/** 0, or -1 without memory. */
static int list_views(stems *s, const adcgs_scene *scene)
{
    size_t all = 0;
    for (int split = 0; split < ADCGS_SPLITS; split++)
        all += scene->n_views[split];
    *s = (stems){.list = calloc(all + 1, sizeof *s->list)};
    for (int split = 0; s->list && split < ADCGS_SPLITS; split++)
        for (uint32_t i = 0; i < scene->n_views[split]; i++)
            if ((s->list[s->n] = stem_of(scene->views[split][i].path)))
                s->n++;
    if (s->n)
        qsort(s->list, s->n, sizeof *s->list, compare);
    return s->list && s->n == all ? 0 : -1;
}

static int is_posed(const stems *s, const char *path)
{
    char *stem = stem_of(path);
    const int found = !stem || (s->n && bsearch(&stem, s->list, s->n, sizeof *s->list, compare));
    free(stem);
    return found;
}

static int is_anything(const char *name)
{
    return *name != '.';
}

/** Images below a folder, which ends with its slash, and how many of them are none of the views'. */
static void count(const stems *s, const char *folder, int depth, size_t *all, size_t *unposed)
{
    adcgs_listing listing;
    adcgs_error unused;
    size_t folders = 0;
    if (adcgs_listing_read(&listing, folder, is_anything, &unused) != ADCGS_OK)
        return;
    for (size_t i = 0; i < listing.n; i++) {
        const int is_image = adcgs_is_image_name(listing.names[i]);
        char *path = adcgs_path("%s%s%s", folder, listing.names[i], is_image ? "" : "/");
        if (path && is_image) {
            *all += 1;
            *unposed += !is_posed(s, path);
        } else if (path && depth && adcgs_is_folder(path) && ++folders <= FOLDERS_MOST)
            count(s, path, depth - 1, all, unposed);
        free(path);
    }
    adcgs_listing_free(&listing);
}

void adcgs_unposed_remark(adcgs_scene *scene, const char *folder)
{
    stems s;
    size_t all = 0, unposed = 0;
    if (list_views(&s, scene) == 0)
        count(&s, folder, DEPTH_MOST, &all, &unposed);
    clear(&s);
    const size_t above = strlen(scene->directory);
    const char *const below = strncmp(folder, scene->directory, above) || folder[above] != '/' ? folder : folder + above + 1;
    if (unposed == 1)
        adcgs_scene_remark(scene, "1 of %zu images in %s has no pose: it is left out", all, below);
    else if (unposed)
        adcgs_scene_remark(scene, "%zu of %zu images in %s have no pose: they are left out", unposed, all, below);
}
