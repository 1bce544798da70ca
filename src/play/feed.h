/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The bytes of a stream that is still coming. A thread takes them from their
 * source, and all are kept, so that who decodes them can begin anew.
 */
#ifndef ADCGS_PLAY_FEED_H
#define ADCGS_PLAY_FEED_H

#include "io/incoming.h"

typedef struct adcgs_feed adcgs_feed;

/** path, interrupted: as adcgs_incoming_open() has them; path outlives the feed. */
adcgs_status adcgs_feed_open(adcgs_feed **out, const char *path, int (*interrupted)(void), adcgs_error *error);
/** Ends the thread first, if there is one, which takes a moment at most. */
void adcgs_feed_free(adcgs_feed **feed);
/** Before there is a thread: wait for bytes, a moment at most, and keep them. */
void adcgs_feed_wait(adcgs_feed *feed);

/** Start the thread. From it, wake(arg) is called when more bytes have come, or their end has. */
adcgs_status adcgs_feed_start(adcgs_feed *feed, void (*wake)(void *arg), void *arg, adcgs_error *error);
/** Stop it. What has come stays. */
void adcgs_feed_stop(adcgs_feed *feed);

/** Bytes that have come. *ended: no more will. */
uint64_t adcgs_feed_bytes(adcgs_feed *feed, int *ended);
/** Copy bytes from a position on, as many as there are, at most n. \return how many. */
size_t adcgs_feed_copy(adcgs_feed *feed, uint64_t at, void *to, size_t n);
/** Why the bytes have ended: ADCGS_OK, or reading or memory failed. */
adcgs_status adcgs_feed_status(adcgs_feed *feed, adcgs_error *error);
/** "standard input", the path or the URL, for messages. */
const char *adcgs_feed_name(const adcgs_feed *feed);

#endif
