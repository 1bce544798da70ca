/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images without a pose next to those of a scene. */
#include "config.h"

#include "scene/layouts/unposed.h"

#include "media/listing.h"
#include "system/paths.h"

#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define DEPTH_MOST 4      /* nesting of folders that is searched; also bounds circular links */
#define FOLDERS_MOST 1000 /* limit of subfolders of one folder */

/** Stems of the views' paths, sorted. */
typedef struct stems {
    char **list;
    size_t n;
} stems;

/** Returns a path without its extension, and without parts that are empty or ".", from malloc(). */
static char *stem_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    const size_t n = dot && (!slash || dot > slash + 1) ? (size_t)(dot - path) : strlen(path);
    char *stem = strndup(path, n);
    for (char *c = stem; c && (c = strchr(c, '/'));) {
        const size_t more = c[1] == '/' ? 1 : c[1] == '.' && c[2] == '/' ? 2 : 0;
        if (more)
            memmove(c, c + more, strlen(c + more) + 1);
        else
            c++;
    }
    return stem;
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

static adcgs_status no_memory(const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

static adcgs_status list_views(stems *s, const adcgs_scene *scene, adcgs_error *error)
{
    size_t all = 0;
    for (int split = 0; split < ADCGS_SPLITS; split++)
        all += scene->n_views[split];
    *s = (stems){.list = calloc(all + 1, sizeof *s->list)};
    for (int split = 0; s->list && split < ADCGS_SPLITS; split++)
        for (uint32_t i = 0; i < scene->n_views[split]; i++) {
            if (!(s->list[s->n] = stem_of(scene->views[split][i].path)))
                return no_memory(scene->directory, error);
            s->n++;
        }
    if (s->n)
        qsort(s->list, s->n, sizeof *s->list, compare);
    return s->list ? ADCGS_OK : no_memory(scene->directory, error);
}

typedef struct counter {
    stems posed;
    size_t all, unposed;
    adcgs_error *error;
} counter;

static adcgs_status count_image(counter *c, const char *path)
{
    char *stem = stem_of(path);
    if (!stem)
        return no_memory(path, c->error);
    c->all++;
    c->unposed += !c->posed.n || !bsearch(&stem, c->posed.list, c->posed.n, sizeof *c->posed.list, compare);
    free(stem);
    return ADCGS_OK;
}

/** Counts images below a folder, which ends with its slash. An unreadable folder counts as empty. */
static adcgs_status count(counter *c, const char *folder, int depth)
{
    adcgs_listing listing;
    size_t folders = 0;
    adcgs_status status = adcgs_listing_read(&listing, folder, adcgs_is_visible_name, c->error);
    if (status != ADCGS_OK)
        return status == ADCGS_ERR_MEMORY ? status : ADCGS_OK;
    for (size_t i = 0; status == ADCGS_OK && i < listing.n; i++) {
        const int is_image = adcgs_is_image_name(listing.names[i]);
        char *path = adcgs_path("%s%s%s", folder, listing.names[i], is_image ? "" : "/");
        if (!path)
            status = no_memory(folder, c->error);
        else if (is_image)
            status = count_image(c, path);
        else if (depth && adcgs_is_folder(path) && ++folders <= FOLDERS_MOST)
            status = count(c, path, depth - 1);
        free(path);
    }
    adcgs_listing_free(&listing);
    return status;
}

adcgs_status adcgs_unposed_remark(adcgs_scene *scene, const char *folder, adcgs_error *error)
{
    counter c = {.error = error};
    adcgs_status status = list_views(&c.posed, scene, error);
    if (status == ADCGS_OK)
        status = count(&c, folder, DEPTH_MOST);
    clear(&c.posed);
    const size_t above = strlen(scene->directory);
    const char *const below = strncmp(folder, scene->directory, above) || folder[above] != '/' ? folder : folder + above + 1;
    if (status == ADCGS_OK && c.unposed == 1)
        adcgs_scene_remark(scene, "1 of %zu images in %s has no pose: it is left out", c.all, below);
    else if (status == ADCGS_OK && c.unposed)
        adcgs_scene_remark(scene, "%zu of %zu images in %s have no pose: they are left out", c.unposed, c.all, below);
    return status;
}
