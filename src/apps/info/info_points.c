/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --points: anchors as a point cloud. */
#include "config.h"

#include "apps/info/info_points.h"

#include "base/cpu_detect.h"
#include "media/splats/offset.h"
#include "splat/splat.h"

/** The last segment that begins at or before the time. */
static const adcgs_model *model_at(const adcgs_stream *stream, double time)
{
    const adcgs_model *found = &stream->segments[0];
    for (uint32_t i = 1; i < stream->n_segments; i++)
        if (stream->segments[i].time_start <= time)
            found = &stream->segments[i];
    return found;
}

static void place(adcgs_points *out, const double offset[3], const adcgs_stream *stream, const adcgs_model *m)
{
    for (uint32_t i = 0; i < m->n; i++)
        for (int a = 0; a < 3; a++) {
            const double scene = (double)m->origin[a] + ((double)m->pos[3 * (size_t)i + (size_t)a] + 0.5) * (double)m->voxel;
            out->position[i][a] = (float)((stream->scene_origin[a] - offset[a]) + stream->scene_scale * scene);
        }
}

static uint8_t to_byte(double value)
{
    return (uint8_t)((value > 0.0 ? value < 1.0 ? value : 1.0 : 0.0) * 255.0 + 0.5);
}

/** Invisible anchors stay grey. */
static void colour(adcgs_points *out, const adcgs_model *m, const adcgs_primitives *p)
{
    for (uint32_t i = 0; i < m->n; i++) {
        double sum[3] = {0.0, 0.0, 0.0}, weight = 0.0;
        for (uint32_t k = 0; k < m->params.k; k++) {
            const size_t slot = ((size_t)(i / 64) * m->params.k + k) * 64 + i % 64;
            weight += (double)p->opacity[slot];
            for (int c = 0; c < 3; c++)
                sum[c] += (double)p->opacity[slot] * (double)p->colour[c][slot];
        }
        for (int c = 0; c < 3 && weight > 0.0; c++)
            out->colour[i][c] = to_byte(sum[c] / weight);
    }
    out->coloured = 1;
}

static adcgs_status colour_at(adcgs_points *out, const adcgs_model *m, double time, adcgs_error *error)
{
    adcgs_cpu_level cpu;
    adcgs_splat *splat = NULL;
    adcgs_primitives primitives;
    ADCGS_TRY(adcgs_cpu_resolve(ADCGS_CPU_AUTO, &cpu, error));
    ADCGS_TRY(adcgs_splat_create(&splat, m, cpu, NULL, NULL, error));
    const adcgs_status status = adcgs_splat_at(splat, adcgs_splat_time(m, time), &primitives, error);
    if (status == ADCGS_OK)
        colour(out, m, &primitives);
    adcgs_splat_free(&splat);
    return status;
}

adcgs_status adcgs_info_points(adcgs_points *out, double offset[3], const adcgs_stream *stream, const char *path,
                               adcgs_error *error)
{
    const double first = stream->segments[0].time_start, last = stream->segments[stream->n_segments - 1].time_end;
    const double middle = 0.5 * (first + last);
    const adcgs_model *m = model_at(stream, middle);
    ADCGS_TRY(adcgs_points_alloc(out, m->n, path, error));
    adcgs_offset_of(offset, stream->scene_origin, stream->scene_scale);
    place(out, offset, stream, m);
    const adcgs_status status = colour_at(out, m, middle, error);
    if (status != ADCGS_OK)
        adcgs_points_free(out);
    return status;
}
