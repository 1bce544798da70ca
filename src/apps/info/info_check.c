/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checks and repairs a stream. */
#include "config.h"

#include "apps/info/info_check.h"

#include "base/cpu_detect.h"
#include "media/operand.h"
#include "model/model_priv.h"
#include "stream/salvage.h"
#include "system/atomic.h"
#include "system/pipe.h"
#include "system/text.h"

#include <stdio.h>
#include <stdlib.h>

static void print_fault(void *user, adcgs_log_level level, const char *text)
{
    if (level != ADCGS_LOG_WARNING)
        return;
    adcgs_text_show(stdout, user);
    printf(": %s\n", text);
}

static void print_usable(const char *path, const adcgs_stream *s, uint32_t faults)
{
    const int layers = adcgs_params_layers(&s->params);
    adcgs_text_show(stdout, path);
    printf(": %u fault%s; %u segment%s usable\n", faults, faults == 1 ? "" : "s", s->n_segments, s->n_segments == 1 ? "" : "s");
    for (uint32_t i = 0; faults && i < s->n_segments; i++)
        printf("  %g .. %g s, %d of %d layer%s intact, %d of %d tier%s\n", s->segments[i].time_start, s->segments[i].time_end,
               s->segments[i].layers, layers, adcgs_s((uint64_t)layers), s->segments[i].finest + 1 - s->segments[i].absent,
               s->segments[i].finest + 1, s->segments[i].finest ? "s" : "");
}

static adcgs_status write_repaired(adcgs_stream *s, const char *path, adcgs_error *error)
{
    adcgs_buffer out;
    adcgs_buffer_init(&out);
    s->level = 0; /* the lowest level that fits */
    adcgs_status status = adcgs_stream_write(s, &out, error);
    if (status == ADCGS_OK)
        status = adcgs_atomic_save(path, out.data, out.size, error);
    adcgs_buffer_clear(&out);
    return status;
}

/** Finds the usable parts of a stream, and writes them to a file unless repaired is NULL. */
static adcgs_status check(adcgs_read_at_fn read, void *user, uint64_t size, const char *path, const char *repaired,
                          uint32_t *faults, adcgs_error *error)
{
    adcgs_read_options options = {.log = {print_fault, (void *)(uintptr_t)path}};
    adcgs_stream stream;
    ADCGS_TRY(adcgs_cpu_resolve(ADCGS_CPU_AUTO, &options.cpu, error));
    adcgs_status status = adcgs_stream_salvage(&stream, read, user, size, &options, faults, error);
    if (status != ADCGS_OK) {
        adcgs_error_locate(error, path);
        return status;
    }
    print_usable(path, &stream, *faults);
    if (repaired)
        status = write_repaired(&stream, repaired, error);
    adcgs_stream_clear(&stream, NULL);
    return status;
}

static int64_t read_data(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    memcpy(buffer, (const uint8_t *)user + offset, bytes);
    return (int64_t)bytes;
}

/** Loads a URL's stream once, since a damaged stream is read several times. */
static adcgs_status check_url(const char *url, const char *repaired, uint32_t *faults, adcgs_error *error)
{
    uint8_t *data;
    size_t bytes;
    ADCGS_TRY(adcgs_http_load(&data, &bytes, url, adcgs_salvage_bytes, NULL, error));
    const adcgs_status status = check(read_data, data, bytes, url, repaired, faults, error);
    free(data);
    return status;
}

adcgs_status adcgs_info_check(const char *path, const char *repaired, uint32_t *faults, adcgs_error *error)
{
    if (adcgs_is_url(path))
        return check_url(path, repaired, faults, error);
    adcgs_operand from;
    adcgs_status status;
    ADCGS_TRY(adcgs_operand_open(&from, path, NULL, error));
    if (adcgs_pipe_is(path))
        status = adcgs_fail(error, ADCGS_ERR_IO, "%.160s: cannot be read twice, expected a file", from.name);
    else
        status = check(adcgs_operand_read_at, &from, adcgs_operand_size(&from), path, repaired, faults, error);
    adcgs_operand_close(&from);
    return status;
}
