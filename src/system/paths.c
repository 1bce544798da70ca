/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Names of files. */
#include "config.h"

#include "system/paths.h"

#include <dirent.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include <sys/stat.h>

char *adcgs_path(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *path = length < 0 ? NULL : malloc((size_t)length + 1);
    if (path) {
        va_start(arguments, format);
        vsnprintf(path, (size_t)length + 1, format, arguments);
        va_end(arguments);
    }
    return path;
}

int adcgs_is_there_at(const char *format, ...)
{
    char path[PATH_MAX];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(path, sizeof path, format, arguments);
    va_end(arguments);
    return length >= 0 && length < PATH_MAX && adcgs_is_there(path);
}

int adcgs_is_there(const char *path)
{
    struct stat status;
    return path && !lstat(path, &status);
}

int adcgs_is_folder(const char *path)
{
    struct stat status;
    return path && !stat(path, &status) && S_ISDIR(status.st_mode);
}

static const char *const extensions[] = {"", ".png", ".jpg", ".jpeg", ".exr", ".tif", ".tiff", ".webp", ".ppm"};

adcgs_status adcgs_find_image(char **out, const char *stem, adcgs_error *error)
{
    *out = NULL;
    for (size_t i = 0; i < ADCGS_COUNTOF(extensions); i++) {
        char *path = adcgs_path("%s%s", stem, extensions[i]);
        if (!path)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", stem);
        if (adcgs_is_there(path) && !adcgs_is_folder(path)) {
            *out = path;
            return ADCGS_OK;
        }
        free(path);
    }
    return ADCGS_OK;
}

/* ---- Another letter case ---- */

/** Number of characters, of n, before an extension of images; n if the name has none. */
static size_t stem_length(const char *name, size_t n)
{
    for (size_t i = 1; i < ADCGS_COUNTOF(extensions); i++) {
        const size_t length = strlen(extensions[i]);
        if (n > length && !strncasecmp(name + n - length, extensions[i], length))
            return n - length;
    }
    return n;
}

/** How well a name in a folder matches n characters: 2 except for letter case, 1 for an image with another extension, 0 else. */
static int likeness(const char *entry, const char *part, size_t n, int is_image)
{
    const size_t stem = is_image ? stem_length(part, n) : n;
    if (strlen(entry) >= n && !strncasecmp(entry, part, n) && !entry[n])
        return 2;
    if (!is_image || strlen(entry) <= stem || strncasecmp(entry, part, stem) != 0)
        return 0;
    for (size_t i = 1; i < ADCGS_COUNTOF(extensions); i++)
        if (!strcasecmp(entry + stem, extensions[i]))
            return 1;
    return 0;
}

static adcgs_status no_memory(const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

/** Finds the name in a folder that matches n characters best. *out is from malloc(), and NULL if none matches or several do. */
static adcgs_status find_like(char **out, const char *folder, const char *part, size_t n, int is_image, adcgs_error *error)
{
    DIR *directory = opendir(*folder ? folder : ".");
    int best = 0, several = 0, failed = 0;
    *out = NULL;
    for (struct dirent *entry; directory && !failed && (entry = readdir(directory));) {
        const int like = likeness(entry->d_name, part, n, is_image);
        several = like == best ? several || like : like > best ? 0 : several;
        if (like <= best)
            continue;
        best = like;
        free(*out);
        failed = !(*out = strdup(entry->d_name));
    }
    if (directory)
        closedir(directory);
    if (several) {
        free(*out);
        *out = NULL;
    }
    return failed ? no_memory(folder, error) : ADCGS_OK;
}

/** Appends the next part of a name, n characters, to a path from malloc(). *path becomes NULL if no name in it matches. */
static adcgs_status add_part(char **path, const char *part, size_t n, int is_image, adcgs_error *error)
{
    char *like = NULL, *exact = adcgs_path("%s%.*s/", *path, (int)n, part);
    if (!exact)
        return no_memory(*path, error);
    if (!is_image && adcgs_is_folder(exact)) {
        free(*path);
        *path = exact;
        return ADCGS_OK;
    }
    free(exact);
    ADCGS_TRY(find_like(&like, *path, part, n, is_image, error));
    char *longer = like ? adcgs_path("%s%s%s", *path, like, is_image ? "" : "/") : NULL;
    const adcgs_status status = like && !longer ? no_memory(*path, error) : ADCGS_OK;
    free(like);
    free(*path);
    *path = longer;
    return status;
}

adcgs_status adcgs_find_image_like(char **out, const char *folder, const char *name, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    *out = NULL;
    char *path = strdup(folder);
    if (!path)
        return no_memory(folder, error);
    for (const char *slash = name; status == ADCGS_OK && path && slash; name = slash + 1) {
        slash = strchr(name, '/');
        status = add_part(&path, name, slash ? (size_t)(slash - name) : strlen(name), !slash, error);
        if (!slash)
            break;
    }
    if (status == ADCGS_OK && path && !adcgs_is_folder(path)) {
        *out = path;
        path = NULL;
    }
    free(path);
    return status;
}
