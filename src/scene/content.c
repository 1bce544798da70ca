/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Digests of the files and the metadata of a scene. */
#include "config.h"

#include "scene/content.h"

#include "base/digest.h"
#include "scene/splat_views.h"
#include "system/file.h"

#include <stdlib.h>

#define PIECE ((size_t)1 << 18) /* bytes read at a time; chosen by hand, not measured */

static adcgs_status add_file(adcgs_md5 *md5, uint8_t *buffer, const char *path, adcgs_error *error)
{
    FILE *file;
    uint64_t size = 0;
    uint8_t text[8];
    ADCGS_TRY(adcgs_file_open(&file, path, error));
    for (size_t n; (n = fread(buffer, 1, PIECE, file)) > 0; size += n)
        adcgs_md5_update(md5, buffer, n);
    const int bad = ferror(file);
    fclose(file);
    if (bad)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot read", path);
    adcgs_store_le64(text, size);
    adcgs_md5_update(md5, text, sizeof text);
    return ADCGS_OK;
}

adcgs_status adcgs_scene_content(const adcgs_scene *scene, adcgs_split split, uint8_t digest[ADCGS_CONTENT_BYTES],
                                 adcgs_error *error)
{
    adcgs_md5 md5;
    adcgs_status status = ADCGS_OK;
    const char *last = NULL;
    uint8_t *buffer = malloc(PIECE);
    if (!buffer)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", scene->directory);
    adcgs_md5_init(&md5);
    const adcgs_dynamic *const dynamic = scene->splats ? scene->splats->dynamic : NULL;
    const char *path;
    for (uint32_t i = 0; dynamic && status == ADCGS_OK && (path = adcgs_dynamic_path(dynamic, i)); i++)
        status = add_file(&md5, buffer, path, error);
    for (uint32_t i = 0; !dynamic && status == ADCGS_OK && i < scene->n_views[split]; i++) {
        const adcgs_scene_view *view = &scene->views[split][i];
        if (!last || strcmp(view->path, last)) /* views of one video are adjacent */
            status = add_file(&md5, buffer, view->path, error);
        if (status == ADCGS_OK && view->mask)
            status = add_file(&md5, buffer, view->mask, error);
        last = view->path;
    }
    adcgs_md5_final(&md5, digest);
    free(buffer);
    return status;
}

/* ---- Metadata ---- */

static void add_numbers(adcgs_md5 *md5, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        uint8_t text[8];
        uint64_t bits;
        memcpy(&bits, &x[i], sizeof bits);
        adcgs_store_le64(text, bits);
        adcgs_md5_update(md5, text, sizeof text);
    }
}

static void add_view(adcgs_md5 *md5, const adcgs_scene_view *v)
{
    const adcgs_camera *c = &v->camera;
    const adcgs_lens *l = &v->lens;
    const double numbers[] = {v->time, (double)v->frame, v->is_video, v->mask != NULL, c->width, c->height, c->fx, c->fy, c->cx,
                              c->cy,   c->near_plane,    l->width,    l->height,       l->fx,    l->fy,     l->cx, l->cy, l->skew,
                              l->k8,   l->p[0],          l->p[1],     l->is_fisheye};
    add_numbers(md5, numbers, ADCGS_COUNTOF(numbers));
    add_numbers(md5, l->k, ADCGS_COUNTOF(l->k));
    add_numbers(md5, c->cam_to_world, ADCGS_COUNTOF(c->cam_to_world));
}

static void add_points(adcgs_md5 *md5, const adcgs_points *points)
{
    for (uint32_t i = 0; i < points->n; i++) {
        add_numbers(md5, points->position[i], 3);
        adcgs_md5_update(md5, points->colour[i], sizeof points->colour[i]);
    }
}

void adcgs_scene_outline(const adcgs_scene *scene, uint8_t digest[ADCGS_CONTENT_BYTES])
{
    adcgs_md5 md5;
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    const double facts[] =
        {n,           scene->duration, (double)scene->rate.num, (double)scene->rate.den, scene->n_times, scene->splats != NULL,
         scene->axes, scene->units,    scene->colour_space,     scene->points.n};
    adcgs_md5_init(&md5);
    add_numbers(&md5, facts, ADCGS_COUNTOF(facts));
    for (uint32_t i = 0; i < n; i++)
        add_view(&md5, &scene->views[ADCGS_SPLIT_TRAIN][i]);
    add_points(&md5, &scene->points);
    adcgs_md5_final(&md5, digest);
}
