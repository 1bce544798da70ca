/* SPDX-License-Identifier: BSD-2-Clause */
/** \file SEGM and GEOM: the composition of a time segment, and the positions of its anchors. */
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
    return adcgs_fail(error, ADCGS_ERR_USAGE, "SEGM: %.17g s is not a whole number of ticks of %u/%u s", seconds,
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
    adcgs_syn_step_form form = {STEPS_EQUAL | STEPS_SHORT};
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
        const adcgs_syn_step step = {d[i]};
        const adcgs_syn_step_short high = {(uint16_t)(adcgs_float_bits(d[i]) >> 16)};
        if (form.step_form & STEPS_SHORT)
            ADCGS_TRY(adcgs_syn_step_short_write(out, "SEGM", &high, error));
        else
            ADCGS_TRY(adcgs_syn_step_write(out, "SEGM", &step, error));
    }
    return ADCGS_OK;
}

static adcgs_status parse_roles(adcgs_parse *p, const adcgs_params *params, int predicted, uint16_t mask, adcgs_role_ids *ids)
{
    ids->mask = mask;
    for (int role = 0; role < ADCGS_ROLES; role++) {
        uint32_t id = 0;
        const int present = mask >> role & 1;
        if (present ? !adcgs_role_allowed(params, role) : !predicted && adcgs_role_required(params, role))
            return adcgs_fail(p->error, ADCGS_ERR_DATA, "SEGM: roles is 0x%04x: network %s must be %s", mask,
                              adcgs_role_name(role), present ? "absent" : "present");
        if (present)
            ADCGS_TRY(adcgs_parse_varint(p, "network_id", 0, UINT16_MAX, &id));
        ids->id[role] = (uint16_t)id;
    }
    return ADCGS_OK;
}

/** Parse the part of SEGM about the segment's values. */
static adcgs_status parse_values(adcgs_parse *p, adcgs_model *model)
{
    adcgs_syn_tiers tiers;
    ADCGS_TRY(adcgs_syn_tiers_parse(p, &tiers));
    model->finest = (uint8_t)(tiers.tiers - 1);
    for (int t = 0; t < model->finest; t++) {
        adcgs_syn_growth growth;
        ADCGS_TRY(adcgs_syn_growth_parse(p, &growth));
        model->growth[t] = growth.growth;
    }
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
    return ADCGS_OK;
}

/** Copy the values that a predicted segment inherits from the previous one: coding of values, tiers, and the grid. */
static void inherit_values(adcgs_model *model, const adcgs_model *before)
{
    memcpy(model->d_fv, before->d_fv, sizeof model->d_fv);
    memcpy(model->d_sigma, before->d_sigma, sizeof model->d_sigma);
    memcpy(model->d_colour, before->d_colour, sizeof model->d_colour);
    memcpy(model->d_fg, before->d_fg, sizeof model->d_fg);
    memcpy(model->eta_mu, before->eta_mu, sizeof model->eta_mu);
    memcpy(model->eta_si, before->eta_si, sizeof model->eta_si);
    memcpy(model->growth, before->growth, sizeof model->growth);
    model->finest = before->finest;
    memcpy(model->origin, before->origin, sizeof model->origin);
    model->voxel = before->voxel;
    model->depth = before->depth;
}

adcgs_status adcgs_segm_parse(adcgs_parse *p, const adcgs_stream *stream, adcgs_model *model, adcgs_role_ids *ids,
                              int64_t ticks[3])
{
    adcgs_syn_segm segm;
    ADCGS_TRY(adcgs_syn_segm_parse(p, &segm));
    ADCGS_TRY(parse_roles(p, &model->params, segm.predicted, segm.roles, ids));
    if (!segm.predicted)
        ADCGS_TRY(parse_values(p, model));
    ADCGS_TRY(adcgs_parse_end(p));
    if (segm.end_ticks < segm.start_ticks)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "SEGM: end_ticks is %lld, before start_ticks %lld", (long long)segm.end_ticks,
                          (long long)segm.start_ticks);
    if (segm.predicted && stream->n_segments == 0)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "SEGM: the first segment is predicted");
    if (segm.predicted && stream->segments[stream->n_segments - 1].absent)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "SEGM: it is predicted from a segment with absent tiers");
    if (segm.predicted)
        inherit_values(model, &stream->segments[stream->n_segments - 1]);
    model->predicted = segm.predicted;
    ticks[0] = segm.start_ticks;
    ticks[1] = segm.end_ticks;
    ticks[2] = segm.reach_ticks;
    model->time_start = adcgs_ticks_to_seconds(stream, segm.start_ticks);
    model->time_end = adcgs_ticks_to_seconds(stream, segm.end_ticks);
    model->reach = adcgs_ticks_to_seconds(stream, segm.reach_ticks);
    return ADCGS_OK;
}

