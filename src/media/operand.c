/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The source of a stream that an operand names. */
#include "config.h"

#include "media/operand.h"

#include "media/kind.h"
#include "stream/input.h"
#include "system/file.h"

#include <errno.h>
#include <stdlib.h>

static int is_page(const char *path)
{
    return strcmp(path, "-") && adcgs_kind_at(path)->class == ADCGS_KIND_PAGE;
}

adcgs_status adcgs_operand_open(adcgs_operand *out, const char *path, const adcgs_http_config *http, adcgs_error *error)
{
    *out = (adcgs_operand){.name = strcmp(path, "-") ? path : "standard input"};
    ADCGS_TRY(adcgs_kind_check(path, ADCGS_WANT_STREAM, error));
    if (adcgs_is_url(path))
        return adcgs_http_open(&out->http, path, http, error);
    if (is_page(path))
        return adcgs_page_stream_open(&out->page, path, error);
    out->file = strcmp(path, "-") ? fopen(path, "rb") : stdin;
    return out->file ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_IO, "%.160s: %s", path, strerror(errno));
}

void adcgs_operand_close(adcgs_operand *operand)
{
    if (operand->file && operand->file != stdin)
        fclose(operand->file);
    operand->file = NULL;
    adcgs_http_close(&operand->http);
    adcgs_page_stream_close(&operand->page);
}

uint64_t adcgs_operand_size(const adcgs_operand *operand)
{
    if (operand->http)
        return adcgs_http_size(operand->http);
    if (operand->page)
        return adcgs_page_stream_size(operand->page);
    const off_t size = operand->file != stdin && !fseeko(operand->file, 0, SEEK_END) ? ftello(operand->file) : 0;
    rewind(operand->file);
    return size > 0 ? (uint64_t)size : 0;
}

int64_t adcgs_operand_read(void *user, void *buffer, size_t bytes)
{
    adcgs_operand *const o = user;
    return o->http   ? adcgs_http_read(o->http, buffer, bytes)
           : o->page ? adcgs_page_stream_read(o->page, buffer, bytes)
                     : adcgs_file_read(o->file, buffer, bytes);
}

int64_t adcgs_operand_read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    adcgs_operand *const o = user;
    return o->http   ? adcgs_http_read_at(o->http, offset, buffer, bytes)
           : o->page ? adcgs_page_stream_read_at(o->page, offset, buffer, bytes)
                     : adcgs_file_read_at(o->file, offset, buffer, bytes);
}

adcgs_status adcgs_operand_explain(const adcgs_operand *operand, adcgs_status status, adcgs_error *error)
{
    return adcgs_http_explain(operand->http, status, error);
}

adcgs_status adcgs_operand_decode(adcgs_decoder **decoder, adcgs_operand *source, const char *path, const adcgs_config *config,
                                  adcgs_error *error)
{
    const int any_order = config && (config->on_demand || config->conceal);
    *source = (adcgs_operand){.name = path};
    if (!is_page(path)) {
        ADCGS_TRY(adcgs_kind_check(path, ADCGS_WANT_STREAM, error));
        return adcgs_open_file(decoder, path, config, error);
    }
    ADCGS_TRY(adcgs_operand_open(source, path, NULL, error));
    const adcgs_status status =
        any_order ? adcgs_open_at(decoder, adcgs_operand_read_at, source, adcgs_operand_size(source), config, error)
                  : adcgs_open_stream(decoder, adcgs_operand_read, source, config, error);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, path);
    return status;
}

/** Loads all bytes of a page's stream. */
static adcgs_status load_page(uint8_t **data, size_t *bytes, char **name, adcgs_page_stream *page, const char *path,
                              uint64_t limit, adcgs_error *error)
{
    const uint64_t size = adcgs_page_stream_size(page);
    if (size > limit || size > SIZE_MAX)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "%.160s: a stream of %llu bytes, expected at most %llu", path,
                          (unsigned long long)size, (unsigned long long)limit);
    *data = malloc((size_t)size);
    *bytes = (size_t)size;
    if (name)
        *name = strdup(adcgs_page_stream_name(page));
    if (!*data || (name && !*name))
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory", path);
    if (adcgs_page_stream_read(page, *data, *bytes) != (int64_t)size)
        return adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot read: the file has changed", path);
    return ADCGS_OK;
}

adcgs_status adcgs_operand_load(uint8_t **data, size_t *bytes, char **name, const char *path, uint64_t limit, adcgs_error *error)
{
    adcgs_page_stream *page;
    *data = NULL;
    if (name)
        *name = NULL;
    ADCGS_TRY(adcgs_kind_check(path, ADCGS_WANT_STREAM, error));
    if (!is_page(path))
        return adcgs_file_load(data, bytes, path, limit, error);
    ADCGS_TRY(adcgs_page_stream_open(&page, path, error));
    const adcgs_status status = load_page(data, bytes, name, page, path, limit, error);
    adcgs_page_stream_close(&page);
    if (status != ADCGS_OK) {
        free(*data);
        if (name)
            free(*name);
        *data = NULL;
    }
    return status;
}
