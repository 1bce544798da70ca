/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Functions that readers of splats over time share. */
#include "config.h"

#include "media/dynamic/dynamic_reader.h"

#include "media/dynamic/motion.h"

#include <math.h>
#include <stdlib.h>

#define ROUNDING 5e-7 /* seconds: a time this close before a frame is that frame's; chosen by hand, not measured */

void adcgs_dynamic_set_clock(adcgs_dynamic *m, adcgs_fps rate, uint32_t frames)
{
    m->rate = m->options.rate.den ? m->options.rate : rate.den ? rate : (adcgs_fps){ADCGS_DYNAMIC_RATE, 1};
    m->frames = m->options.frames ? m->options.frames : frames ? frames : ADCGS_DYNAMIC_FRAMES;
}

uint32_t adcgs_dynamic_frame(const adcgs_dynamic *m, double seconds)
{
    const double at = floor((seconds + ROUNDING) * m->rate.num / m->rate.den);
    return at >= m->frames - 1.0 ? m->frames - 1 : at > 0.0 ? (uint32_t)at : 0;
}

adcgs_status adcgs_dynamic_motion_at(const adcgs_dynamic *m, double seconds, adcgs_splats *out, adcgs_error *error)
{
    return adcgs_motion_at(m->state, seconds, out, m->path, error);
}

void adcgs_dynamic_motion_close(adcgs_dynamic *m)
{
    if (m->state)
        adcgs_motion_free(m->state);
    free(m->state);
    m->state = NULL;
}
