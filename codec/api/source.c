/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Where streams come from: files and memory, both as sequential sources. */
#include "base/base.h"

#include <adcgs/decoder.h>

#include <errno.h>
#include <stdio.h>

static int64_t read_file(void *user, void *buffer, size_t bytes)
{
    FILE *file = user;
    const size_t n = fread(buffer, 1, bytes, file);
    return n == 0 && ferror(file) ? -1 : (int64_t)n;
}

adcgs_status adcgs_open_file(adcgs_decoder **out, const char *path, const adcgs_config *config, adcgs_error *error)
{
    *out = NULL;
    FILE *file = fopen(path, "rb");
    if (!file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: %s", path, strerror(errno));
    const adcgs_status status = adcgs_open_stream(out, read_file, file, config, error);
    fclose(file);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, path);
    return status;
}

/** What is left of the bytes in memory. */
typedef struct span {
    const uint8_t *next;
    size_t left;
} span;

static int64_t read_memory(void *user, void *buffer, size_t bytes)
{
    span *s = user;
    const size_t n = ADCGS_MIN(bytes, s->left);
    if (n > 0) {
        memcpy(buffer, s->next, n);
        s->next += n;
        s->left -= n;
    }
    return (int64_t)n;
}

adcgs_status adcgs_open_memory(adcgs_decoder **out, const void *data, size_t bytes, const adcgs_config *config,
                               adcgs_error *error)
{
    span s = { data, bytes };
    return adcgs_open_stream(out, read_memory, &s, config, error);
}
