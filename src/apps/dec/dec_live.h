/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec -: writes frames of a stream from a pipe or a server while it arrives. */
#ifndef ADCGS_APPS_DEC_DEC_LIVE_H
#define ADCGS_APPS_DEC_DEC_LIVE_H

#include "camera/path.h"
#include "net/incoming.h"

#include <adcgs/decoder.h>

typedef struct adcgs_live {
    adcgs_incoming in;
    adcgs_decoder *decoder; /**< owned by the caller */
    uint8_t *buffer;        /**< read and not yet decoded: n bytes, from `at` on */
    size_t at, n;
    int over; /**< nothing more arrives: the stream or the bytes have ended */
} adcgs_live;

/**
 * Opens a stream and reads it until frames can be requested: to the first segment that can be rendered, or to the end of the
 * stream if its frames or their cameras are unknown before. The caller closes *decoder, also after a failure. Returns early if a
 * signal interrupts it.
 */
adcgs_status adcgs_live_open(adcgs_live *live, adcgs_decoder **decoder, const char *path, const adcgs_config *config,
                             const adcgs_camera_path_request *request, adcgs_error *error);
/**
 * Reads until no later byte can change the frame at this time; infinity: to the end. Flushes standard output before it waits.
 * Discards segments before this time. Returns early if a signal interrupts it.
 */
adcgs_status adcgs_live_wait(adcgs_live *live, double time, adcgs_error *error);
void adcgs_live_close(adcgs_live *live);

#endif
