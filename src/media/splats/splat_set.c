/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Storing one splat, with checks of its numbers. */
#include "config.h"

#include "media/splats/splat_set.h"

#include <math.h>
#include <stdlib.h>

static adcgs_status bad(const char *path, uint32_t index, const char *what, double value, const char *expected,
                        adcgs_error *error)
{
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: splat %u: %s is %g, expected %s", path, index, what, value, expected);
}

adcgs_status adcgs_splats_set(adcgs_splats *splats, uint32_t index, const adcgs_splat *splat, const char *path,
                              adcgs_error *error)
{
    double length = 0.0;
    for (int a = 0; a < 3; a++) {
        if (!(fabs(splat->mean[a]) <= (double)FLT_MAX))
            return bad(path, index, "a coordinate", splat->mean[a], "a finite number", error);
        if (!(splat->scale[a] >= 0.0 && splat->scale[a] <= (double)ADCGS_SPLATS_SCALE_MAX))
            return bad(path, index, "a scale", splat->scale[a], "0 to e^80", error);
        if (!(fabs(splat->colour[a]) <= (double)FLT_MAX))
            return bad(path, index, "a colour", splat->colour[a], "a finite number", error);
        splats->mean[a][index] = (float)splat->mean[a];
        splats->scale[a][index] = fmaxf((float)splat->scale[a], ADCGS_SPLATS_SCALE_MIN);
        splats->colour[a][index] = (float)splat->colour[a];
    }
    for (int a = 0; a < 4; a++)
        length += splat->rotation[a] * splat->rotation[a];
    if (!(length > 0.0 && length <= DBL_MAX))
        return bad(path, index, "the length of the rotation", sqrt(length), "a quaternion", error);
    for (int a = 0; a < 4; a++)
        splats->rotation[a][index] = (float)(splat->rotation[a] / sqrt(length));
    if (isnan(splat->opacity))
        return bad(path, index, "the opacity", splat->opacity, "0 to 1", error);
    splats->opacity[index] = (float)fmin(fmax(splat->opacity, 0.0), 1.0);
    return ADCGS_OK;
}

adcgs_status adcgs_splats_add_harmonics(adcgs_splats *splats, int degree, const char *path, adcgs_error *error)
{
    const size_t each = 3 * (size_t)((degree + 1) * (degree + 1) - 1);
    splats->degree = degree;
    splats->harmonics = degree ? calloc(splats->n * each, sizeof *splats->harmonics) : NULL;
    if (degree && !splats->harmonics)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", path, splats->n);
    return ADCGS_OK;
}

void adcgs_rotation_of_three(double rotation[4], const double three[3], int omitted)
{
    double sum = 0.0;
    for (int a = 0, k = 0; a < 4; a++)
        if (a != omitted) {
            rotation[a] = three[k++];
            sum += rotation[a] * rotation[a];
        }
    rotation[omitted] = sqrt(fmax(0.0, 1.0 - sum));
    sum += rotation[omitted] * rotation[omitted];
    for (int a = 0; a < 4; a++)
        rotation[a] /= sqrt(sum); /* at least 1, except for rounding */
}
