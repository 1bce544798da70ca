/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec - : a stream from a pipe or a server, of which frames are written while it comes. */
#ifndef ADCGS_TOOLS_DEC_LIVE_H
#define ADCGS_TOOLS_DEC_LIVE_H

#include "camera/path.h"
#include "io/incoming.h"

#include <adcgs/decoder.h>

typedef struct adcgs_live {
    adcgs_incoming in;
    adcgs_decoder *decoder; /**< the caller's */
    uint8_t *buffer;        /**< bytes that were read, and not yet decoded: from at on, n of them */
    size_t at, n;
    int over;               /**< nothing more comes: the stream has ended, or the bytes have */
} adcgs_live;

/**
 * Open a stream, and read it until frames can be asked for: to the first segment that can be drawn, or to the end of the stream
 * where it is not known before which frames there are, or what their cameras. *decoder is the caller's to close, also after a
 * failure. Comes back early when a signal has interrupted it.
 */
adcgs_status adcgs_live_open(adcgs_live *live, adcgs_decoder **decoder, const char *path, const adcgs_config *config,
                             const adcgs_camera_path_request *request, adcgs_error *error);
/**
 * Read on until no byte that is still to come can change what a moment shows; infinity: to the end. What was printed can be seen
 * while it waits. Segments that lie before the moment are forgotten. Comes back early when a signal has interrupted it.
 */
adcgs_status adcgs_live_wait(adcgs_live *live, double time, adcgs_error *error);
void adcgs_live_close(adcgs_live *live);

#endif
