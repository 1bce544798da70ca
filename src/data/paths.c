/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Names of files. */
#include "config.h"

#include "data/paths.h"

#include <errno.h>
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

int adcgs_is_file(const char *path)
{
    struct stat status;
    return path && !stat(path, &status) && S_ISREG(status.st_mode);
}

int adcgs_is_folder(const char *path)
{
    struct stat status;
    return path && !stat(path, &status) && S_ISDIR(status.st_mode);
}

/** Why a symbolic link leads nowhere; 0 if it leads somewhere, or is none. */
static int broken_link(const char *path)
{
    struct stat status;
    if (lstat(path, &status) || !S_ISLNK(status.st_mode) || !stat(path, &status))
        return 0;
    return errno;
}

adcgs_status adcgs_find_image(char **out, const char *stem, adcgs_error *error)
{
    static const char *const extensions[] = {"", ".png", ".jpg", ".jpeg", ".exr", ".tif", ".tiff", ".webp", ".ppm"};
    *out = NULL;
    for (size_t i = 0; i < ADCGS_COUNTOF(extensions); i++) {
        char *path = adcgs_path("%s%s", stem, extensions[i]);
        if (!path)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", stem);
        if (adcgs_is_file(path)) {
            *out = path;
            return ADCGS_OK;
        }
        const int reason = broken_link(path);
        if (reason)
            adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open: %s", path, strerror(reason));
        free(path);
        if (reason)
            return ADCGS_ERR_IO;
    }
    return ADCGS_OK;
}
