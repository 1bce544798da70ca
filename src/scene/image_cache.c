/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Decoded images of a scene. */
#include "config.h"

#include "scene/image_cache.h"

#include <pthread.h>
#include <stdlib.h>

/* Slots of the table, a power of two; chosen by hand, not measured: scenes have up to some thousands of images. */
enum { SLOTS = 4096 };

typedef struct entry {
    adcgs_packed_image image; /* first, so that an image leads to its entry */
    char *path;
    int64_t frame;
    uint64_t bytes;              /* as counted in `kept` */
    uint32_t users, age;         /* age: of the limit under which it was used last */
    int ready;                   /* false while a thread decodes it */
    struct entry *next;          /* in its slot */
    struct entry *newer, *older; /* among the entries without users, in order of use */
} entry;

struct adcgs_image_cache {
    pthread_mutex_t lock; /* protects all members */
    pthread_cond_t decoded_one;
    uint64_t limit, kept, charged, decoded;
    uint32_t age;
    entry *newest, *oldest; /* without users */
    entry *slot[SLOTS];
};

adcgs_status adcgs_image_cache_create(adcgs_image_cache **out, adcgs_error *error)
{
    adcgs_image_cache *cache = *out = calloc(1, sizeof *cache);
    if (!cache)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the table of images");
    pthread_mutex_init(&cache->lock, NULL);
    pthread_cond_init(&cache->decoded_one, NULL);
    return ADCGS_OK;
}

static void free_entry(entry *e)
{
    adcgs_packed_image_clear(&e->image);
    free(e->path);
    free(e);
}

void adcgs_image_cache_free(adcgs_image_cache **cache)
{
    if (!*cache)
        return;
    for (int i = 0; i < SLOTS; i++)
        for (entry *e = (*cache)->slot[i], *next; e; e = next) {
            next = e->next;
            free_entry(e);
        }
    pthread_cond_destroy(&(*cache)->decoded_one);
    pthread_mutex_destroy(&(*cache)->lock);
    free(*cache);
    *cache = NULL;
}

/* ---- Table ---- */

/** FNV-1a of the path, and the frame. */
static entry **slot_of(adcgs_image_cache *cache, const char *path, int64_t frame)
{
    uint32_t hash = 2166136261u;
    for (; *path; path++)
        hash = (hash ^ (uint8_t)*path) * 16777619u;
    hash = (hash ^ (uint32_t)frame) * 16777619u;
    return &cache->slot[(hash ^ hash >> 16) % SLOTS];
}

static entry *find_entry(adcgs_image_cache *cache, const char *path, int64_t frame)
{
    entry *e = *slot_of(cache, path, frame);
    while (e && (e->frame != frame || strcmp(e->path, path)))
        e = e->next;
    return e;
}

static entry *add_entry(adcgs_image_cache *cache, const char *path, int64_t frame, uint64_t bytes)
{
    entry *e = calloc(1, sizeof *e);
    if (!e || !(e->path = strdup(path))) {
        free(e);
        return NULL;
    }
    entry **const slot = slot_of(cache, path, frame);
    e->frame = frame;
    e->bytes = bytes;
    e->users = 1;
    e->next = *slot;
    *slot = e;
    cache->kept += bytes;
    return e;
}

/** Removes an entry without users from the table, but not from the list. */
static void drop_entry(adcgs_image_cache *cache, entry *e)
{
    entry **at = slot_of(cache, e->path, e->frame);
    while (*at != e)
        at = &(*at)->next;
    *at = e->next;
    cache->kept -= e->bytes;
    free_entry(e);
}

/* ---- Order of use ---- */

static void unlink_entry(adcgs_image_cache *cache, entry *e)
{
    *(e->newer ? &e->newer->older : &cache->newest) = e->older;
    *(e->older ? &e->older->newer : &cache->oldest) = e->newer;
    e->newer = e->older = NULL;
}

static void link_newest(adcgs_image_cache *cache, entry *e)
{
    e->older = cache->newest;
    *(e->older ? &e->older->newer : &cache->oldest) = e;
    cache->newest = e;
}

