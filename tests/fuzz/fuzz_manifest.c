/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Untrusted manifests of conformance suites. */
#define _GNU_SOURCE

#include "outside_file.h"

#include "apps/conform/conform.h"

const char *const adcgs_fuzz_seeds[] = {"conformance/manifest.json", "tests/fuzz/regressions/manifest", NULL};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[] = "/tmp/adcgs-fuzz-XXXXXX", path[64];
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_manifest manifest;
    FUZZ_REQUIRE(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/manifest.json", folder);
    write_outside_file(path, data, size);
    const adcgs_status status = adcgs_manifest_read(&manifest, path, &error);
    FUZZ_REQUIRE(status == ADCGS_OK || (error.status == status && error.text[0]));
    unlink(path);
    rmdir(folder);
    if (status == ADCGS_OK)
        adcgs_manifest_clear(&manifest);
    return 0;
}
