/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The footage of a fixed camera: a video, or numbered images. */
#include "config.h"

#include "scene/layouts/footage.h"

#include "media/video/video.h"
#include "media/listing.h"
#include "system/paths.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define VIEWS_MAX 1000000 /* limit of a scene's views; a view takes some hundred bytes */
#define FIRST_CAPACITY 64 /* elements of an array that grows by doubling */
#define GAP_MAX 1000      /* numbers that are tried after the last image of a sequence without a count */

static adcgs_status no_memory(const char *path, adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

void adcgs_footage_clear(adcgs_footage *footage)
{
    for (int64_t i = 0; footage->pictures && i < footage->frames; i++)
        free(footage->pictures[i]);
    free(footage->pictures);
    free(footage->video);
    *footage = (adcgs_footage){0};
}

adcgs_status adcgs_footage_video(adcgs_footage *out, const char *path, adcgs_error *error)
{
    adcgs_video *video;
    *out = (adcgs_footage){0};
    ADCGS_TRY(adcgs_video_open(&video, path, error));
    const adcgs_video_info *info = adcgs_video_get_info(video);
    *out = (adcgs_footage){.video = strdup(path),
                           .frames = info->frames,
                           .width = info->width,
                           .height = info->height,
                           .rate = info->rate};
    adcgs_video_close(&video);
    return out->video ? ADCGS_OK : no_memory(path, error);
}

/** Finds the size of the images from the first one. */
static adcgs_status probe(adcgs_footage *footage, adcgs_error *error)
{
    int channels;
    return adcgs_image_probe(&footage->width, &footage->height, &channels, footage->pictures[0], error);
}

adcgs_status adcgs_footage_folder(adcgs_footage *out, const char *folder, adcgs_error *error)
{
    adcgs_listing listing;
    *out = (adcgs_footage){0};
    ADCGS_TRY(adcgs_listing_read(&listing, folder, adcgs_is_image_name, error));
    adcgs_status status = ADCGS_OK;
    if (!listing.n)
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: no image in this folder", folder);
    else if (!(out->pictures = calloc(listing.n, sizeof *out->pictures)))
        status = no_memory(folder, error);
    for (size_t i = 0; status == ADCGS_OK && i < listing.n; i++) {
        out->frames = (int64_t)i + 1;
        if (!(out->pictures[i] = adcgs_path("%s/%s", folder, listing.names[i])))
            status = no_memory(folder, error);
    }
    adcgs_listing_free(&listing);
    if (status == ADCGS_OK)
        status = probe(out, error);
    if (status != ADCGS_OK)
        adcgs_footage_clear(out);
    return status;
}

/* ---- Numbered images ---- */

/** Finds the position of the number and its zero-padded width. Returns 0 without a number, -1 for an invalid pattern. */
static int find_number(const char *pattern, size_t *at, size_t *after, int *width)
{
    const char *percent = strchr(pattern, '%'), *end = percent;
    *width = 0;
    if (!percent)
        return 0;
    if (*++end == '0')
        end++;
    for (; *end >= '0' && *end <= '9' && *width < 100; end++)
        *width = 10 * *width + (*end - '0');
    if (*end != 'd' || *width > 20 || (*width && percent[1] != '0') || strchr(end, '%'))
        return -1;
    *at = (size_t)(percent - pattern);
    *after = (size_t)(end + 1 - pattern);
    return 1;
}

int adcgs_footage_is_row(const char *pattern)
{
    size_t at, after;
    int width;
    return strlen(pattern) <= INT_MAX / 2 && find_number(pattern, &at, &after, &width) > 0;
}

char *adcgs_footage_number(const char *folder, const char *pattern, int64_t number)
{
    size_t at, after;
    int width;
    return find_number(pattern, &at, &after, &width) > 0
               ? adcgs_path("%s%.*s%0*lld%s", folder, (int)at, pattern, width, (long long)number, pattern + after)
               : adcgs_path("%s%s", folder, pattern);
}

/** Appends the image of a number; *found is 0 if it does not exist. */
static adcgs_status add_picture(adcgs_footage *out, size_t *capacity, const char *folder, const char *pattern, int64_t number,
                                int *found, adcgs_error *error)
{
    char *path = adcgs_footage_number(folder, pattern, number);
    if (path && (size_t)out->frames == *capacity) {
        const size_t more = 2 * *capacity + FIRST_CAPACITY;
        char **pictures = realloc(out->pictures, more * sizeof *pictures);
        if (pictures) {
            out->pictures = pictures;
            *capacity = more;
        }
    }
    if (!path || (size_t)out->frames == *capacity) {
        free(path);
        return no_memory(pattern, error);
    }
    *found = adcgs_is_there(path);
    if (*found) {
        out->pictures[out->frames++] = path;
        return ADCGS_OK;
    }
    adcgs_fail(error, ADCGS_ERR_DATA, "%s: no such image", path);
    free(path);
    return ADCGS_OK;
}

/** A sequence ends at its first missing number. An image with a later number shows that this one is missing. */
static adcgs_status check_gap(const char *folder, const char *pattern, int64_t missing, adcgs_error *error)
{
    for (int64_t number = missing + 1; number <= missing + GAP_MAX; number++) {
        char *path = adcgs_footage_number(folder, pattern, number);
        const int found = adcgs_is_there(path);
        free(path);
        if (!found)
            continue;
        char *gap = adcgs_footage_number(folder, pattern, missing);
        adcgs_fail(error, ADCGS_ERR_DATA,
                   "%s: no such image, but number %lld exists: if the sequence ends before, give its "
                   "count",
                   gap ? gap : pattern, (long long)number);
        free(gap);
        return ADCGS_ERR_DATA;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_footage_pattern(adcgs_footage *out, const char *folder, const char *pattern, int64_t first, int64_t count,
                                   adcgs_error *error)
{
    size_t at, after, capacity = 0;
    int width, found = 1;
    *out = (adcgs_footage){0};
    const int numbers = find_number(pattern, &at, &after, &width);
    if (numbers < 0 || strlen(pattern) > INT_MAX / 2)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: expected the name of an image with one number, such as %%d or %%05d",
                          pattern);
    if (!numbers && count > 1)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %lld images, but no %%d for their numbers", pattern, (long long)count);
    const int64_t most = !numbers ? 1 : count ? count : VIEWS_MAX;
    adcgs_status status = ADCGS_OK;
    while (status == ADCGS_OK && found && out->frames < most)
        status = add_picture(out, &capacity, folder, pattern, first + out->frames, &found, error);
    if (status == ADCGS_OK && !found && (count || !out->frames))
        status = ADCGS_ERR_DATA; /* the message is already set */
    if (status == ADCGS_OK && !found)
        status = check_gap(folder, pattern, first + out->frames, error);
    if (status == ADCGS_OK)
        status = probe(out, error);
    if (status != ADCGS_OK)
        adcgs_footage_clear(out);
    return status;
}

/* ---- Views ---- */

/** Makes room for more views of a split. */
static adcgs_status reserve(adcgs_scene *scene, adcgs_split split, int64_t more, const char *path, adcgs_error *error)
{
    uint64_t all = (uint64_t)more;
    for (int s = 0; s < ADCGS_SPLITS; s++)
        all += scene->n_views[s];
    if (more > VIEWS_MAX || all > VIEWS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %llu frames of all cameras together, expected at most %d: use --frames",
                          path, (unsigned long long)all, VIEWS_MAX);
    const size_t n = scene->n_views[split], wanted = n + (size_t)more;
    size_t capacity = FIRST_CAPACITY; /* grows by doubling, so it follows from n */
    while (capacity < n)
        capacity *= 2;
    if (scene->views[split] && wanted <= capacity)
        return ADCGS_OK;
    while (capacity < wanted)
        capacity *= 2;
    adcgs_scene_view *views = realloc(scene->views[split], capacity * sizeof *views);
    if (!views)
        return no_memory(path, error);
    scene->views[split] = views;
    return ADCGS_OK;
}

adcgs_status adcgs_scene_append(adcgs_scene *scene, adcgs_split split, adcgs_scene_view *view, const char *path,
                                adcgs_error *error)
{
    const adcgs_status status = reserve(scene, split, 1, path, error);
    if (status == ADCGS_OK)
        scene->views[split][scene->n_views[split]++] = *view;
    else
        adcgs_scene_view_clear(view);
    view->path = view->mask = NULL;
    return status;
}

adcgs_status adcgs_footage_add(adcgs_scene *scene, adcgs_split split, const adcgs_scene_view *like, const adcgs_footage *footage,
                               const adcgs_frame_range *range, double begin, double step, const char *path, adcgs_error *error)
{
    int64_t count;
    ADCGS_TRY(adcgs_frames_count(range, footage->frames, &count, path, error));
    ADCGS_TRY(reserve(scene, split, count, path, error));
    for (int64_t i = 0; i < count; i++) {
        const int64_t frame = range->begin + i * adcgs_frames_step(range);
        if (!footage->video && !footage->pictures[frame])
            continue;
        adcgs_scene_view view = *like;
        view.time = begin + (double)i * step;
        view.is_video = footage->video != NULL;
        view.frame = footage->video ? frame : 0;
        view.path = strdup(footage->video ? footage->video : footage->pictures[frame]);
        if (!view.path)
            return no_memory(path, error);
        ADCGS_TRY(adcgs_scene_append(scene, split, &view, path, error));
    }
    return ADCGS_OK;
}
