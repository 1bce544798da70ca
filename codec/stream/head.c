/* SPDX-License-Identifier: BSD-2-Clause */
/** \file HEAD: properties of the whole stream, and whether this decoder supports them. */
#include "model/model_priv.h"
#include "stream/parts.h"

#include <adcgs/version.h>

static adcgs_status check_support(const adcgs_syn_version *v, adcgs_error *error)
{
    if (v->version_major != ADCGS_BITSTREAM_MAJOR || v->version_minor != ADCGS_BITSTREAM_MINOR)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "HEAD: bitstream version is %u.%u, this decoder knows %d.%d",
                          v->version_major, v->version_minor, ADCGS_BITSTREAM_MAJOR, ADCGS_BITSTREAM_MINOR);
    if (v->profile != 0)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "HEAD: profile is %u, this decoder knows 0", v->profile);
    if (v->level < 1 || v->level > ADCGS_LEVELS)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "HEAD: level is %u, this decoder knows 1..%d", v->level, ADCGS_LEVELS);
    if (v->arith != 0)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "HEAD: arith is %u, this decoder knows 0", v->arith);
    if (v->features != 0)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "HEAD: features 0x%08x are required, this decoder knows none",
                          v->features);
    return ADCGS_OK;
}

static adcgs_status check_counts(const adcgs_syn_head *h, int level, adcgs_error *error)
{
    const adcgs_level *limits = adcgs_level_get(level);
    if (h->segments > limits->segments)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "HEAD: segments is %u, level %d allows %u", h->segments, level,
                          limits->segments);
    if (h->max_anchors > limits->anchors)
        return adcgs_fail(error, ADCGS_ERR_LIMIT, "HEAD: max_anchors is %u, level %d allows %u", h->max_anchors, level,
                          limits->anchors);
    return ADCGS_OK;
}

static void params_from_head(adcgs_params *params, const adcgs_syn_head *h)
{
    params->k = h->k;
    params->n_fv = h->n_fv;
    params->n_fg = h->n_fg;
    params->chunks = h->chunks;
    params->n_eta = h->n_eta;
    params->octaves = h->octaves;
    params->fine_uses_fv = h->fine_uses_fv;
    params->coarse_rotation = h->coarse_rotation;
    params->adaptive_steps = h->adaptive_steps;
    params->spans = h->spans;
    params->bodies = h->bodies;
    params->smooth_time = h->smooth_time;
    params->time_rows = h->time_rows;
    params->time_width = h->time_width;
}

adcgs_status adcgs_head_parse(adcgs_parse *p, adcgs_syn_head *head, adcgs_stream *stream)
{
    adcgs_syn_version version;
    ADCGS_TRY(adcgs_syn_version_parse(p, &version));
    ADCGS_TRY(check_support(&version, p->error));
    ADCGS_TRY(adcgs_syn_head_parse(p, head));
    ADCGS_TRY(adcgs_parse_end(p));
    ADCGS_TRY(check_counts(head, version.level, p->error));
    stream->profile = version.profile;
    stream->level = version.level;
    stream->arith = version.arith;
    stream->timebase_num = head->timebase_num;
    stream->timebase_den = head->timebase_den;
    stream->rate_num = head->rate_num;
    stream->rate_den = head->rate_den;
    stream->start_ticks = head->start_ticks;
    stream->duration_ticks = head->duration_ticks;
    memcpy(stream->scene_origin, head->scene_origin, sizeof stream->scene_origin);
    stream->scene_scale = head->scene_scale;
    memcpy(stream->background, head->background, sizeof stream->background);
    stream->screen_filter = head->screen_filter;
    stream->colour_space = head->colour_space;
    stream->axes = head->axes;
    stream->units = head->units;
    stream->slice_log2 = head->slice_log2;
    params_from_head(&stream->params, head);
    return adcgs_params_validate(&stream->params, p->error);
}

adcgs_status adcgs_head_write(adcgs_buffer *out, const adcgs_stream *stream, uint32_t max_anchors, adcgs_error *error)
{
    const adcgs_params *params = &stream->params;
    const adcgs_syn_version v = {
        .version_major = ADCGS_BITSTREAM_MAJOR,
        .version_minor = ADCGS_BITSTREAM_MINOR,
        .profile = stream->profile,
        .level = stream->level,
        .arith = stream->arith,
    };
    adcgs_syn_head h = {
        .timebase_num = stream->timebase_num,
        .timebase_den = stream->timebase_den,
        .rate_num = stream->rate_num,
        .rate_den = stream->rate_den,
        .start_ticks = stream->start_ticks,
        .duration_ticks = stream->duration_ticks,
        .segments = stream->n_segments,
        .max_anchors = max_anchors,
        .scene_scale = stream->scene_scale,
        .screen_filter = stream->screen_filter,
        .colour_space = stream->colour_space,
        .axes = stream->axes,
        .units = stream->units,
        .slice_log2 = stream->slice_log2,
        .k = params->k,
        .n_fv = params->n_fv,
        .n_fg = params->n_fg,
        .chunks = params->chunks,
        .n_eta = params->n_eta,
        .octaves = params->octaves,
        .fine_uses_fv = params->fine_uses_fv,
        .coarse_rotation = params->coarse_rotation,
        .adaptive_steps = params->adaptive_steps,
        .spans = params->spans,
        .bodies = params->bodies,
        .smooth_time = params->smooth_time,
        .time_rows = params->time_rows,
        .time_width = params->time_width,
    };
    memcpy(h.scene_origin, stream->scene_origin, sizeof h.scene_origin);
    memcpy(h.background, stream->background, sizeof h.background);
    ADCGS_TRY(check_support(&v, error));
    ADCGS_TRY(check_counts(&h, v.level, error));
    ADCGS_TRY(adcgs_params_validate(params, error));
    ADCGS_TRY(adcgs_syn_version_write(out, "HEAD", &v, error));
    return adcgs_syn_head_write(out, "HEAD", &h, error);
}
