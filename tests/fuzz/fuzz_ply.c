/* SPDX-License-Identifier: BSD-2-Clause */
/** \file PLY files from outside. */
#include "fuzz.h"

#include "io/points.h"

#include <math.h>

const char *const adcgs_fuzz_seeds[] = { "tests/fuzz/seeds/ply", "tests/fuzz/regressions/ply", NULL };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    adcgs_points points = { 0 };
    adcgs_error error = { ADCGS_OK, "" };
    const adcgs_status status = adcgs_ply_parse(&points, data, size, "fuzz.ply", &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0]));
    for (uint32_t i = 0; status == ADCGS_OK && i < points.n; i++)
        FUZZ_REQUIRE(isfinite(points.position[i][0]) && isfinite(points.position[i][1]) && isfinite(points.position[i][2]));
    adcgs_points_free(&points);
    return 0;
}
