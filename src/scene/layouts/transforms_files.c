/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Locates the files named by transforms files, which may come from another machine. */
#include "config.h"

#include "scene/layouts/transforms_files.h"

#include "system/paths.h"

#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define DIVIDE_MAX 64 /* largest N of images_N and masks_N */
#define PARTS_MOST 3  /* last parts of an absolute path that are searched below the folder */

char *adcgs_transforms_join(const char *folder, const char *name)
{
    while (name[0] == '.' && name[1] == '/')
        name += 2;
    return adcgs_path("%s%s", *name == '/' ? "" : folder, name);
}

static int has_drive(const char *name)
{
    return ((*name >= 'A' && *name <= 'Z') || (*name >= 'a' && *name <= 'z')) && name[1] == ':' &&
           (name[2] == '\\' || name[2] == '/');
}

int adcgs_is_windows_path(const char *name)
{
    return has_drive(name) || strchr(name, '\\');
}

static adcgs_status no_memory(const char *name, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", name);
}

static adcgs_status try_name(char **out, const char *folder, const char *name, adcgs_error *error)
{
    char *stem = adcgs_transforms_join(folder, name);
    const adcgs_status status = stem ? adcgs_find_image(out, stem, error) : no_memory(name, error);
    free(stem);
    return status;
}

/** Tries the last parts of a name, the most parts first. */
static adcgs_status try_parts(char **out, const char *folder, const char *name, adcgs_error *error)
{
    const char *parts[PARTS_MOST];
    int n = 0;
    for (const char *end = name + strlen(name); n < PARTS_MOST && end > name;) {
        const char *slash = end;
        while (slash > name && slash[-1] != '/')
            slash--;
        parts[n++] = slash;
        end = slash > name ? slash - 1 : name;
    }
    while (n > 0 && !*out)
        ADCGS_TRY(try_name(out, folder, parts[--n], error));
    return ADCGS_OK;
}

/** Tries images_N/ for a name whose last folder is images/, and likewise masks_N/. */
static adcgs_status try_reduced(char **out, const char *folder, const char *name, adcgs_error *error)
{
    static const char *const kinds[] = {"images/", "masks/"};
    const char *slash = strrchr(name, '/');
    for (size_t k = 0; slash && !*out && k < ADCGS_COUNTOF(kinds); k++) {
        const size_t length = strlen(kinds[k]), before = (size_t)(slash + 1 - name);
        if (before < length || strncmp(slash + 1 - length, kinds[k], length) || (before > length && slash[-(long)length] != '/'))
            continue;
        for (int n = 2; !*out && n <= DIVIDE_MAX; n++) {
            char *reduced = adcgs_path("%.*s_%d%s", (int)before - 1, name, n, slash);
            const adcgs_status status = reduced ? try_name(out, folder, reduced, error) : no_memory(name, error);
            free(reduced);
            ADCGS_TRY(status);
        }
    }
    return ADCGS_OK;
}

adcgs_status adcgs_transforms_find(char **out, const char *folder, const char *name, adcgs_error *error)
{
    ADCGS_TRY(try_name(out, folder, name, error));
    if (*out)
        return ADCGS_OK;
    char *plain = strdup(name);
    if (!plain)
        return no_memory(name, error);
    for (char *c = plain; (c = strchr(c, '\\'));)
        *c = '/';
    adcgs_status status = strcmp(plain, name) ? try_name(out, folder, plain, error) : ADCGS_OK;
    if (status == ADCGS_OK && !*out && (has_drive(plain) || *plain == '/'))
        status = try_parts(out, folder, plain, error);
    if (status == ADCGS_OK && !*out)
        status = try_reduced(out, folder, plain, error);
    if (status == ADCGS_OK && !*out && *plain != '/' && !has_drive(plain))
        status = adcgs_find_image_like(out, folder, plain, error);
    free(plain);
    return status;
}
