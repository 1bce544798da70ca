/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Primitives at a time: the time table, the poses of bodies, and the deformation of the groups that move. */
#include "config.h"

#include "base/fmath.h"
#include "splat/splat_priv.h"
#include "splat/time_curve.h"

/* Interpolate f_t and the poses. */
static void interpolate_time(adcgs_splat *s, float t)
{
    const adcgs_tensor *z = &s->model->net[ADCGS_ROLE_TIME].layer[0].w;
    const size_t width = adcgs_time_columns(s->model);
    if (z->rows == 1) {
        for (size_t j = 0; j < width; j++)
            s->time_code[j] = adcgs_tensor_value(z, j);
        return;
    }
    const adcgs_time_place at = adcgs_time_place_of(t, z->rows);
    const size_t row = at.row;
    for (size_t j = 0; j < width; j++) {
        const float b = adcgs_tensor_value(z, row * width + j), c = adcgs_tensor_value(z, (row + 1) * width + j);
        if (!s->model->params.smooth_time) {
            s->time_code[j] = fmaf(at.fraction, c - b, b);
            continue;
        }
        const float a = row > 0 ? adcgs_tensor_value(z, (row - 1) * width + j) : adcgs_time_beyond(b, c);
        const float d = row + 2 < z->rows ? adcgs_tensor_value(z, (row + 2) * width + j) : adcgs_time_beyond(c, b);
        s->time_code[j] = adcgs_time_blend(at.weight, a, b, c, d);
    }
}

/* Compute the time's part of a deformation network's layer 0: the same for all anchors. */
static void time_part(float *to, const adcgs_floatnet *net, const float *time_code, int width)
{
    const adcgs_float_layer *layer = &net->layer[0];
    for (int o = 0; net->n_layers && o < layer->n_out; o++) {
        const float *w = layer->w + (size_t)(o + 1) * (size_t)layer->n_in - width;
        float sum = layer->b[o];
        for (int i = 0; i < width; i++)
            sum = fmaf(w[i], time_code[i], sum);
        to[o] = sum;
    }
}

/* Outputs of a deformation network for a group; NULL if there is no network. */
static const float *deform_outputs(const adcgs_splat *s, const adcgs_floatnet *net, const float *part, const float *time,
                                   float *z, float *other)
{
    static const _Alignas(64) float ones[ADCGS_LANES] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
                                                         1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
                                                         1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    if (!net->n_layers)
        return NULL;
    /* Weight 1 times the time's part, fused with the anchors' part, is their plain sum. */
    s->dense.dense(z, part, NULL, time, 1, ones, net->layer[0].n_out, 1);
    return adcgs_floatnet_finish(net, &s->dense, z, other);
}

static void deform_group(void *arg, int index, int thread)
{
    const adcgs_splat *s = arg;
    const adcgs_params *p = &s->model->params;
    const uint32_t group = s->moving_group[index];
    const size_t at = (size_t)index, rows = (size_t)s->width * ADCGS_LANES;
    float *z = s->scratch + (size_t)thread * s->scratch_rows * ADCGS_LANES, *other = z + rows;
    const adcgs_movers movers = {s->coarse.n_layers > 0, s->coarse.n_layers > 0 && p->coarse_rotation, p->spans};
    adcgs_anchor_motion motion;
    adcgs_body_lanes lanes;
    const adcgs_body_lanes *bodies = adcgs_bodies_gather(&lanes, s->pose, s->model, group * ADCGS_LANES) ? &lanes : NULL;
    const float *coarse_part = s->coarse_part + at * (size_t)s->coarse.layer[0].n_out * ADCGS_LANES;
    const float *fine_part = s->fine_part + at * (size_t)s->fine.layer[0].n_out * ADCGS_LANES;
    const float *coarse = deform_outputs(s, &s->coarse, coarse_part, s->coarse_time, z, other);
    s->dsp.motion(&motion, s->anchors + at, coarse, &movers, bodies, s->time);
    const float *fine = deform_outputs(s, &s->fine, fine_part, s->fine_time, z, other);
    for (int k = 0; k < p->k; k++) {
        const adcgs_slot_out to = adcgs_slot_out_of(s, group, k);
        s->dsp.deform(&to, s->slots + at * p->k + k, &motion, &movers, bodies, fine ? fine + (size_t)k * 4 * ADCGS_LANES : NULL,
                      s->present + (at * p->k + (size_t)k) * ADCGS_LANES, s->moves + at * ADCGS_LANES);
    }
}

float adcgs_splat_time(const adcgs_model *model, double seconds)
{
    const double span = (model->time_end - model->time_start) + model->reach;
    const double t = span > 0 ? (seconds - model->time_start) / span : 0;
    return t > 0 ? t < 1 ? (float)t : 1.0f : 0.0f;
}

adcgs_status adcgs_splat_at(adcgs_splat *s, float t, adcgs_primitives *out, adcgs_error *error)
{
    const float time = t > 0.0f ? (t < 1.0f ? t : 1.0f) : 0.0f;
    if (s->moving && !(s->has_time && s->time == time)) {
        interpolate_time(s, time);
        adcgs_bodies_at(s->pose, &s->model->params, s->time_code);
        time_part(s->coarse_time, &s->coarse, s->time_code, s->model->params.time_width);
        time_part(s->fine_time, &s->fine, s->time_code, s->model->params.time_width);
        s->time = time;
        adcgs_pool_run(s->pool, deform_group, s, (int)s->moving);
        s->has_time = 1;
    }
    *out = adcgs_rows_primitives(s->out, s->groups * s->model->params.k * ADCGS_LANES);
    return ADCGS_OK;
}
