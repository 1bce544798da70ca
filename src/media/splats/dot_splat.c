/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats from .splat. */
#include "config.h"

#include "media/splats/dot_splat.h"

#include "media/splats/splat_set.h"

static adcgs_splat record_of(const uint8_t *at)
{
    adcgs_splat s = {.opacity = at[ADCGS_DOT_SPLAT_COLOUR + 3] / 255.0};
    for (int a = 0; a < 3; a++) {
        s.mean[a] = (double)adcgs_bits_float(adcgs_load_le32(at + 4 * a));
        s.scale[a] = (double)adcgs_bits_float(adcgs_load_le32(at + ADCGS_DOT_SPLAT_SCALE + 4 * a));
        s.colour[a] = at[ADCGS_DOT_SPLAT_COLOUR + a] / 255.0;
    }
    for (int a = 0; a < 4; a++)
        s.rotation[a] = (at[ADCGS_DOT_SPLAT_ROTATION + a] - 128) / 128.0;
    return s;
}

adcgs_status adcgs_dot_splat_parse(adcgs_splats *out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error)
{
    ADCGS_TRY(adcgs_splats_alloc(out, bytes / ADCGS_DOT_SPLAT_BYTES, path, error));
    for (uint32_t i = 0; i < out->n; i++) {
        const adcgs_splat s = record_of(data + (size_t)ADCGS_DOT_SPLAT_BYTES * i);
        ADCGS_TRY(adcgs_splats_set(out, i, &s, path, error));
    }
    return ADCGS_OK;
}
