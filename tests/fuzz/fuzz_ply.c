/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Untrusted PLY files. */
#include "fuzz.h"

#include "media/points/points.h"

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/ply", "tests/fuzz/regressions/ply", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    adcgs_points points = {0};
    adcgs_error error = {ADCGS_OK, ""};
    uint8_t *text = fuzz_file(data, size);
    const adcgs_status status = adcgs_ply_parse(&points, text, size, "fuzz.ply", &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0]));
    FUZZ_REQUIRE(status == ADCGS_OK || (points.n == 0 && points.position == NULL));
    adcgs_points_free(&points);
    free(text);
    return 0;
}
