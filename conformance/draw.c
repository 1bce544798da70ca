/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The models of a recipe: positions, flags, bodies, masks, steps and priors; then their tiers and segments. */
#include "draw.h"

#include "geom/geom.h"
#include "model/model_priv.h"
#include "stream/parts.h"

/* ---- Positions ---- */

static void place_code(uint32_t voxel[3], uint64_t code)
{
    for (int bit = 0; bit < 63; bit++)
        voxel[2 - bit % 3] |= (uint32_t)(code >> bit & 1) << bit / 3;
}

/* The Morton code of anchor i of n; codes ascend with i. */
static uint64_t code_of(adcgs_plan *plan, uint32_t i, uint32_t n, int depth)
{
    const uint64_t cells = UINT64_C(1) << 3 * depth, half = n / 2;
    const uint64_t stride = cells / n;
    switch (plan->positions) {
    case ADCGS_SPREAD_DENSE:
        return i;
    case ADCGS_SPREAD_MIXED:
        return i < half ? i : half + (i - half) * ((cells - half) / (n - half));
    case ADCGS_SPREAD_ENDS:
        return i < half ? i : cells - n + i;
    default:
        return i * stride + adcgs_random_next(&plan->state) % stride;
    }
}

static void place_anchors(adcgs_plan *plan, adcgs_model *m)
{
    const uint32_t side = 1U << m->depth;
    for (uint32_t i = 0; i < m->n; i++) {
        uint32_t *const voxel = m->pos + 3 * (size_t)i;
        if (plan->positions == ADCGS_SPREAD_LINE) {
            voxel[0] = (uint32_t)((uint64_t)i * side / m->n);
        } else if (plan->positions == ADCGS_SPREAD_PLANE) {
            const uint64_t stride = (uint64_t)side * side / m->n, cell = i * stride + adcgs_random_next(&plan->state) % stride;
            for (int bit = 0; bit < 2 * m->depth; bit++)
                voxel[1 - bit % 2] |= (uint32_t)(cell >> bit & 1) << bit / 2;
            voxel[2] = side / 2;
        } else {
            place_code(voxel, code_of(plan, i, m->n, m->depth));
        }
    }
}

static unsigned pick(adcgs_plan *plan, int how, uint32_t i, unsigned all)
{
    switch (how) {
    case ADCGS_PICK_ALL:
        return all;
    case ADCGS_PICK_NONE:
        return 0;
    case ADCGS_PICK_FIRST:
        return 1;
    case ADCGS_PICK_TURNS:
        return i % 2 ? all : 0;
    default:
        return (unsigned)(adcgs_random_next(&plan->state) | adcgs_random_next(&plan->state)) & all;
    }
}

/* ---- Bodies ---- */

/* The body, 0 to most, of an anchor that is not static; last: the body of the one before. Random bodies come in runs. */
static int pick_body(adcgs_plan *plan, uint32_t i, int most, int last)
{
    switch (plan->bodies) {
    case ADCGS_PICK_ALL:
        return most;
    case ADCGS_PICK_NONE:
        return 0;
    case ADCGS_PICK_FIRST:
        return 1;
    case ADCGS_PICK_TURNS:
        return (int)(i % (unsigned)(most + 1));
    default:
        return adcgs_draw_int(&plan->state, 0, 3) ? last : adcgs_draw_int(&plan->state, 0, most);
    }
}

/* body FIRST COUNT BODY */
static adcgs_status set_body(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    adcgs_model *const m = user;
    int64_t first, count, body;
    (void)plan;
    ADCGS_TRY(adcgs_command_words(c, 3, 3, error));
    ADCGS_TRY(adcgs_word_int(c->word[1], 0, ADCGS_ANCHORS_MAX, &first, error));
    ADCGS_TRY(adcgs_word_int(c->word[2], 0, ADCGS_ANCHORS_MAX, &count, error));
    ADCGS_TRY(adcgs_word_int(c->word[3], 0, m->params.bodies, &body, error));
    for (int64_t i = first; i < ADCGS_MIN(first + count, (int64_t)m->n); i++)
        m->body[i] = (uint8_t)(m->is_static[i] ? 0 : body);
    return ADCGS_OK;
}

static adcgs_status fill_bodies(adcgs_plan *plan, adcgs_model *m, adcgs_error *error)
{
    int last = 0;
    for (uint32_t i = 0; m->params.bodies && i < m->n; i++)
        if (!m->is_static[i])
            m->body[i] = (uint8_t)(last = pick_body(plan, i, m->params.bodies, last));
    return adcgs_plan_each(plan, "body", set_body, m, error);
}

/* ---- Steps and priors ---- */

