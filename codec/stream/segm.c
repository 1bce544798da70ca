/* SPDX-License-Identifier: BSD-2-Clause */
/** \file SEGM and GEOM: what a time segment consists of, and where its anchors are. */
#include "geom/geom.h"
#include "model/model_priv.h"
#include "stream/parts.h"

/* Forms of a list of steps. */
#define STEPS_EQUAL 1 /**< one value for all channels */
#define STEPS_SHORT 2 /**< the upper 16 bits of each; the lower are zero */

double adcgs_ticks_to_seconds(const adcgs_stream *stream, int64_t ticks)
{
    return (double)ticks * (double)stream->timebase_num / (double)stream->timebase_den;
}

adcgs_status adcgs_seconds_to_ticks(const adcgs_stream *stream, double seconds, int64_t *ticks, adcgs_error *error)
{
    const double exact = seconds * (double)stream->timebase_den / (double)stream->timebase_num;
    if (exact >= -ADCGS_TICKS_MAX && exact <= ADCGS_TICKS_MAX) {
        const int64_t near = (int64_t)exact;
        for (*ticks = near - 1; *ticks <= near + 1; ++*ticks)
            if (adcgs_ticks_to_seconds(stream, *ticks) == seconds)
                return ADCGS_OK;
    }
    return adcgs_fail(error, ADCGS_ERR_USAGE, "SEGM: %.17g s is no whole number of ticks of %u/%u s", seconds,
                      stream->timebase_num, stream->timebase_den);
}

static adcgs_status parse_step(adcgs_parse *p, int form, float *d)
{
    adcgs_syn_step step;
    if (!(form & STEPS_SHORT)) {
        ADCGS_TRY(adcgs_syn_step_parse(p, &step));
        *d = step.step;
        return ADCGS_OK;
    }
    adcgs_syn_step_short high;
    ADCGS_TRY(adcgs_syn_step_short_parse(p, &high));
    *d = adcgs_bits_float((uint32_t)high.step_high << 16);
    if (!(*d >= 0x1p-40f && *d <= 0x1p10f))
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "SEGM: step_high is 0x%04x, expected the upper half of 2^-40..2^10",
                          high.step_high);
    return ADCGS_OK;
}

static adcgs_status parse_steps(adcgs_parse *p, float *d, int n)
{
    adcgs_syn_step_form form;
    if (n == 0)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_syn_step_form_parse(p, &form));
    const int coded = form.step_form & STEPS_EQUAL ? 1 : n;
    for (int i = 0; i < coded; i++)
        ADCGS_TRY(parse_step(p, form.step_form, &d[i]));
    for (int i = coded; i < n; i++)
        d[i] = d[0];
    return ADCGS_OK;
}

static adcgs_status write_steps(adcgs_buffer *out, const float *d, int n, adcgs_error *error)
{
    adcgs_syn_step_form form = { STEPS_EQUAL | STEPS_SHORT };
    if (n == 0)
        return ADCGS_OK;
    for (int i = 0; i < n; i++) {
        if (adcgs_float_bits(d[i]) != adcgs_float_bits(d[0]))
            form.step_form &= (uint8_t)~STEPS_EQUAL;
        if (adcgs_float_bits(d[i]) & 0xffff)
            form.step_form &= (uint8_t)~STEPS_SHORT;
    }
    ADCGS_TRY(adcgs_syn_step_form_write(out, "SEGM", &form, error));
    for (int i = 0; i < (form.step_form & STEPS_EQUAL ? 1 : n); i++) {
        const adcgs_syn_step step = { d[i] };
        const adcgs_syn_step_short high = { (uint16_t)(adcgs_float_bits(d[i]) >> 16) };
        if (form.step_form & STEPS_SHORT)
            ADCGS_TRY(adcgs_syn_step_short_write(out, "SEGM", &high, error));
        else
            ADCGS_TRY(adcgs_syn_step_write(out, "SEGM", &step, error));
    }
    return ADCGS_OK;
}

static adcgs_status parse_roles(adcgs_parse *p, const adcgs_params *params, uint16_t mask, adcgs_role_ids *ids)
{
    ids->mask = mask;
    for (int role = 0; role < ADCGS_ROLES; role++) {
        uint32_t id = 0;
        const int present = mask >> role & 1;
        if (present ? !adcgs_role_allowed(params, role) : adcgs_role_required(params, role))
            return adcgs_fail(p->error, ADCGS_ERR_DATA, "SEGM: roles is 0x%04x: network %s must be %s", mask,
                              adcgs_role_name(role), present ? "absent" : "present");
        if (present)
            ADCGS_TRY(adcgs_parse_varint(p, "network_id", 0, UINT16_MAX, &id));
        ids->id[role] = (uint16_t)id;
    }
    return ADCGS_OK;
}

adcgs_status adcgs_segm_parse(adcgs_parse *p, const adcgs_stream *stream, adcgs_model *model, adcgs_role_ids *ids,
                              int64_t ticks[2])
{
    adcgs_syn_segm segm;
    ADCGS_TRY(adcgs_syn_segm_parse(p, &segm));
    if (segm.end_ticks < segm.start_ticks)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "SEGM: end_ticks is %lld, before start_ticks %lld", (long long)segm.end_ticks,
                          (long long)segm.start_ticks);
    ticks[0] = segm.start_ticks;
    ticks[1] = segm.end_ticks;
    model->time_start = adcgs_ticks_to_seconds(stream, segm.start_ticks);
    model->time_end = adcgs_ticks_to_seconds(stream, segm.end_ticks);
    for (int g = 0; g < ADCGS_GROUPS; g++)
        model->shape[g] = segm.shapes >> 2 * g & 3;
    ADCGS_TRY(parse_roles(p, &model->params, segm.roles, ids));
    ADCGS_TRY(parse_steps(p, model->d_fv, model->params.n_fv));
    ADCGS_TRY(parse_steps(p, model->d_sigma, adcgs_sigma_rows(&model->params)));
    ADCGS_TRY(parse_steps(p, model->d_colour, ADCGS_COLOUR_N));
    ADCGS_TRY(parse_steps(p, model->d_fg, model->params.n_fg));
    for (int i = 0; i < model->params.n_eta; i++) {
        adcgs_syn_eta eta;
        ADCGS_TRY(adcgs_syn_eta_parse(p, &eta));
        model->eta_mu[i] = eta.eta_mu;
        model->eta_si[i] = eta.eta_si;
    }
    return adcgs_parse_end(p);
}

