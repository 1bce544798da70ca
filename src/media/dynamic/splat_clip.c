/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checks clips that are to be written. */
#include "config.h"

#include "media/dynamic/splat_clip.h"

#include "media/dynamic/dynamic_splats.h"

#include <math.h>

static adcgs_status check(const adcgs_splat_clip *c, const char *path, adcgs_error *error)
{
    const uint32_t n = c->n_frames ? c->frames->n : 0;
    if (!c->n_frames || !n || c->n_frames > ADCGS_DYNAMIC_FRAMES_MAX)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: %u frames of %u splats, expected 1 or more, up to %d frames", path,
                          c->n_frames, n, (int)ADCGS_DYNAMIC_FRAMES_MAX);
    if (!(c->fps >= ADCGS_FPS_MIN && c->fps <= ADCGS_FPS_MAX) || c->group > ADCGS_CLIP_GROUP_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: %g frames a second, %u in a group, expected %g to %g, and up to %u", path,
                          c->fps, c->group, ADCGS_FPS_MIN, (double)ADCGS_FPS_MAX, ADCGS_CLIP_GROUP_MAX);
    for (uint32_t f = 1; f < c->n_frames; f++)
        if (c->frames[f].n != n || memcmp(c->frames[f].offset, c->frames->offset, sizeof c->frames->offset))
            return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: frame %u has %u splats, expected %u, and the same offset", path, f,
                              c->frames[f].n, n);
    return ADCGS_OK;
}

adcgs_status adcgs_splat_clip_check(const adcgs_splat_clip *c, double *step, double low[3], double high[3], const char *path,
                                    adcgs_error *error)
{
    double sum = 0.0, farthest = 0.0;
    ADCGS_TRY(check(c, path, error));
    const uint32_t n = c->frames->n;
    for (uint32_t f = 0; f < c->n_frames; f++)
        for (int a = 0; a < 3; a++)
            for (uint32_t i = 0; i < n; i++) {
                const double at = (double)c->frames[f].mean[a][i];
                low[a] = f || i ? fmin(low[a], at) : at;
                high[a] = f || i ? fmax(high[a], at) : at;
                farthest = fmax(farthest, fabs(at));
                sum += f ? 0.0 : log((double)c->frames->scale[a][i]);
            }
    *step =
        c->step_mean > 0.0 ? c->step_mean : fmax(exp(sum / (3.0 * n)) / ADCGS_CLIP_STEPS, 1.001 * farthest / ADCGS_CLIP_BIN_MAX);
    return farthest / *step <= ADCGS_CLIP_BIN_MAX
               ? ADCGS_OK
               : adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: positions up to %g in steps of %g, expected at most 2^29 steps",
                            path, farthest, *step);
}
