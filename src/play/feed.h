/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The bytes of a stream that is still arriving. A thread reads them from their source. All bytes are kept, so that they can be
 * decoded again from the beginning.
 */
#ifndef ADCGS_PLAY_FEED_H
#define ADCGS_PLAY_FEED_H

#include "net/incoming.h"

typedef struct adcgs_feed adcgs_feed;

/** path, interrupted: as for adcgs_incoming_open(); path outlives the feed. */
adcgs_status adcgs_feed_open(adcgs_feed **out, const char *path, int (*interrupted)(void), adcgs_error *error);
/** Ends the thread first, if there is one, which takes a short time at most. */
void adcgs_feed_free(adcgs_feed **feed);
/** Without a thread: waits for bytes, for a short time at most, and keeps them. */
void adcgs_feed_wait(adcgs_feed *feed);

/** Starts the thread. The thread calls wake(arg) when more bytes, or their end, have arrived. */
adcgs_status adcgs_feed_start(adcgs_feed *feed, void (*wake)(void *arg), void *arg, adcgs_error *error);
/** Stops the thread. Received bytes stay. */
void adcgs_feed_stop(adcgs_feed *feed);

/** Number of received bytes. *ended: no more will arrive. */
uint64_t adcgs_feed_bytes(adcgs_feed *feed, int *ended);
/** Copies bytes from a position on, the available ones, at most n. \return their number */
size_t adcgs_feed_copy(adcgs_feed *feed, uint64_t at, void *to, size_t n);
/** The reason for the end of the bytes: ADCGS_OK, or a failure of reading or allocation. */
adcgs_status adcgs_feed_status(adcgs_feed *feed, adcgs_error *error);
/** "standard input", the path or the URL, for messages. */
const char *adcgs_feed_name(const adcgs_feed *feed);

#endif
