/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Untrusted plans of segments. */
#define _GNU_SOURCE

#include "outside_file.h"

#include "session/plan.h"

const char *const adcgs_fuzz_seeds[] = {"tests/fuzz/seeds/plan", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/adcgs-fuzz-XXXXXX", path[64];
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_plan plan = {.dataset = 0};
    FUZZ_REQUIRE(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/plan.json", folder);
    write_outside_file(path, data, size);
    const adcgs_status status = adcgs_plan_read(&plan, path, &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0] && !strchr(error.text, '\n')));
    for (uint32_t i = 0; status == ADCGS_OK && i < plan.cuts.n; i++) {
        FUZZ_REQUIRE(plan.cuts.at[i + 1] > plan.cuts.at[i] && plan.cuts.reach[i] >= 0);
        FUZZ_REQUIRE(i || !plan.segments[i].follows);
    }
    unlink(path);
    rmdir(folder);
    adcgs_plan_clear(&plan);
    return 0;
}