adcgs_status adcgs_segm_write(adcgs_buffer *out, const adcgs_stream *stream, const adcgs_model *model, const adcgs_role_ids *ids,
                              adcgs_error *error)
{
    adcgs_syn_segm segm = { .roles = ids->mask };
    ADCGS_TRY(adcgs_seconds_to_ticks(stream, model->time_start, &segm.start_ticks, error));
    ADCGS_TRY(adcgs_seconds_to_ticks(stream, model->time_end, &segm.end_ticks, error));
    for (int g = 0; g < ADCGS_GROUPS; g++)
        segm.shapes |= (uint16_t)(model->shape[g] << 2 * g);
    ADCGS_TRY(adcgs_syn_segm_write(out, "SEGM", &segm, error));
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (ids->mask >> role & 1)
            adcgs_write_varint(out, ids->id[role]);
    ADCGS_TRY(write_steps(out, model->d_fv, model->params.n_fv, error));
    ADCGS_TRY(write_steps(out, model->d_sigma, adcgs_sigma_rows(&model->params), error));
    ADCGS_TRY(write_steps(out, model->d_colour, ADCGS_COLOUR_N, error));
    ADCGS_TRY(write_steps(out, model->d_fg, model->params.n_fg, error));
    for (int i = 0; i < model->params.n_eta; i++) {
        const adcgs_syn_eta eta = { model->eta_mu[i], model->eta_si[i] };
        ADCGS_TRY(adcgs_syn_eta_write(out, "SEGM", &eta, error));
    }
    return ADCGS_OK;
}

/** Use up a segment's cost, if that much is left. */
static adcgs_status spend(const adcgs_parse *p, const adcgs_level *limits, adcgs_cost cost, adcgs_cost *left)
{
    if (cost.bytes > left->bytes)
        return adcgs_fail(p->error, ADCGS_ERR_LIMIT,
                          "GEOM: the models of the stream need more than %llu bytes, the level's limit",
                          (unsigned long long)limits->model_bytes);
    if (cost.work > left->work)
        return adcgs_fail(p->error, ADCGS_ERR_LIMIT, "GEOM: decoding the stream is more work than %llu, the level's limit",
                          (unsigned long long)limits->work);
    left->bytes -= cost.bytes;
    left->work -= cost.work;
    return ADCGS_OK;
}

static adcgs_status check_geom(const adcgs_parse *p, const adcgs_syn_geom *g, const adcgs_level *limits, uint32_t max_anchors)
{
    if (g->anchors > max_anchors)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "GEOM: anchors is %u, HEAD allows %u", g->anchors, max_anchors);
    if (g->depth > limits->depth)
        return adcgs_fail(p->error, ADCGS_ERR_LIMIT, "GEOM: depth is %u, the level allows %u", g->depth, limits->depth);
    if (g->depth < 11 && g->anchors > UINT64_C(1) << 3 * g->depth)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "GEOM: %u anchors do not fit into a cube of depth %u", g->anchors, g->depth);
    return ADCGS_OK;
}

adcgs_status adcgs_geom_parse(adcgs_parse *p, const adcgs_level *limits, uint32_t max_anchors, adcgs_model *model,
                              adcgs_cost *left, const adcgs_nets_cost *nets, adcgs_memory *memory)
{
    adcgs_syn_geom g;
    const uint8_t *data;
    adcgs_range_dec d;
    ADCGS_TRY(adcgs_syn_geom_parse(p, &g));
    ADCGS_TRY(check_geom(p, &g, limits, max_anchors));
    ADCGS_TRY(spend(p, limits, adcgs_segment_cost(&model->params, g.anchors, g.depth, nets), left));
    model->n = g.anchors;
    model->depth = g.depth;
    memcpy(model->origin, g.origin, sizeof model->origin);
    model->voxel = g.voxel;
    ADCGS_TRY(adcgs_model_alloc(model, memory, p->error));
    const size_t bytes = adcgs_reader_left(&p->r);
    ADCGS_TRY(adcgs_parse_bytes(p, "positions", bytes, &data));
    adcgs_range_dec_init(&d, data, bytes);
    ADCGS_TRY(adcgs_geom_decode_from(&d, model->n, model->depth, model->pos, memory, p->error));
    adcgs_parse_trace_end(p, &d);
    return ADCGS_OK;
}

adcgs_status adcgs_geom_write(adcgs_buffer *out, const adcgs_model *model, adcgs_error *error)
{
    adcgs_syn_geom g = { .anchors = model->n, .depth = model->depth, .voxel = model->voxel };
    memcpy(g.origin, model->origin, sizeof g.origin);
    ADCGS_TRY(adcgs_syn_geom_write(out, "GEOM", &g, error));
    return adcgs_geom_encode(out, model->pos, model->n, model->depth, error);
}
