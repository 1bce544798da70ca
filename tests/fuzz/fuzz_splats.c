/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Untrusted PLY files of splats. */
#include "fuzz.h"

#include "media/splats/splats.h"

#include <math.h>

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/splats", "tests/fuzz/seeds/ply", NULL};

/** Accepted splats fulfil the promises of the header. */
static void check(const adcgs_splats *s)
{
    FUZZ_REQUIRE(s->n > 0 && s->n <= ADCGS_SPLATS_MAX && (s->degree == 0) == (s->harmonics == NULL));
    for (uint32_t i = 0; i < s->n; i++) {
        float length = 0.0f;
        FUZZ_REQUIRE(s->opacity[i] >= 0.0f && s->opacity[i] <= 1.0f);
        for (int a = 0; a < 3; a++) {
            FUZZ_REQUIRE(isfinite(s->mean[a][i]) && isfinite(s->colour[a][i]));
            FUZZ_REQUIRE(isnormal(s->scale[a][i]) && s->scale[a][i] > 0.0f);
        }
        for (int a = 0; a < 4; a++)
            length += s->rotation[a][i] * s->rotation[a][i];
        FUZZ_REQUIRE(fabsf(length - 1.0f) < 1e-5f);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    adcgs_splats splats;
    adcgs_error error = {ADCGS_OK, ""};
    uint8_t *text = fuzz_file(data, size);
    const adcgs_status status = adcgs_splats_parse(&splats, text, size, "fuzz.ply", &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0] && !strchr(error.text, '\n')));
    FUZZ_REQUIRE(status == ADCGS_OK || (splats.n == 0 && splats.block == NULL && splats.harmonics == NULL));
    if (status == ADCGS_OK)
        check(&splats);
    adcgs_splats_free(&splats);
    free(text);
    return 0;
}
