/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Names of files. */
#include "config.h"

#include "data/paths.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
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

adcgs_status adcgs_find_image(char **out, const char *stem, adcgs_error *error)
{
    static const char *const extensions[] = {"", ".png", ".jpg", ".jpeg", ".exr", ".tif", ".tiff", ".webp", ".ppm"};
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
