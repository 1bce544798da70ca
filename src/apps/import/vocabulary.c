/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Finds COLMAP's vocabulary tree. */
#include "config.h"

#include "apps/import/vocabulary.h"

#include "media/listing.h"
#include "system/paths.h"

#include <stdlib.h>

/** COLMAP's cache puts a checksum before the name, as "a37d...-vocab_tree_faiss_flickr100K_words256K.bin". */
static int is_tree(const char *name)
{
    const size_t n = strlen(name);
    return strstr(name, "vocab_tree") && n > 4 && !strcmp(name + n - 4, ".bin");
}

/** Looks in a folder, which need not exist. */
static adcgs_status look_in(char **out, const char *folder, int is_faiss, adcgs_error *error)
{
    adcgs_listing names;
    if (!adcgs_is_folder(folder) || adcgs_listing_read(&names, folder, is_tree, error) != ADCGS_OK)
        return ADCGS_OK; /* a tree that cannot be read is none */
    adcgs_status status = ADCGS_OK;
    for (size_t i = 0; i < names.n && !*out && status == ADCGS_OK; i++)
        if ((strstr(names.names[i], "faiss") != NULL) == is_faiss && !(*out = adcgs_path("%s/%s", folder, names.names[i])))
            status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", folder);
    adcgs_listing_free(&names);
    return status;
}

adcgs_status adcgs_import_find_vocabulary(char **out, int is_faiss, adcgs_error *error)
{
    const char *const cache = getenv("XDG_CACHE_HOME"), *const home = getenv("HOME");
    char *own = cache && *cache ? adcgs_path("%s/colmap", cache) : adcgs_path("%s/.cache/colmap", home ? home : "");
    const char *const folders[] = {own, "/usr/local/share/colmap", "/usr/share/colmap"};
    adcgs_status status = own ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a path");
    *out = NULL;
    for (size_t i = 0; i < ADCGS_COUNTOF(folders) && status == ADCGS_OK && !*out; i++)
        status = look_in(out, folders[i], is_faiss, error);
    free(own);
    return status;
}
