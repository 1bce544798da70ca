/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sorted contents of a folder. */
#include "config.h"

#include "media/listing.h"

#include "system/extension.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>

#define NAMES_MAX 1000000 /* of a folder; chosen by hand, not measured */

static int compare(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/** Returns 0, or -1 on allocation failure. */
static int append(adcgs_listing *listing, size_t *capacity, const char *name)
{
    if (listing->n == *capacity) {
        const size_t more = 2 * *capacity + 64;
        char **names = realloc(listing->names, more * sizeof *names);
        if (!names)
            return -1;
        listing->names = names;
        *capacity = more;
    }
    char *copy = strdup(name);
    if (!copy)
        return -1;
    listing->names[listing->n++] = copy;
    return 0;
}

adcgs_status adcgs_listing_read(adcgs_listing *out, const char *folder, int (*keep)(const char *name), adcgs_error *error)
{
    size_t capacity = 0;
    *out = (adcgs_listing){0};
    DIR *directory = opendir(folder);
    if (!directory)
        return adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot open: %s", folder, strerror(errno));
    adcgs_status status = ADCGS_OK;
    for (struct dirent *entry; status == ADCGS_OK && (entry = readdir(directory));) {
        if (entry->d_name[0] == '.' || !keep(entry->d_name))
            continue;
        if (out->n == NAMES_MAX)
            status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: more than %d files", folder, NAMES_MAX);
        else if (append(out, &capacity, entry->d_name))
            status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", folder);
    }
    closedir(directory);
    if (status != ADCGS_OK)
        adcgs_listing_free(out);
    else if (out->n)
        qsort(out->names, out->n, sizeof *out->names, compare);
    return status;
}

void adcgs_listing_free(adcgs_listing *listing)
{
    for (size_t i = 0; i < listing->n; i++)
        free(listing->names[i]);
    free(listing->names);
    *listing = (adcgs_listing){0};
}

int adcgs_is_visible_name(const char *name)
{
    return *name != '.';
}

int adcgs_is_image_name(const char *name)
{
    static const char *const ends[] = {"png", "jpg", "jpeg", "exr", "tif", "tiff", "webp", "ppm"};
    const char *extension = adcgs_extension(name);
    for (size_t i = 0; i < ADCGS_COUNTOF(ends); i++)
        if (!strcasecmp(extension, ends[i]))
            return 1;
    return 0;
}

void adcgs_stem(char *out, size_t size, const char *path)
{
    const char *slash = strrchr(path, '/');
    snprintf(out, size, "%s", slash ? slash + 1 : path);
    char *dot = strrchr(out, '.');
    if (dot && dot != out)
        *dot = 0;
}

#define COUNTING_LEAST 3 /* names, at least: two always have one step; arithmetic */

void adcgs_counting_add(adcgs_counting *counting, const char *stem)
{
    size_t before = strlen(stem);
    while (before && stem[before - 1] >= '0' && stem[before - 1] <= '9')
        before--;
    const long long number = strtoll(stem + before, NULL, 10);
    if (!stem[before] || before >= sizeof counting->before)
        counting->is_other = 1;
    else if (!counting->n)
        snprintf(counting->before, sizeof counting->before, "%.*s", (int)before, stem);
    else if (strlen(counting->before) != before || strncmp(stem, counting->before, before))
        counting->is_other = 1;
    else if (counting->n == 1)
        counting->step = number - counting->last;
    else if (number - counting->last != counting->step)
        counting->is_other = 1;
    counting->last = number;
    counting->n++;
}

int adcgs_counting_holds(const adcgs_counting *counting)
{
    return counting->n >= COUNTING_LEAST && counting->step > 0 && !counting->is_other;
}
