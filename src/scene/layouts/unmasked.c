/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images without a mask in a scene with a folder of masks. A mask that is not found would be missed without a warning. */
#include "config.h"

#include "scene/layouts/unmasked.h"

#include "media/listing.h"
#include "system/paths.h"

#include <stdlib.h>

adcgs_status adcgs_unmasked_remark(adcgs_scene *scene, const char *how, adcgs_error *error)
{
    static const char *const folders[] = {"masks", "mask"};
    size_t all = 0, without = 0;
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t i = 0; i < scene->n_views[s]; i++) {
            all++;
            without += !scene->views[s][i].mask;
        }
    for (size_t k = 0; without && !scene->is_outline && k < ADCGS_COUNTOF(folders); k++) {
        adcgs_listing listing;
        char *const path = adcgs_path("%s/%s", scene->directory, folders[k]);
        if (!path)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", scene->directory);
        const int is_there = adcgs_is_folder(path);
        const adcgs_status status = is_there ? adcgs_listing_read(&listing, path, adcgs_is_visible_name, error) : ADCGS_OK;
        free(path);
        if (status == ADCGS_ERR_MEMORY)
            return status;
        if (!is_there || status != ADCGS_OK)
            continue;
        if (listing.n)
            adcgs_scene_remark(scene, "folder %s exists, but %zu of %zu images %s no mask %s: no pixels of %s are masked",
                               folders[k], without, all, without > 1 ? "have" : "has", how, without > 1 ? "them" : "it");
        adcgs_listing_free(&listing);
    }
    return ADCGS_OK;
}
