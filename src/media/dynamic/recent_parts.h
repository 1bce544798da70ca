/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A few decoded parts of a file, each kept until others replace it: for readers that decode on demand for several threads.
 * Memory is that of ADCGS_RECENT_PARTS parts.
 */
#ifndef ADCGS_MEDIA_DYNAMIC_RECENT_PARTS_H
#define ADCGS_MEDIA_DYNAMIC_RECENT_PARTS_H

#include "base/base.h"

#include <pthread.h>

#define ADCGS_RECENT_PARTS 4 /**< parts in memory; chosen by hand, not measured */

typedef struct adcgs_recent {
    /** Decode part `key` into new memory. It may call adcgs_recent_peek(), and nothing else of this header. */
    adcgs_status (*make)(void **part, const void *user, uint32_t key, adcgs_error *error);
    void (*drop)(void *part); /**< free a part */
    const void *user;         /**< for make() */
    /* Private. */
    pthread_mutex_t lock;
    pthread_cond_t given;
    uint64_t turn;
    struct {
        void *part; /* NULL: empty */
        uint32_t key, users;
        uint64_t used; /* turn of the last use */
    } slots[ADCGS_RECENT_PARTS];
} adcgs_recent;

/** make, drop and user are set; the other members are zero. */
void adcgs_recent_init(adcgs_recent *recent);
/** Drop all parts; no thread uses one. */
void adcgs_recent_clear(adcgs_recent *recent);
/** Part `key`, decoded if it is not there. It stays until adcgs_recent_give(); a thread takes one part at a time. */
adcgs_status adcgs_recent_take(adcgs_recent *recent, uint32_t key, const void **part, adcgs_error *error);
void adcgs_recent_give(adcgs_recent *recent, const void *part);
/** Inside make(): a part that is already decoded, valid until make() returns; else NULL. */
const void *adcgs_recent_peek(const adcgs_recent *recent, uint32_t key);

#endif
