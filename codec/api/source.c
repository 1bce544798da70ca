/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sources of streams: files and memory. */
#define _POSIX_C_SOURCE 200809L /* files beyond 2 GiB, where long has 32 bits */
#define _FILE_OFFSET_BITS 64

#include "api/decoder_priv.h"
#include "stream/input.h"

#include <errno.h>
#include <stdio.h>

/** Size of a file in bytes; -1 if it cannot be read at any position. */
static int64_t size_of(FILE *file)
{
    return fseeko(file, 0, SEEK_END) ? -1 : (int64_t)ftello(file);
}

/** Whether config asks for more than sequential reading. */
static int asks_for_any_order(const adcgs_config *config)
{
    adcgs_config own;
    return config && adcgs_config_read(&own, config, NULL) == ADCGS_OK && (own.on_demand || own.conceal);
}

adcgs_status adcgs_open_file(adcgs_decoder **out, const char *path, const adcgs_config *config, adcgs_error *error)
{
    ADCGS_OWN_ERROR(error);
    ADCGS_REQUIRE(out, error);
    *out = NULL;
    ADCGS_REQUIRE(path, error);
    FILE *file = fopen(path, "rb");
    if (!file)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: %s", path, strerror(errno));
    const int64_t size = asks_for_any_order(config) ? size_of(file) : -1;
    const adcgs_status status = size >= 0 ? adcgs_open_at(out, adcgs_file_read_at, file, (uint64_t)size, config, error)
                                          : adcgs_open_stream(out, adcgs_file_read, file, config, error);
    if (status == ADCGS_OK && (*out)->seek)
        (*out)->file = file;
    else
        fclose(file);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, path);
    return status;
}

static int64_t read_memory_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    const adcgs_span *s = user;
    memcpy(buffer, s->next + offset, bytes);
    return (int64_t)bytes;
}

adcgs_status adcgs_open_memory(adcgs_decoder **out, const void *data, size_t bytes, const adcgs_config *config,
                               adcgs_error *error)
{
    adcgs_config own;
    ADCGS_OWN_ERROR(error);
    if (bytes > 0)
        ADCGS_REQUIRE(data, error);
    adcgs_span s = {.next = data, .left = bytes};
    if (config && adcgs_config_read(&own, config, NULL) == ADCGS_OK && own.conceal)
        return adcgs_open_at(out, read_memory_at, &s, bytes, config, error); /* concealment reads the whole stream at once */
    return adcgs_open_stream(out, adcgs_span_read, &s, config, error);
}
