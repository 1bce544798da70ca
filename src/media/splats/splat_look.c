/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Recognising formats of splats without a magic number. */
#include "config.h"

#include "media/splats/splat_look.h"

#include "media/splats/dot_splat.h"
#include "media/splats/ksplat.h"

#include <ctype.h>
#include <math.h>

/* Origin: chosen by hand, not measured; the rotation's rounding to 8 bits changes its squared length by 2 %. */
#define FAR_MAX 1e8    /* largest coordinate, in the file's units */
#define SCALE_MAX 1e6  /* largest standard deviation, in the file's units */
#define LENGTH_MIN 0.7 /* smallest squared length of a rotation */
#define LENGTH_MAX 1.4 /* largest one */
#define LOOK_MAX 4096  /* bytes of a JSON text that are examined */

static double load_real(const uint8_t *at)
{
    return (double)adcgs_bits_float(adcgs_load_le32(at));
}

static int is_record(const uint8_t *record)
{
    double length = 0.0;
    for (size_t i = 0; i < 6; i++) {
        const double v = load_real(record + 4 * i);
        if (!(fabs(v) <= FAR_MAX) || (i >= 3 && !(v >= 0.0 && v <= SCALE_MAX)))
            return 0;
    }
    for (size_t i = 0; i < 4; i++)
        length += pow((record[ADCGS_DOT_SPLAT_ROTATION + i] - 128.0) / 128.0, 2);
    return length > LENGTH_MIN && length < LENGTH_MAX;
}

int adcgs_dot_splat_is(const uint8_t *data, size_t n, uint64_t size)
{
    size_t at = 0;
    if (!size || size % ADCGS_DOT_SPLAT_BYTES || n < ADCGS_DOT_SPLAT_BYTES)
        return 0;
    while (at + ADCGS_DOT_SPLAT_BYTES <= n && at < LOOK_MAX && is_record(data + at))
        at += ADCGS_DOT_SPLAT_BYTES;
    return at + ADCGS_DOT_SPLAT_BYTES > n || at >= LOOK_MAX;
}

int adcgs_ksplat_is(const uint8_t *data, size_t n, uint64_t size)
{
    if (n < ADCGS_KSPLAT_USED)
        return 0;
    const uint32_t sections = adcgs_load_le32(data + ADCGS_KSPLAT_SECTIONS);
    const double low = load_real(data + ADCGS_KSPLAT_LOW), high = load_real(data + ADCGS_KSPLAT_HIGH);
    return adcgs_load_le32(data) == ADCGS_KSPLAT_VERSION && adcgs_load_le16(data + ADCGS_KSPLAT_LEVEL) <= ADCGS_KSPLAT_LEVELS &&
           sections >= 1 && low <= high && size >= ADCGS_KSPLAT_HEADER + (uint64_t)ADCGS_KSPLAT_SECTION * sections;
}

static int has(const uint8_t *data, size_t n, const char *text)
{
    const size_t length = strlen(text);
    for (size_t i = 0; i + length <= n; i++)
        if (!memcmp(data + i, text, length))
            return 1;
    return 0;
}

int adcgs_sog_meta_is(const uint8_t *data, size_t n)
{
    size_t at = n >= 3 && !memcmp(data, "\xef\xbb\xbf", 3) ? 3 : 0;
    while (at < n && isspace(data[at]))
        at++;
    n = ADCGS_MIN(n, LOOK_MAX);
    return at < n && data[at] == '{' && has(data, n, "\"means\"") && has(data, n, "\"mins\"") && has(data, n, ".webp\"");
}
