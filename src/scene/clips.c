/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The videos of a scene. */
#include "config.h"

#include "scene/clips.h"

#include <pthread.h>
#include <stdlib.h>

typedef struct clip {
    char *path;           /* NULL: the slot is free */
    adcgs_video *video;   /* NULL until it is opened, or if opening failed */
    pthread_mutex_t lock; /* protects video */
    int users;
    uint64_t used; /* number of the call that used it last */
} clip;

struct adcgs_clips {
    pthread_mutex_t lock; /* protects the table and all members of a clip except video and its lock */
    pthread_cond_t freed;
    uint64_t calls;
    clip clip[ADCGS_CLIPS_OPEN];
};

adcgs_status adcgs_clips_create(adcgs_clips **out, adcgs_error *error)
{
    adcgs_clips *clips = *out = calloc(1, sizeof *clips);
    if (!clips)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the table of videos");
    pthread_mutex_init(&clips->lock, NULL);
    pthread_cond_init(&clips->freed, NULL);
    for (int i = 0; i < ADCGS_CLIPS_OPEN; i++)
        pthread_mutex_init(&clips->clip[i].lock, NULL);
    return ADCGS_OK;
}

static void close_clip(clip *c)
{
    adcgs_video_close(&c->video);
    free(c->path);
    c->path = NULL;
}

void adcgs_clips_free(adcgs_clips **clips)
{
    if (!*clips)
        return;
    for (int i = 0; i < ADCGS_CLIPS_OPEN; i++) {
        close_clip(&(*clips)->clip[i]);
        pthread_mutex_destroy(&(*clips)->clip[i].lock);
    }
    pthread_cond_destroy(&(*clips)->freed);
    pthread_mutex_destroy(&(*clips)->lock);
    free(*clips);
    *clips = NULL;
}

/** The clip of a path, else the least recently used clip without users; NULL if all are in use. */
static clip *find_clip(adcgs_clips *clips, const char *path)
{
    clip *best = NULL;
    for (int i = 0; i < ADCGS_CLIPS_OPEN; i++) {
        clip *c = &clips->clip[i];
        if (c->path && !strcmp(c->path, path))
            return c;
        if (!c->users && (!best || c->used < best->used))
            best = c;
    }
    return best;
}

/** Acquires the clip of this path for the caller, until release(). */
static adcgs_status acquire(adcgs_clips *clips, clip **out, const char *path, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    clip *c;
    pthread_mutex_lock(&clips->lock);
    while (!(c = find_clip(clips, path)))
        pthread_cond_wait(&clips->freed, &clips->lock);
    if (!c->path || strcmp(c->path, path)) {
        close_clip(c);
        c->path = strdup(path);
    }
    if (c->path) {
        c->users++;
        c->used = ++clips->calls;
    } else
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    pthread_mutex_unlock(&clips->lock);
    *out = c;
    return status;
}

static void release(adcgs_clips *clips, clip *c)
{
    pthread_mutex_lock(&clips->lock);
    if (!--c->users)
        pthread_cond_signal(&clips->freed);
    pthread_mutex_unlock(&clips->lock);
}

adcgs_status adcgs_clips_read(adcgs_clips *clips, const char *path, int64_t frame, adcgs_image *out, adcgs_error *error)
{
    clip *c;
    *out = (adcgs_image){0};
    ADCGS_TRY(acquire(clips, &c, path, error));
    pthread_mutex_lock(&c->lock);
    adcgs_status status = c->video ? ADCGS_OK : adcgs_video_open(&c->video, path, error);
    if (status == ADCGS_OK)
        status = adcgs_video_read(c->video, frame, out, error);
    pthread_mutex_unlock(&c->lock);
    release(clips, c);
    return status;
}

/* ---- Order ---- */

typedef struct place {
    const adcgs_scene_view *view;
    uint32_t index;
} place;

static int by_video(const void *a, const void *b)
{
    const place *x = a, *y = b;
    if (x->view->is_video && y->view->is_video) {
        const int paths = strcmp(x->view->path, y->view->path);
        if (paths || x->view->frame != y->view->frame)
            return paths ? paths : x->view->frame < y->view->frame ? -1 : 1;
    } else if (x->view->is_video || y->view->is_video)
        return x->view->is_video ? -1 : 1; /* long runs first, so that the threads finish together */
    return (x->index > y->index) - (x->index < y->index);
}

static int same_video(const adcgs_scene_view *a, const adcgs_scene_view *b)
{
    return a->is_video && b->is_video && !strcmp(a->path, b->path);
}

adcgs_status adcgs_view_runs_make(adcgs_view_runs *runs, const adcgs_scene_view *views, uint32_t n, adcgs_error *error)
{
    place *all = malloc(((size_t)n + 1) * sizeof *all);
    *runs = (adcgs_view_runs){.begin = malloc(((size_t)n + 1) * sizeof *runs->begin),
                              .order = malloc(((size_t)n + 1) * sizeof *runs->order)};
    if (!all || !runs->begin || !runs->order) {
        free(all);
        adcgs_view_runs_clear(runs);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the order of %u views", n);
    }
    for (uint32_t i = 0; i < n; i++)
        all[i] = (place){&views[i], i};
    qsort(all, n, sizeof *all, by_video);
    for (uint32_t i = 0; i < n; i++) {
        if (!i || !same_video(all[i - 1].view, all[i].view))
            runs->begin[runs->n++] = i;
        runs->order[i] = all[i].index;
    }
    runs->begin[runs->n] = n;
    free(all);
    return ADCGS_OK;
}

void adcgs_view_runs_clear(adcgs_view_runs *runs)
{
    free(runs->begin);
    free(runs->order);
    *runs = (adcgs_view_runs){0};
}