adcgs_status adcgs_reach_ticks(const adcgs_stream *stream, const adcgs_model *model, uint32_t *ticks, adcgs_error *error)
{
    int64_t n = 0;
    ADCGS_TRY(adcgs_seconds_to_ticks(stream, model->reach, &n, error));
    if (n < 0 || n > UINT32_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "SEGM: a reach of %g s is %lld ticks, expected 0..2^32 - 1", model->reach,
                          (long long)n);
    *ticks = (uint32_t)n;
    return ADCGS_OK;
}

static adcgs_status write_values(adcgs_buffer *out, const adcgs_model *model, adcgs_error *error)
{
    const adcgs_syn_tiers tiers = {(uint8_t)(model->finest + 1)};
    ADCGS_TRY(adcgs_syn_tiers_write(out, "SEGM", &tiers, error));
    for (int t = 0; t < model->finest; t++) {
        const adcgs_syn_growth growth = {model->growth[t]};
        ADCGS_TRY(adcgs_syn_growth_write(out, "SEGM", &growth, error));
    }
    ADCGS_TRY(write_steps(out, model->d_fv, model->params.n_fv, error));
    ADCGS_TRY(write_steps(out, model->d_sigma, adcgs_sigma_rows(&model->params), error));
    ADCGS_TRY(write_steps(out, model->d_colour, ADCGS_COLOUR_N, error));
    ADCGS_TRY(write_steps(out, model->d_fg, model->params.n_fg, error));
    for (int i = 0; i < model->params.n_eta; i++) {
        const adcgs_syn_eta eta = {model->eta_mu[i], model->eta_si[i]};
        ADCGS_TRY(adcgs_syn_eta_write(out, "SEGM", &eta, error));
    }
    return ADCGS_OK;
}

adcgs_status adcgs_segm_write(adcgs_buffer *out, const adcgs_stream *stream, const adcgs_model *model, const adcgs_role_ids *ids,
                              adcgs_error *error)
{
    adcgs_syn_segm segm = {.predicted = model->predicted, .roles = ids->mask};
    ADCGS_TRY(adcgs_seconds_to_ticks(stream, model->time_start, &segm.start_ticks, error));
    ADCGS_TRY(adcgs_seconds_to_ticks(stream, model->time_end, &segm.end_ticks, error));
    ADCGS_TRY(adcgs_reach_ticks(stream, model, &segm.reach_ticks, error));
    ADCGS_TRY(adcgs_syn_segm_write(out, "SEGM", &segm, error));
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (ids->mask >> role & 1)
            adcgs_write_varint(out, ids->id[role]);
    return model->predicted ? ADCGS_OK : write_values(out, model, error);
}

/** Subtract a cost from the remaining budget, or fail. */
static adcgs_status spend(const adcgs_parse *p, const adcgs_level *limits, adcgs_cost cost, adcgs_cost *left)
{
    if (cost.bytes > left->bytes)
        return adcgs_fail(p->error, ADCGS_ERR_LIMIT, "%s: the models of the stream need more than %llu bytes, the level's limit",
                          p->chunk, (unsigned long long)limits->model_bytes);
    if (cost.work > left->work)
        return adcgs_fail(p->error, ADCGS_ERR_LIMIT, "%s: decoding the stream is more work than %llu, the level's limit",
                          p->chunk, (unsigned long long)limits->work);
    left->bytes -= cost.bytes;
    left->work -= cost.work;
    return ADCGS_OK;
}

