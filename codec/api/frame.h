/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What the library and its programs share about frames. */
#ifndef ADCGS_API_FRAME_H
#define ADCGS_API_FRAME_H

#include "base/digest.h"

#include <adcgs/camera.h>

/** Add a frame's values, as bytes of the spec's frame digest, to a digest that may hold several frames. */
void adcgs_frame_digest_add(adcgs_md5 *md5, const adcgs_frame *frame);

#endif
