/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Decoded parts of a file, shared by threads. */
#include "config.h"

#include "media/dynamic/recent_parts.h"

void adcgs_recent_init(adcgs_recent *r)
{
    pthread_mutex_init(&r->lock, NULL);
    pthread_cond_init(&r->given, NULL);
}

void adcgs_recent_clear(adcgs_recent *r)
{
    for (int i = 0; i < ADCGS_RECENT_PARTS; i++)
        if (r->slots[i].part)
            r->drop(r->slots[i].part);
    pthread_cond_destroy(&r->given);
    pthread_mutex_destroy(&r->lock);
}

static int find_slot(const adcgs_recent *r, uint32_t key)
{
    for (int i = 0; i < ADCGS_RECENT_PARTS; i++)
        if (r->slots[i].part && r->slots[i].key == key)
            return i;
    return -1;
}

const void *adcgs_recent_peek(const adcgs_recent *r, uint32_t key)
{
    const int i = find_slot(r, key);
    return i < 0 ? NULL : r->slots[i].part;
}

/** An empty slot, else the one whose part was used longest ago; -1 while threads use all of them. */
static int oldest_slot(const adcgs_recent *r)
{
    int oldest = -1;
    for (int i = 0; i < ADCGS_RECENT_PARTS; i++) {
        if (!r->slots[i].part)
            return i;
        if (!r->slots[i].users && (oldest < 0 || r->slots[i].used < r->slots[oldest].used))
            oldest = i;
    }
    return oldest;
}

/** Decode into a slot. Other threads wait: most of them want the same part. The new part replaces one after it is made. */
static adcgs_status fill_slot(adcgs_recent *r, uint32_t key, int *slot, adcgs_error *error)
{
    void *part = NULL;
    const adcgs_status status = r->make(&part, r->user, key, error);
    if (status != ADCGS_OK)
        return status;
    const int i = *slot = oldest_slot(r); /* threads only give parts back, so there is one */
    if (r->slots[i].part)
        r->drop(r->slots[i].part);
    r->slots[i].part = part;
    r->slots[i].key = key;
    return ADCGS_OK;
}

adcgs_status adcgs_recent_take(adcgs_recent *r, uint32_t key, const void **part, adcgs_error *error)
{
    adcgs_status status = ADCGS_OK;
    int i;
    *part = NULL;
    pthread_mutex_lock(&r->lock);
    while ((i = find_slot(r, key)) < 0 && oldest_slot(r) < 0)
        pthread_cond_wait(&r->given, &r->lock);
    if (i < 0)
        status = fill_slot(r, key, &i, error);
    if (status == ADCGS_OK) {
        r->slots[i].users++;
        r->slots[i].used = ++r->turn;
        *part = r->slots[i].part;
    }
    pthread_mutex_unlock(&r->lock);
    return status;
}

void adcgs_recent_give(adcgs_recent *r, const void *part)
{
    pthread_mutex_lock(&r->lock);
    for (int i = 0; i < ADCGS_RECENT_PARTS; i++)
        if (r->slots[i].part == part) {
            r->slots[i].users--;
            break;
        }
    pthread_cond_signal(&r->given);
    pthread_mutex_unlock(&r->lock);
}
