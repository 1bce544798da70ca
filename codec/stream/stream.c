/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The stream's storage, and the summary of its contents. */
#include "stream/stream.h"

#include "model/model_priv.h"
#include "render/render.h"
#include "stream/chunk.h"

#include <adcgs/version.h>

#include <stdio.h>

void adcgs_stream_init(adcgs_stream *stream)
{
    *stream = (adcgs_stream){
        .slice_log2 = ADCGS_SLICE_LOG2_DEFAULT,
        .timebase_num = 1,
        .timebase_den = 1000,
        .rate_num = 30,
        .rate_den = 1,
        .scene_scale = 1,
        .screen_filter = ADCGS_SCREEN_FILTER,
    };
}

void adcgs_stream_clear(adcgs_stream *stream, adcgs_memory *memory)
{
    for (uint32_t i = 0; i < stream->n_meta; i++) {
        adcgs_free(memory, stream->meta[i].key);
        adcgs_free(memory, stream->meta[i].value);
    }
    for (uint32_t i = 0; i < stream->n_segments; i++)
        adcgs_model_clear(&stream->segments[i], memory);
    adcgs_free(memory, stream->meta);
    adcgs_free(memory, stream->cameras);
    adcgs_free(memory, stream->segments);
    memset(stream, 0, sizeof *stream);
}

void adcgs_stream_forget(adcgs_stream *stream, uint32_t n, adcgs_memory *memory)
{
    const uint32_t kept = stream->n_segments - n;
    if (n == 0)
        return;
    for (uint32_t i = 0; i < n; i++)
        adcgs_model_clear(&stream->segments[i], memory);
    memmove(stream->segments, stream->segments + n, kept * sizeof *stream->segments);
    memset(stream->segments + kept, 0, n * sizeof *stream->segments);
    stream->first_segment += n;
    stream->n_segments = kept;
}

static int count_bits(uint32_t v)
{
    int n = 0;
    for (; v; v &= v - 1)
        n++;
    return n;
}

/** Add a segment to a summary. */
static void add_segment(adcgs_info *info, const adcgs_model *model)
{
    info->anchors += model->n;
    for (uint32_t i = 0; i < model->n; i++) {
        info->gaussians += (uint32_t)count_bits(model->mask[i]);
        info->static_anchors += model->is_static[i];
    }
    info->layers = ADCGS_MIN(info->layers, model->layers);
    info->tiers = ADCGS_MAX(info->tiers, model->finest + 1);
}

void adcgs_stream_info(const adcgs_stream *stream, adcgs_info *info)
{
    static const char *const colours[] = {"unknown", "sRGB", "linear BT.709"};
    static const char *const axes[] = {"unknown", "right-handed, y up", "right-handed, z up", "right-handed, y down"};
    static const char *const units[] = {"unknown", "metre"};
    *info = (adcgs_info){
        .version_major = ADCGS_BITSTREAM_MAJOR,
        .version_minor = ADCGS_BITSTREAM_MINOR,
        .profile = stream->profile,
        .level = stream->level,
        .segments = (int)(stream->first_segment + stream->n_segments),
        .weights = stream->weights,
        .k = stream->params.k,
        .layers = adcgs_params_layers(&stream->params),
        .cameras = (int)stream->n_cameras,
        .frame_rate = (double)stream->rate_num / (double)stream->rate_den,
        .scene_scale = stream->scene_scale,
        .truncated = stream->truncated,
        .bytes = stream->bytes,
        .metadata = (int)stream->n_meta,
        .first_segment = (int)stream->first_segment,
        .screen_filter = stream->screen_filter,
        .bytes_max = stream->level ? adcgs_level_get(stream->level)->file_bytes : 0,
    };
    for (int a = 0; a < 3; a++) {
        info->scene_origin[a] = stream->scene_origin[a];
        info->background[a] = stream->background[a];
    }
    if (stream->n_segments > 0) {
        info->time_start = stream->segments[0].time_start;
        info->time_end = stream->segments[stream->n_segments - 1].time_end;
    }
    for (uint32_t i = 0; i < stream->n_segments; i++)
        add_segment(info, &stream->segments[i]);
    info->tiers_present = info->tiers;
    for (uint32_t i = 0; i < stream->n_segments; i++)
        info->tiers_present = ADCGS_MIN(info->tiers_present, info->tiers - stream->segments[i].absent);
    snprintf(info->colour, sizeof info->colour, "%s", colours[stream->colour_space]);
    snprintf(info->axes, sizeof info->axes, "%s", axes[stream->axes]);
    snprintf(info->units, sizeof info->units, "%s", units[stream->units]);
}