static int has_room(const adcgs_image_cache *cache, uint64_t bytes)
{
    return cache->kept + cache->charged + bytes <= cache->limit;
}

/** Drops images until there is room for so many bytes. outdated: only those that were not used under this limit. */
static void make_room(adcgs_image_cache *cache, uint64_t bytes, int outdated)
{
    while (!has_room(cache, bytes) && cache->newest) {
        entry *const e = cache->oldest->age != cache->age ? cache->oldest : cache->newest;
        if (outdated && e->age == cache->age)
            return;
        unlink_entry(cache, e);
        drop_entry(cache, e);
    }
}

/* ---- Use ---- */

void adcgs_image_cache_limit(adcgs_image_cache *cache, uint64_t bytes)
{
    pthread_mutex_lock(&cache->lock);
    cache->limit = bytes;
    cache->age++;
    make_room(cache, 0, 0);
    pthread_mutex_unlock(&cache->lock);
}

void adcgs_image_cache_charge(adcgs_image_cache *cache, int64_t bytes)
{
    pthread_mutex_lock(&cache->lock);
    cache->charged += (uint64_t)bytes;
    make_room(cache, 0, 0);
    pthread_mutex_unlock(&cache->lock);
}

/** Decodes an entry that no other thread uses yet. Locked before and after. */
static adcgs_status fill_entry(adcgs_image_cache *cache, entry *e, const adcgs_packed_image **out, adcgs_image_decode decode,
                               void *user, adcgs_error *error)
{
    pthread_mutex_unlock(&cache->lock);
    const adcgs_status status = decode(user, &e->image, error);
    pthread_mutex_lock(&cache->lock);
    pthread_cond_broadcast(&cache->decoded_one);
    if (status != ADCGS_OK) {
        drop_entry(cache, e);
        return status == ADCGS_ERR_MEMORY ? ADCGS_OK : status; /* the caller needs less of it to decode for itself */
    }
    *out = &e->image;
    const uint64_t bytes = adcgs_packed_image_size(&e->image);
    cache->kept += bytes - e->bytes;
    e->bytes = bytes;
    e->ready = 1;
    e->age = cache->age;
    return ADCGS_OK;
}

adcgs_status adcgs_image_cache_take(adcgs_image_cache *cache, const adcgs_packed_image **out, const char *path, int64_t frame,
                                    uint64_t bytes, adcgs_image_decode decode, void *user, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    entry *e;
    *out = NULL;
    pthread_mutex_lock(&cache->lock);
    while ((e = find_entry(cache, path, frame)) && !e->ready)
        pthread_cond_wait(&cache->decoded_one, &cache->lock);
    if (e) {
        if (!e->users++)
            unlink_entry(cache, e);
        e->age = cache->age;
        *out = &e->image;
    } else {
        make_room(cache, bytes, 1);
        if (has_room(cache, bytes) && (e = add_entry(cache, path, frame, bytes)))
            status = fill_entry(cache, e, out, decode, user, error);
    }
    pthread_mutex_unlock(&cache->lock);
    return status;
}

void adcgs_image_cache_give(adcgs_image_cache *cache, const adcgs_packed_image *image)
{
    entry *const e = (entry *)(uintptr_t)image; /* its first member */
    if (!image)
        return;
    pthread_mutex_lock(&cache->lock);
    if (!--e->users)
        link_newest(cache, e);
    make_room(cache, 0, 0);
    pthread_mutex_unlock(&cache->lock);
}

void adcgs_image_cache_count(adcgs_image_cache *cache)
{
    if (!cache)
        return;
    pthread_mutex_lock(&cache->lock);
    cache->decoded++;
    pthread_mutex_unlock(&cache->lock);
}

void adcgs_image_cache_facts(adcgs_image_cache *cache, uint64_t *decoded, uint64_t *kept)
{
    pthread_mutex_lock(&cache->lock);
    *decoded = cache->decoded;
    *kept = cache->kept;
    pthread_mutex_unlock(&cache->lock);
}
