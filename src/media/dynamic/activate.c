/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Activations of trained splats. */
#include "config.h"

#include "media/dynamic/activate.h"

#include <math.h>

#define LOG_SCALE_MIN -80.0 /* the scale of a flat axis, as in static PLY and GLB; chosen by hand, not measured */

float adcgs_scale_of_log(double logarithm)
{
    return (float)exp(logarithm < LOG_SCALE_MIN ? LOG_SCALE_MIN : logarithm);
}

void adcgs_splats_activate(adcgs_splats *s)
{
    for (uint32_t i = 0; i < s->n; i++) {
        for (int a = 0; a < 3; a++)
            s->scale[a][i] = adcgs_scale_of_log((double)s->scale[a][i]);
        s->opacity[i] = (float)(1.0 / (1.0 + exp(-(double)s->opacity[i])));
    }
}
