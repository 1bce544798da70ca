/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats for a GPU: four texels each, and the order of rendering, from the farthest to the nearest. */
#include "config.h"

#include "wasm/export.h"
#include "wasm/page_scene.h"

#include <adcgs/adcgs.h>

#include <stdlib.h>
#include <string.h>

#define TEXELS 4
#define BUCKETS 65536

static struct {
    float (*texel)[TEXELS][4];
    uint32_t *order;
    uint16_t *key;
    uint32_t n, room;
} splats;

static int reserve(uint32_t n)
{
    if (n <= splats.room)
        return 0;
    free(splats.texel);
    free(splats.order);
    free(splats.key);
    splats.texel = malloc(n * sizeof *splats.texel);
    splats.order = malloc(n * sizeof *splats.order);
    splats.key = malloc(n * sizeof *splats.key);
    splats.room = splats.texel && splats.order && splats.key ? n : 0;
    return splats.room ? 0 : -1;
}

/** Pack the splats that are visible at a time. \return their number, or a status. */
int PAGE_EXPORT(page_pack)(double time)
{
    adcgs_primitives p;
    const adcgs_status status = adcgs_get_primitives(adcgs_page_decoder(), time, &p, adcgs_page_error());
    if (status != ADCGS_OK)
        return status;
    splats.n = 0;
    if (reserve(p.n))
        return adcgs_page_fail(ADCGS_ERR_MEMORY, "out of memory for the splats of a time");
    for (uint32_t i = 0; i < p.n; i++) {
        if (!(p.opacity[i] > 0))
            continue;
        const float values[TEXELS][4] = {{p.mean[0][i], p.mean[1][i], p.mean[2][i], p.opacity[i]},
                                         {p.rotation[0][i], p.rotation[1][i], p.rotation[2][i], p.rotation[3][i]},
                                         {p.scale[0][i], p.scale[1][i], p.scale[2][i], 0},
                                         {p.colour[0][i], p.colour[1][i], p.colour[2][i], 0}};
        memcpy(splats.texel[splats.n++], values, sizeof values);
    }
    return (int)splats.n;
}

/**
 * A camera for a shader: rotation and translation from the scene's units, fx, fy, cx, cy, near plane, and four limits, 21 numbers
 * in total; NULL if it cannot be rendered.
 */
const float *PAGE_EXPORT(page_uniforms)(const adcgs_camera *camera)
{
    static adcgs_view view;
    adcgs_info info;
    _Static_assert(sizeof view == 2 * sizeof(int32_t) + 21 * sizeof(float), "the shader's numbers lie in a row");
    if (adcgs_get_info(adcgs_page_decoder(), &info, sizeof info, adcgs_page_error()) != ADCGS_OK ||
        adcgs_view_init(&view, camera, info.scene_origin, info.scene_scale, adcgs_page_error()) != ADCGS_OK)
        return NULL;
    return view.rotation;
}

const float *PAGE_EXPORT(page_texels)(void)
{
    return splats.texel[0][0];
}

/** Sort by depth along a direction of the scene: a counting sort of 16 bits, stable within a bucket. */
const uint32_t *PAGE_EXPORT(page_sort)(double x, double y, double z)
{
    static uint32_t first[BUCKETS + 1];
    const float d[3] = {(float)x, (float)y, (float)z};
    float low = 0, high = 0;
    for (uint32_t i = 0; i < splats.n; i++) {
        const float *mean = splats.texel[i][0];
        const float depth = d[0] * mean[0] + d[1] * mean[1] + d[2] * mean[2];
        low = i && low < depth ? low : depth;
        high = i && high > depth ? high : depth;
    }
    const float scale = high > low ? (BUCKETS - 1) / (high - low) : 0;
    memset(first, 0, sizeof first);
    for (uint32_t i = 0; i < splats.n; i++) {
        const float *mean = splats.texel[i][0];
        const float depth = d[0] * mean[0] + d[1] * mean[1] + d[2] * mean[2];
        splats.key[i] = (uint16_t)((high - depth) * scale);
        first[splats.key[i] + 1]++;
    }
    for (uint32_t i = 0; i < BUCKETS; i++)
        first[i + 1] += first[i];
    for (uint32_t i = 0; i < splats.n; i++)
        splats.order[first[splats.key[i]]++] = i;
    return splats.order;
}