/* form as in the stream: bit 0, one value for all channels; bit 1, the lower half of the number is 0. */
static void fill_steps(float *d, int n, int form, double value)
{
    for (int i = 0; i < n; i++) {
        const uint32_t bits = adcgs_float_bits((float)(value * (form & 1 ? 1.0 : 1.0 + 0.0625 * i)));
        d[i] = adcgs_bits_float(form & 2 ? bits & 0xffff0000 : bits | 1);
    }
}

/* steps fv|sigma|colour|fg FORM VALUE */
static adcgs_status set_steps(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    static const char *const groups[] = {"fv", "sigma", "colour", "fg", NULL};
    adcgs_model *const m = user;
    float *const d[] = {m->d_fv, m->d_sigma, m->d_colour, m->d_fg};
    const int n[] = {m->params.n_fv, adcgs_sigma_rows(&m->params), ADCGS_COLOUR_N, m->params.n_fg};
    int group;
    int64_t form;
    double value;
    (void)plan;
    ADCGS_TRY(adcgs_command_words(c, 3, 3, error));
    ADCGS_TRY(adcgs_word_choice(c->word[1], groups, &group, error));
    ADCGS_TRY(adcgs_word_int(c->word[2], 0, 3, &form, error));
    ADCGS_TRY(adcgs_word_real(c->word[3], &value, error));
    fill_steps(d[group], n[group], (int)form, value);
    return ADCGS_OK;
}

/* eta_mu M.., eta_si S..: the last number holds for the rest. */
static adcgs_status set_table(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    adcgs_model *const m = user;
    int64_t value = 0;
    (void)plan;
    ADCGS_TRY(adcgs_command_words(c, 1, ADCGS_GROUPS, error));
    for (int i = 0; i < ADCGS_GROUPS; i++) {
        if (i + 1 < c->n)
            ADCGS_TRY(adcgs_word_int(c->word[1 + i], -32767, 32767, &value, error));
        if (adcgs_command_is(c, "eta_mu"))
            m->eta_mu[i] = (int16_t)value;
        else
            m->eta_si[i] = (uint8_t)(value & 63);
    }
    return ADCGS_OK;
}

static adcgs_status fill_tables(adcgs_plan *plan, adcgs_model *m, adcgs_error *error)
{
    fill_steps(m->d_fv, m->params.n_fv, 0, 0x1p-10);
    fill_steps(m->d_sigma, adcgs_sigma_rows(&m->params), 0, 0x1p-10);
    fill_steps(m->d_colour, ADCGS_COLOUR_N, 0, 0x1p-11);
    fill_steps(m->d_fg, m->params.n_fg, 0, 0x1p-10);
    for (int i = 0; i < ADCGS_ETA_MAX; i++) {
        m->eta_mu[i] = (int16_t)adcgs_draw_int(&plan->state, -400, 400);
        m->eta_si[i] = (uint8_t)adcgs_draw_int(&plan->state, 0, ADCGS_SIGMA_LEVELS - 1);
    }
    ADCGS_TRY(adcgs_plan_each(plan, "steps", set_steps, m, error));
    ADCGS_TRY(adcgs_plan_each(plan, "eta_mu", set_table, m, error));
    ADCGS_TRY(adcgs_plan_each(plan, "eta_si", set_table, m, error));
    m->voxel = plan->voxel > 0 ? (float)plan->voxel : 2.0f / (float)(1U << m->depth);
    for (int a = 0; a < 3; a++)
        m->origin[a] = (float)plan->origin[a];
    return ADCGS_OK;
}

/* ---- Models ---- */

/* Draws and codes the anchors of a tier, whose positions are set. */
static adcgs_status draw_tier(adcgs_plan *plan, adcgs_model *m, int tier, adcgs_drawn_tier *out, adcgs_error *error)
{
    for (uint32_t i = 0; i < m->n; i++) {
        m->is_static[i] = (uint8_t)(m->params.time_rows > 0 ? pick(plan, plan->statics, i, 1) : 0);
        m->mask[i] = (uint16_t)pick(plan, plan->masks, i, (1U << m->params.k) - 1);
    }
    ADCGS_TRY(fill_bodies(plan, m, error));
    ADCGS_TRY(adcgs_geom_write(&out->geom, m, tier, error));
    return adcgs_draw_slices(plan, m, out, error);
}

