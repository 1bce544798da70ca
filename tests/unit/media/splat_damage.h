/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Damaged files of splats: they give an error or valid splats, and neither crash nor run long. */
#ifndef ADCGS_TESTS_MEDIA_SPLAT_DAMAGE_H
#define ADCGS_TESTS_MEDIA_SPLAT_DAMAGE_H

#include "outside_files.h"

#include "media/splats/splats.h"

#include <math.h>

/** Reads data that may be damaged; splats that are read keep the promises of splats.h. */
static inline adcgs_status read_damaged(const uint8_t *data, size_t bytes)
{
    adcgs_splats s;
    uint8_t *const copy = malloc(bytes + 1); /* its end is guarded by sanitizers */
    assert_non_null(copy);
    memcpy(copy, data, bytes);
    copy[bytes] = 0;
    const adcgs_status status = adcgs_splats_parse(&s, copy, bytes, "damaged", &error);
    assert_true(status == ADCGS_OK || (!strncmp(error.text, "damaged: ", 9) && !s.block && !s.harmonics));
    for (uint32_t i = 0; status == ADCGS_OK && i < s.n; i++) {
        double length = 0.0;
        for (int a = 0; a < 4; a++)
            length += pow((double)s.rotation[a][i], 2);
        assert_true(fabs(length - 1.0) < 1e-5 && s.opacity[i] >= 0.0f && s.opacity[i] <= 1.0f);
        for (int a = 0; a < 3; a++)
            assert_true(isfinite(s.mean[a][i]) && isfinite(s.colour[a][i]) && isnormal(s.scale[a][i]) && s.scale[a][i] > 0.0f);
    }
    adcgs_splats_free(&s);
    free(copy);
    return status;
}

/** Cuts a file short at some hundred places: all are refused. Replaces single bytes, half of them in the first `header` bytes. */
static inline void damage(uint8_t *data, size_t bytes, size_t header)
{
    uint32_t random = 1;
    for (size_t n = 0; n < bytes; n += n < 256 ? 1 : bytes / 200 + 1)
        assert_int_not_equal(read_damaged(data, n), ADCGS_OK);
    for (int i = 0; i < 600; i++) {
        random = random * 1664525 + 1013904223;
        const size_t at = (random >> 4) % (i % 2 ? bytes : ADCGS_MIN(bytes, header));
        const uint8_t before = data[at];
        data[at] = i % 3 ? (uint8_t)(random >> 24) : (uint8_t)(before ^ 1 << random % 8);
        read_damaged(data, bytes);
        data[at] = before;
    }
}

#endif
