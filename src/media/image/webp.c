/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Lossless WebP by libwebp. */
#include "config.h"

#include "media/image/webp.h"

#include <stdlib.h>

void adcgs_webp_clear(adcgs_webp *image)
{
    free(image->pixels);
    *image = (adcgs_webp){0};
}

#ifdef HAVE_SOG

#include <webp/decode.h>

#define LOSSLESS 2 /* WebPBitstreamFeatures.format; definition (libwebp) */

adcgs_status adcgs_webp_parse(adcgs_webp *out, const uint8_t *data, size_t bytes, uint64_t most, const char *path,
                              const char *name, adcgs_error *error)
{
    WebPBitstreamFeatures found;
    *out = (adcgs_webp){0};
    if (WebPGetFeatures(data, bytes, &found) != VP8_STATUS_OK)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %.100s: not a WebP image, or it ends early", path, name);
    if (found.has_animation || found.format != LOSSLESS)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %.100s: WebP that is lossy or moves, expected a lossless image", path,
                          name);
    const uint64_t pixels = (uint64_t)found.width * (uint64_t)found.height; /* each is at most 16384 */
    if (pixels > most)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %.100s: %dx%d pixels, expected at most %llu", path, name, found.width,
                          found.height, (unsigned long long)most);
    out->pixels = malloc(4 * (size_t)pixels);
    if (!out->pixels)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %dx%d pixels", path, found.width, found.height);
    if (!WebPDecodeRGBAInto(data, bytes, out->pixels, 4 * (size_t)pixels, 4 * found.width)) {
        adcgs_webp_clear(out);
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %.100s: a damaged WebP image", path, name);
    }
    out->width = found.width;
    out->height = found.height;
    return ADCGS_OK;
}

#else

adcgs_status adcgs_webp_parse(adcgs_webp *out, const uint8_t *data, size_t bytes, uint64_t most, const char *path,
                              const char *name, adcgs_error *error)
{
    *out = (adcgs_webp){0};
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build reads no SOG: it needs libwebp and zlib", path);
}

#endif
