/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Writing OpenEXR through OpenEXRCore, the library's part in C. (Reading goes
 * through OpenImageIO.) EXR's colours are premultiplied by alpha; adcgs_image's
 * are not, so writing converts.
 */
#ifndef ADCGS_MEDIA_IMAGE_EXR_H
#define ADCGS_MEDIA_IMAGE_EXR_H

#include "bits/bytes.h"
#include "media/image/image.h"

/**
 * Scan lines, lossless ZIP compression; appends to out. path is for messages. With a camera the attributes are:
 * - worldToCamera and worldToNDC, for row vectors; camera axes x right, y up, z forward; (0, 0) to (1, 1) across the image, z/w
 * from 0 at the near plane to 1 at infinity.
 * - screenWindowCenter and screenWindowWidth, with x to the left and y up at distance 1.
 * - pixelAspectRatio, the width of a pixel over its height at that distance: 1 without a camera.
 * - adcgs/focal and adcgs/principal (v2d, pixels), adcgs/near (double, world units), adcgs/camera (string), adcgs/time (double,
 * seconds).
 */
adcgs_status adcgs_exr_encode(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options, const char *path,
                              adcgs_error *error);

#endif
