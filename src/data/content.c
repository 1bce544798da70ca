/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What the files of a scene's views hold. */
#include "config.h"

#include "data/content.h"

#include "base/digest.h"
#include "io/file.h"

#include <stdlib.h>

#define PIECE ((size_t)1 << 18)

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
    for (uint32_t i = 0; status == ADCGS_OK && i < scene->n_views[split]; i++) {
        const adcgs_scene_view *view = &scene->views[split][i];
        if (!last || strcmp(view->path, last)) /* views of a video follow each other */
            status = add_file(&md5, buffer, view->path, error);
        if (status == ADCGS_OK && view->mask)
            status = add_file(&md5, buffer, view->mask, error);
        last = view->path;
    }
    adcgs_md5_final(&md5, digest);
    free(buffer);
    return status;
}
