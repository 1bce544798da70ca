/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Effect of a splat on the sixteen pixels of a 4x4 block, shared by the blend
 * and its backward pass. Needs lanes.h.
 */
#ifndef ADCGS_RENDER_ALPHA_H
#define ADCGS_RENDER_ALPHA_H

#include "render/project.h"

#include <stdalign.h>

/* Centres of the pixels of a block. */
static const alignas(64) float pixel_x[16] = {0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f,
                                              0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f};
static const alignas(64) float pixel_y[16] = {0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 1.5f,
                                              2.5f, 2.5f, 2.5f, 2.5f, 3.5f, 3.5f, 3.5f, 3.5f};

/*
 * Opacity at offset (dx, dy) from the splat's centre, in two steps: the first gives its logarithm to base 2, without the limit.
 * Both steps in a row are one long chain of dependent operations. A loop over the first step and then a loop over the second are
 * two short chains.
 */
LANES_INLINE vf splat_power(const adcgs_splat2d *s, vf dx, vf dy)
{
    const vf along = vf_fma(vf_set1(s->a), dx, vf_mul(vf_set1(s->b), dy));
    return vf_fma(dx, along, vf_fma(vf_mul(vf_set1(s->c), dy), dy, vf_set1(s->log2_opacity)));
}

/* 0 where the opacity is below 1/255. */
LANES_INLINE vf alpha_of_power(vf power)
{
    return vf_only(vf_ge(power, vf_set1(ADCGS_POWER_MIN)), vf_exp2(power));
}

/* Initial transmittance of a block's pixels: 0 outside the image. */
LANES_INLINE vf initial_transmittance(int x, int y, int width, int height)
{
    alignas(64) float t[16];
    if (x + 4 <= width && y + 4 <= height)
        return vf_set1(1.0f);
    for (int i = 0; i < 16; i++)
        t[i] = x + (i & 3) < width && y + (i >> 2) < height ? 1.0f : 0.0f;
    return vf_load(t);
}

#endif