adcgs_status adcgs_keep_parse(adcgs_parse *p, const adcgs_level *limits, const adcgs_model *before, adcgs_inter *kept,
                              adcgs_cost *left, adcgs_memory *memory)
{
    const adcgs_cost cost = {.work = adcgs_inter_work(adcgs_inter_values(before))};
    const size_t bytes = adcgs_reader_left(&p->r);
    const uint8_t *data;
    adcgs_range_dec d;
    ADCGS_TRY(spend(p, limits, cost, left));
    ADCGS_TRY(adcgs_parse_bytes(p, "modes", bytes, &data));
    adcgs_range_dec_init(&d, data, bytes);
    ADCGS_TRY(adcgs_inter_decode(kept, before, &d, memory, p->error));
    adcgs_parse_trace_end(p, &d);
    return ADCGS_OK;
}

static adcgs_status check_geom(const adcgs_parse *p, uint32_t anchors, uint32_t others, int depth, const adcgs_level *limits,
                               uint32_t max_anchors)
{
    const uint64_t all = (uint64_t)anchors + others;
    if (all < 1 || all > max_anchors)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "GEOM: anchors is %u in addition to %u others, HEAD allows 1..%u in total",
                          anchors, others, max_anchors);
    if ((uint32_t)depth > limits->depth)
        return adcgs_fail(p->error, ADCGS_ERR_LIMIT, "GEOM: depth is %d, the level allows %u", depth, limits->depth);
    if (depth < 11 && anchors > UINT64_C(1) << 3 * depth)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "GEOM: %u anchors do not fit into a cube of depth %d", anchors, depth);
    return ADCGS_OK;
}

/** Decode the positions of a model whose arrays are allocated. */
static adcgs_status parse_positions(adcgs_parse *p, adcgs_model *model, adcgs_memory *memory)
{
    const size_t bytes = adcgs_reader_left(&p->r);
    const uint8_t *data;
    adcgs_range_dec d;
    ADCGS_TRY(adcgs_parse_bytes(p, "positions", bytes, &data));
    if (model->n == 0)
        return bytes ? adcgs_fail(p->error, ADCGS_ERR_DATA, "GEOM: %zu bytes of positions, but no new anchors", bytes) : ADCGS_OK;
    adcgs_range_dec_init(&d, data, bytes);
    ADCGS_TRY(adcgs_geom_decode(&d, model->n, model->depth, model->pos, memory, p->error));
    adcgs_parse_trace_end(p, &d);
    return ADCGS_OK;
}

adcgs_status adcgs_geom_parse(adcgs_parse *p, const adcgs_level *limits, uint32_t max_anchors, uint32_t others, int tier,
                              adcgs_model *model, adcgs_cost *left, const adcgs_nets_cost *nets, adcgs_memory *memory)
{
    const uint32_t kept = model->predicted ? others : 0;
    adcgs_syn_geom geom;
    ADCGS_TRY(adcgs_syn_geom_parse(p, &geom));
    if (!model->predicted && tier == 0) {
        adcgs_syn_grid grid;
        ADCGS_TRY(adcgs_syn_grid_parse(p, &grid));
        model->depth = grid.depth;
        memcpy(model->origin, grid.origin, sizeof model->origin);
        model->voxel = grid.voxel;
    }
    if (tier > 0 && geom.anchors == 0)
        return adcgs_fail(p->error, ADCGS_ERR_DATA, "GEOM: tier %d has no anchors", tier);
    ADCGS_TRY(check_geom(p, geom.anchors, others, model->depth, limits, max_anchors));
    ADCGS_TRY(spend(p, limits, adcgs_segment_cost(&model->params, (uint64_t)geom.anchors + kept, model->depth, nets), left));
    model->n = geom.anchors;
    ADCGS_TRY(adcgs_model_alloc(model, memory, p->error));
    return parse_positions(p, model, memory);
}

adcgs_status adcgs_geom_write(adcgs_buffer *out, const adcgs_model *model, int tier, adcgs_error *error)
{
    const adcgs_syn_geom geom = {.anchors = model->n};
    ADCGS_TRY(adcgs_syn_geom_write(out, "GEOM", &geom, error));
    if (!model->predicted && tier == 0) {
        adcgs_syn_grid grid = {.depth = model->depth, .voxel = model->voxel};
        memcpy(grid.origin, model->origin, sizeof grid.origin);
        ADCGS_TRY(adcgs_syn_grid_write(out, "GEOM", &grid, error));
    }
    return model->n ? adcgs_geom_encode(out, model->pos, model->n, model->depth, error) : ADCGS_OK;
}
