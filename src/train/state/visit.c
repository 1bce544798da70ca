/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Visitors in memory and in files. */
#include "config.h"

#include "train/state/visit.h"

#include "base/digest.h"

void adcgs_checkpoint_visit(adcgs_checkpoint_walk *w, void *data, size_t bytes)
{
    if (w->out) {
        adcgs_write_bytes(w->out, data, bytes);
        return;
    }
    if (w->file) {
        w->crc = adcgs_crc32c(w->crc, data, bytes);
        w->unwritten |= fwrite(data, 1, bytes, w->file) != bytes;
        return;
    }
    const uint8_t *from = adcgs_read_bytes(w->in, bytes);
    if (from)
        memcpy(data, from, bytes);
    else
        w->failed = 1;
}
