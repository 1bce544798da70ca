/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Frames of a stream that is still arriving. */
#include "config.h"

#include "apps/dec/dec_live.h"

#include "cli/cli.h"
#include "system/interrupt.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define BUFFER_BYTES 65536 /* bytes read at a time; chosen by hand, not measured */

/** Waits for bytes and reads the available ones. */
static adcgs_status fill(adcgs_live *live, adcgs_error *error)
{
    fflush(stdout); /* waiting may take long; a failure now repeats when the frames are done */
    live->at = 0;
    return adcgs_incoming_read(&live->in, live->buffer, BUFFER_BYTES, &live->n, error);
}

/** Decodes one part of the bytes read, or reads more, or notes the end. */
static adcgs_status step(adcgs_live *live, adcgs_error *error)
{
    adcgs_arrival arrived = ADCGS_ARRIVED_NOTHING;
    adcgs_status status = ADCGS_OK;
    size_t used = 0;
    if (live->n == 0)
        ADCGS_TRY(fill(live, error));
    if (live->n > 0)
        status = adcgs_push(live->decoder, live->buffer + live->at, live->n, &used, &arrived, error);
    live->at += used;
    live->n -= used;
    live->over = arrived == ADCGS_ARRIVED_END || (live->in.ended && live->n == 0);
    if (status == ADCGS_OK && live->over)
        status = adcgs_push_end(live->decoder, error);
    if (status != ADCGS_OK)
        adcgs_error_locate(error, live->in.name);
    return status;
}

/** The stream's info; before the header is read, no time can be rendered. */
static adcgs_info get_info(const adcgs_live *live)
{
    adcgs_info info;
    if (adcgs_get_info(live->decoder, &info, sizeof info, NULL) != ADCGS_OK)
        info = (adcgs_info){.time_committed = -INFINITY, .time_available = -INFINITY};
    return info;
}

/** True if the frames known by now are those of the whole stream. */
static int are_known(const adcgs_info *info, const adcgs_camera_path_request *request)
{
    const char *const camera = request->camera ? request->camera : "";
    const size_t n = strlen(camera);
    const int turns = !strcmp(camera, "orbit") || !strcmp(camera, "spiral"); /* their speed depends on the number of frames */
    if (!info->cameras || !strcmp(camera, "bullet") || (n > 5 && !strcmp(camera + n - 5, ".json")))
        return 0;
    return request->has_times || (!turns && isfinite(info->time_end));
}

adcgs_status adcgs_live_open(adcgs_live *live, adcgs_decoder **decoder, const char *path, const adcgs_config *config,
                             const adcgs_camera_path_request *request, adcgs_error *error)
{
    *live = (adcgs_live){0};
    ADCGS_TRY(adcgs_incoming_open(&live->in, path, adcgs_interrupted, error));
    ADCGS_TRY(adcgs_open_push(decoder, config, error));
    live->decoder = *decoder;
    live->buffer = malloc(BUFFER_BYTES);
    if (!live->buffer)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%.160s: out of memory", live->in.name);
    adcgs_info info = {.time_available = -INFINITY};
    for (; !live->over && isinf(info.time_available) && !adcgs_interrupted(); info = get_info(live))
        ADCGS_TRY(step(live, error));
    return are_known(&info, request) ? ADCGS_OK : adcgs_live_wait(live, INFINITY, error);
}

adcgs_status adcgs_live_wait(adcgs_live *live, double time, adcgs_error *error)
{
    while (!live->over && !adcgs_interrupted() && (isinf(time) || !(time < get_info(live).time_committed)))
        ADCGS_TRY(step(live, error));
    return live->over ? ADCGS_OK : adcgs_push_discard_before(live->decoder, time, error);
}

void adcgs_live_close(adcgs_live *live)
{
    adcgs_incoming_close(&live->in);
    free(live->buffer);
    *live = (adcgs_live){0};
}