/* Distributes the anchors over tiers and draws the tiers one after the other. */
static adcgs_status draw_tiers(adcgs_plan *plan, adcgs_model *m, adcgs_drawn *out, adcgs_error *error)
{
    adcgs_model all = adcgs_model_frame(m), part;
    adcgs_status status = ADCGS_OK;
    all.n = 0;
    for (uint32_t i = 0; i < m->n; i++)
        m->tier[i] = (uint8_t)(i <= m->finest ? (int)i : adcgs_draw_int(&plan->state, 0, m->finest));
    for (int tier = 0; tier <= m->finest && status == ADCGS_OK; tier++) {
        status = adcgs_model_tier(&part, m, tier, NULL, error);
        if (status == ADCGS_OK)
            status = draw_tier(plan, &part, tier, &out->tier[tier], error);
        if (status == ADCGS_OK)
            status = adcgs_tiers_join(&all, &part, NULL, error);
        adcgs_model_clear(&all, NULL);
        all = part;
    }
    adcgs_model_clear(m, NULL);
    *m = all;
    return status;
}

/* Draws and codes the anchors of a model; kept: anchors that a predicted model keeps, else NULL. */
static adcgs_status draw_anchors(adcgs_plan *plan, uint32_t segment, const adcgs_inter *kept, adcgs_error *error)
{
    adcgs_model *const m = &plan->stream.segments[segment];
    adcgs_drawn *const out = &plan->drawn[segment];
    ADCGS_TRY(adcgs_plan_nets(plan, segment, error));
    ADCGS_TRY(adcgs_model_alloc(m, NULL, error));
    place_anchors(plan, m);
    if (kept)
        ADCGS_TRY(adcgs_random_settle(m, kept, m - 1, error));
    return m->finest && !kept ? draw_tiers(plan, m, out, error) : draw_tier(plan, m, 0, &out->tier[0], error);
}

static adcgs_status draw_key(adcgs_plan *plan, uint32_t segment, adcgs_error *error)
{
    adcgs_model *const m = &plan->stream.segments[segment];
    m->params = plan->stream.params;
    m->depth = plan->depth;
    m->layers = (uint8_t)adcgs_params_layers(&m->params);
    m->n = plan->anchors[segment];
    m->finest = (uint8_t)(plan->tiers ? ADCGS_MIN((uint32_t)plan->tiers, m->n) - 1 : 0);
    for (int t = 0; t < m->finest; t++)
        m->growth[t] = (uint8_t)plan->growth[t];
    ADCGS_TRY(fill_tables(plan, m, error));
    return draw_anchors(plan, segment, NULL, error);
}

static adcgs_status draw_predicted(adcgs_plan *plan, uint32_t segment, adcgs_error *error)
{
    adcgs_model *const m = &plan->stream.segments[segment], *const before = m - 1;
    adcgs_inter kept = {.n = 0};
    *m = adcgs_random_frame(before);
    m->n = plan->anchors[segment];
    adcgs_status status = adcgs_plan_keep(plan, before, &kept, error);
    if (status == ADCGS_OK)
        status = adcgs_inter_encode(&kept, before, &plan->drawn[segment].keep, error);
    if (status == ADCGS_OK)
        status = draw_anchors(plan, segment, &kept, error);
    if (status == ADCGS_OK)
        status = adcgs_random_join(&kept, before, m, error);
    adcgs_inter_clear(&kept, NULL);
    return status;
}

static adcgs_status draw_model(adcgs_plan *plan, uint32_t segment, adcgs_error *error)
{
    adcgs_model *const m = &plan->stream.segments[segment];
    if (plan->depth > ADCGS_GEOM_DEPTH_MAX || plan->anchors[segment] > UINT64_C(1) << 3 * plan->depth)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%u anchors do not fit into depth %u", plan->anchors[segment], plan->depth);
    ADCGS_TRY(plan->predicted[segment] ? draw_predicted(plan, segment, error) : draw_key(plan, segment, error));
    m->time_start = adcgs_ticks_to_seconds(&plan->stream, plan->ticks[2 * segment]);
    m->time_end = adcgs_ticks_to_seconds(&plan->stream, plan->ticks[2 * segment + 1]);
    m->reach = adcgs_ticks_to_seconds(&plan->stream, plan->reach[segment]);
    return ADCGS_OK;
}

adcgs_status adcgs_plan_draw(adcgs_plan *plan, adcgs_error *error)
{
    adcgs_stream *const s = &plan->stream;
    ADCGS_TRY(adcgs_params_validate(&s->params, error));
    ADCGS_TRY(adcgs_draw_check(plan, error));
    s->segments = adcgs_alloc(NULL, plan->segments, sizeof *s->segments, error);
    if (!s->segments)
        return ADCGS_ERR_MEMORY;
    s->n_segments = plan->segments;
    s->start_ticks = plan->ticks[0];
    s->duration_ticks = plan->ticks[2 * plan->segments - 1] - plan->ticks[0];
    for (uint32_t i = 0; i < plan->segments; i++)
        ADCGS_TRY(draw_model(plan, i, error));
    return ADCGS_OK;
}
