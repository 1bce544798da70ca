/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Where streams come from: files and memory, both as sequential sources. */
#include "base/base.h"
#include "stream/input.h"

#include <adcgs/decoder.h>

#include <errno.h>
#include <stdio.h>

adcgs_status adcgs_open_file(adcgs_decoder **out, const char *path, const adcgs_config *config, adcgs_error *error)
{
    *out = NULL;
    FILE *file = fopen(path, "rb");
    if (!file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: %s", path, strerror(errno));
    const adcgs_status status = adcgs_open_stream(out, adcgs_file_read, file, config, error);
    fclose(file);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, path);
    return status;
}

adcgs_status adcgs_open_memory(adcgs_decoder **out, const void *data, size_t bytes, const adcgs_config *config,
                               adcgs_error *error)
{
    adcgs_span s = { .next = data, .left = bytes };
    return adcgs_open_stream(out, adcgs_span_read, &s, config, error);
}
