/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec --splats: the splats of moments as PLY files. */
#include "config.h"

#include "tools/dec_splats.h"

#include "io/sink.h"
#include "io/splats.h"

#include <stdlib.h>

static adcgs_status check_target(const char *target, int has_many, adcgs_error *error)
{
    const size_t n = strlen(target);
    const int places = adcgs_pattern_places(target);
    if (n < 5 || strcmp(target + n - 4, ".ply"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: the name of splats must end in .ply", target);
    if (places < 0 || places > 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: expected one number like %%04d in the name", target);
    if (!places && has_many)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: a span of times needs a number like %%04d in the name", target);
    return ADCGS_OK;
}

static adcgs_status write_moment(uint32_t *n, adcgs_decoder *decoder, const adcgs_info *info, double time, const char *path,
                                 adcgs_error *error)
{
    adcgs_primitives primitives;
    adcgs_splats splats;
    char comment[128];
    const adcgs_status got = adcgs_get_primitives(decoder, time, &primitives);
    if (got != ADCGS_OK)
        return adcgs_fail(error, got, "%s: no splats at %g s: out of memory", path, time);
    ADCGS_TRY(adcgs_splats_take(&splats, &primitives, info->scene_origin, info->scene_scale, path, error));
    snprintf(comment, sizeof comment, "adcgs %s, time %.9g s", PACKAGE_VERSION, time);
    const adcgs_status status = adcgs_splats_write(&splats, comment, path, error);
    *n = splats.n;
    adcgs_splats_free(&splats);
    return status;
}

static adcgs_status write_all(uint32_t *n, adcgs_decoder *decoder, const adcgs_info *info, const char *target,
                              const adcgs_shots *shots, adcgs_error *error)
{
    const size_t size = strlen(target) + 128;
    char *path = malloc(size);
    if (!path)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", target);
    adcgs_status status = ADCGS_OK;
    for (int i = 0; i < shots->n && status == ADCGS_OK && !adcgs_interrupted(); i++) {
        adcgs_pattern_format(target, i, path, size);
        status = write_moment(n, decoder, info, shots->shot[i].time, path, error);
    }
    free(path);
    return status;
}

adcgs_status adcgs_dec_splats(const adcgs_cli *cli, adcgs_decoder *decoder, const char *input, const char *target,
                              const adcgs_shots_request *request, adcgs_error *error)
{
    adcgs_info info;
    adcgs_shots shots;
    uint32_t n = 0;
    adcgs_shots_request moments = {.has_times = 1, .begin = request->begin, .end = request->end};
    ADCGS_TRY(adcgs_get_info(decoder, &info));
    if (!request->has_times) {
        moments.begin = info.time_start;
        moments.end = adcgs_pattern_places(target) == 0 ? info.time_start : info.time_end;
    }
    ADCGS_TRY(check_target(target, moments.end > moments.begin, error));
    if (info.truncated)
        adcgs_cli_note(cli, "%s: the stream ends early; writing what is complete", input);
    ADCGS_TRY(adcgs_shots_make(&shots, decoder, &moments, error));
    if (shots.outside)
        adcgs_cli_note(cli, "%s: %d of %d files show its first or last moment: it lasts from %g to %g s", input, shots.outside,
                       shots.n, info.time_start, info.time_end);
    const adcgs_status status = write_all(&n, decoder, &info, target, &shots, error);
    if (status == ADCGS_OK && !adcgs_interrupted())
        adcgs_cli_note(cli, "%s: %d file%s, %u splats in the last", input, shots.n, shots.n == 1 ? "" : "s", n);
    adcgs_shots_free(&shots);
    return status;
}
