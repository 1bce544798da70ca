/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The networks of a recipe: shapes and switches, random numbers within limits, numbers that the recipe sets. */
#include "random_model.h"
#include "recipe_plan.h"

#include "model/model_priv.h"
#include "net/e24.h"

#include <stdlib.h>

/** A network before it has numbers. */
typedef struct shape {
    int absent, layers;
    int width[ADCGS_NET_LAYERS_MAX], shift[ADCGS_NET_LAYERS_MAX], residual[ADCGS_NET_LAYERS_MAX];
    int in_shift, sigma_shift, sigma_offset;
    int limit, bias; /**< largest magnitudes of random numbers */
    int e, bias_e, mode, bias_mode;
} shape;

/** For commands about one network: its role, its shape before it has numbers, and the network itself. */
typedef struct target {
    int role;
    shape *shape;
    adcgs_net *net;
    uint32_t segment;
} target;

/* Sets *about if the role in the command's word 1 is that of this network; fails if it is no role. */
static adcgs_status is_about(const target *t, const adcgs_command *c, int *about, adcgs_error *error)
{
    *about = strcmp(c->word[1], adcgs_role_name(t->role)) == 0;
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (strcmp(c->word[1], adcgs_role_name(role)) == 0)
            return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": no such network", c->word[1]);
}

static shape default_shape(int role, uint32_t n_in)
{
    const int e24 = role < ADCGS_ROLE_PREDICTION, prior = adcgs_role_is_prior(role);
    shape s = {.layers = role == ADCGS_ROLE_TIME || n_in == 0 ? 1 : 2,
               .in_shift = 2 * e24,
               .sigma_shift = 7 * prior,
               .sigma_offset = 16 * prior,
               .limit = e24 ? 60 : 400,
               .bias = e24 ? 2000 : 400,
               .e = e24 ? 0 : 9,
               .bias_e = e24 ? 0 : 9};
    for (int i = 0; i < ADCGS_NET_LAYERS_MAX; i++) {
        s.width[i] = 8;
        s.shift[i] = 7 * e24;
    }
    return s;
}

/* "1,2,3": the last number holds for the rest. */
static adcgs_status parse_list(const char *text, int out[ADCGS_NET_LAYERS_MAX])
{
    char *end = NULL;
    for (int i = 0; i < ADCGS_NET_LAYERS_MAX; i++) {
        out[i] = (int)strtol(text, &end, 0);
        if (*end == ',')
            text = end + 1;
    }
    return *end ? ADCGS_ERR_USAGE : ADCGS_OK;
}

/* net ROLE NAME=VALUE ... */
static adcgs_status shape_net(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    const target *const t = user;
    shape *const s = t->shape;
    const struct {
        const char *name;
        int *value, *list;
    } members[] = {{"layers", &s->layers, NULL},
                   {"width", NULL, s->width},
                   {"shift", NULL, s->shift},
                   {"residual", NULL, s->residual},
                   {"in_shift", &s->in_shift, NULL},
                   {"limit", &s->limit, NULL},
                   {"sigma_shift", &s->sigma_shift, NULL},
                   {"sigma_offset", &s->sigma_offset, NULL},
                   {"e", &s->e, NULL},
                   {"bias", &s->bias, NULL},
                   {"bias_e", &s->bias_e, NULL},
                   {"mode", &s->mode, NULL},
                   {"bias_mode", &s->bias_mode, NULL},
                   {"absent", &s->absent, NULL}};
    int about;
    (void)plan;
    ADCGS_TRY(adcgs_command_words(c, 2, 20, error));
    ADCGS_TRY(is_about(t, c, &about, error));
    for (int i = 2; about && i < c->n; i++) {
        size_t m = 0;
        while (m < ADCGS_COUNTOF(members) && !adcgs_word_value(c->word[i], members[m].name))
            m++;
        int64_t value = 0;
        if (m == ADCGS_COUNTOF(members))
            return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": networks have no such property", c->word[i]);
        const char *const text = adcgs_word_value(c->word[i], members[m].name);
        if (members[m].list && parse_list(text, members[m].list) != ADCGS_OK)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "\"%s\": expected numbers separated by commas", text);
        if (members[m].value) {
            ADCGS_TRY(adcgs_word_int(text, -65536, INT32_MAX, &value, error));
            *members[m].value = (int)value;
        }
    }
    return ADCGS_OK;
}

static adcgs_status fill_tensor(adcgs_tensor *t, uint32_t rows, uint32_t cols, int limit, int e, int mode, uint64_t *state,
                                adcgs_error *error)
{
    *t = (adcgs_tensor){.rows = rows, .cols = cols, .mode = (uint8_t)mode, .e = (uint8_t)e};
    t->m = adcgs_alloc(NULL, (size_t)rows * cols, sizeof *t->m, error);
    if (!t->m)
        return ADCGS_ERR_MEMORY;
    for (size_t i = 0; i < (size_t)rows * cols && limit > 0; i++) {
        const int32_t v = adcgs_random_range(state, 0, 2) ? (int32_t)adcgs_random_range(state, -limit, limit) : 0;
        t->m[i] = mode ? (int32_t)adcgs_float_bits((float)v * 0x1.357p-9f) : v;
    }
    return ADCGS_OK;
}

static adcgs_status make_net(adcgs_plan *plan, const shape *s, int role, adcgs_net *net, adcgs_error *error)
{
    uint32_t n_in, n_out;
    adcgs_role_shape(&plan->stream.params, role, &n_in, &n_out);
    *net = (adcgs_net){.present = 1,
                       .role = (uint8_t)role,
                       .n_layers = (uint8_t)s->layers,
                       .in_shift = (uint8_t)s->in_shift,
                       .sigma_shift = (uint8_t)s->sigma_shift,
                       .sigma_offset = (int16_t)s->sigma_offset};
    for (int i = 0; i < s->layers; i++) {
        adcgs_layer *const l = &net->layer[i];
        const int last = i == s->layers - 1;
        l->residual = (uint8_t)(!last && s->residual[i]);
        l->shift = (uint8_t)s->shift[i];
        const uint32_t rows = last ? n_out : l->residual ? n_in : (uint32_t)s->width[i];
        ADCGS_TRY(fill_tensor(&l->w, rows, n_in, s->limit, s->e, s->mode, &plan->state, error));
        if (role != ADCGS_ROLE_TIME)
            ADCGS_TRY(fill_tensor(&l->b, rows, 1, s->bias, s->bias_e, s->bias_mode, &plan->state, error));
        n_in = rows;
    }
    return ADCGS_OK;
}

/* ROLE LAYER w|b after the verb: the tensor, or NULL if the command is about another network. */
static adcgs_status find_tensor(const target *t, const adcgs_command *c, adcgs_tensor **out, adcgs_error *error)
{
    int64_t layer;
    int about;
    *out = NULL;
    ADCGS_TRY(is_about(t, c, &about, error));
    if (!about)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_word_int(c->word[2], 0, t->net->n_layers - 1, &layer, error));
    *out = c->word[3][0] == 'w' ? &t->net->layer[layer].w : &t->net->layer[layer].b;
    return ADCGS_OK;
}

/* weight ROLE LAYER w|b INDEX|all VALUE; poke takes the same words. +VALUE adds. */
static adcgs_status set_weight(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    adcgs_tensor *t;
    int64_t index = 0, value;
    (void)plan;
    ADCGS_TRY(adcgs_command_words(c, 5, 5, error));
    ADCGS_TRY(find_tensor(user, c, &t, error));
    if (!t)
        return ADCGS_OK;
    const int64_t n = (int64_t)t->rows * t->cols;
    const int all = strcmp(c->word[4], "all") == 0, add = c->word[5][0] == '+';
    if (!all)
        ADCGS_TRY(adcgs_word_int(c->word[4], 0, n - 1, &index, error));
    ADCGS_TRY(adcgs_word_int(c->word[5] + add, INT32_MIN, UINT32_MAX, &value, error));
    for (int64_t i = all ? 0 : index; i < (all ? n : index + 1); i++)
        t->m[i] = (int32_t)(uint32_t)(uint64_t)(value + (add ? t->m[i] : 0));
    return ADCGS_OK;
}

/* ramp ROLE LAYER w|b FIRST COUNT START STEP */
static adcgs_status set_ramp(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    adcgs_tensor *t;
    int64_t v[4];
    (void)plan;
    ADCGS_TRY(adcgs_command_words(c, 7, 7, error));
    ADCGS_TRY(find_tensor(user, c, &t, error));
    for (int i = 0; i < 4; i++)
        ADCGS_TRY(adcgs_word_int(c->word[4 + i], INT32_MIN, INT32_MAX, &v[i], error));
    if (t && (v[0] < 0 || v[1] < 0 || v[0] + v[1] > (int64_t)t->rows * t->cols))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "the tensor has %u x %u numbers", t->rows, t->cols);
    for (int64_t i = 0; t && i < v[1]; i++)
        t->m[v[0] + i] = (int32_t)(v[2] + i * v[3]);
    return ADCGS_OK;
}

/* bound ROLE LAYER ROW -|+: the bias takes the remainder of the row's bound. */
static adcgs_status set_bound(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    const target *const t = user;
    int64_t layer, row, sum = 0;
    int about;
    (void)plan;
    ADCGS_TRY(adcgs_command_words(c, 4, 4, error));
    ADCGS_TRY(is_about(t, c, &about, error));
    if (!about)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_word_int(c->word[2], 0, t->net->n_layers - 1, &layer, error));
    const adcgs_layer *const l = &t->net->layer[layer];
    ADCGS_TRY(adcgs_word_int(c->word[3], 0, l->w.rows - 1, &row, error));
    for (uint32_t i = 0; i < l->w.cols; i++)
        sum += ADCGS_E24_A * (int64_t)abs(l->w.m[(size_t)row * l->w.cols + i]);
    const int is_sigma = layer + 1 == t->net->n_layers && row >= adcgs_net_channels(t->net);
    const int shift = is_sigma ? t->net->sigma_shift : l->shift;
    const int64_t left = (1 << 24) - 1 - sum - (shift ? INT64_C(1) << (shift - 1) : 0);
    if (left < 0)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "the weights of the row exceed its bound");
    l->b.m[row] = (int32_t)(c->word[4][0] == '-' ? -left : left);
    return ADCGS_OK;
}

/* share ROLE ...|all|none: networks that segments take over from the one before; default: all. */
static adcgs_status find_share(adcgs_plan *plan, const adcgs_command *c, void *user, adcgs_error *error)
{
    target *const t = user;
    (void)plan;
    (void)error;
    t->segment = 0;
    for (int i = 1; i < c->n; i++)
        t->segment |= strcmp(c->word[i], "all") == 0 || strcmp(c->word[i], adcgs_role_name(t->role)) == 0;
    return ADCGS_OK;
}

static adcgs_status role_net(adcgs_plan *plan, uint32_t segment, int role, adcgs_error *error)
{
    uint32_t n_in, n_out;
    adcgs_role_shape(&plan->stream.params, role, &n_in, &n_out);
    shape s = default_shape(role, n_in);
    adcgs_net *const net = &plan->stream.segments[segment].net[role];
    target t = {role, &s, net, 1};
    ADCGS_TRY(adcgs_plan_each(plan, "net", shape_net, &t, error));
    ADCGS_TRY(adcgs_plan_each(plan, "share", find_share, &t, error));
    if (s.absent)
        return ADCGS_OK;
    if (segment > 0 && t.segment)
        return adcgs_net_copy(net, &plan->stream.segments[segment - 1].net[role], NULL, error);
    if (s.layers < 1 || s.layers > ADCGS_NET_LAYERS_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: %d layers", adcgs_role_name(role), s.layers);
    ADCGS_TRY(make_net(plan, &s, role, net, error));
    ADCGS_TRY(adcgs_plan_each(plan, "weight", set_weight, &t, error));
    ADCGS_TRY(adcgs_plan_each(plan, "ramp", set_ramp, &t, error));
    return adcgs_plan_each(plan, "bound", set_bound, &t, error);
}

adcgs_status adcgs_plan_nets(adcgs_plan *plan, uint32_t segment, adcgs_error *error)
{
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (adcgs_role_allowed(&plan->stream.params, role))
            ADCGS_TRY(role_net(plan, segment, role, error));
    return ADCGS_OK;
}

adcgs_status adcgs_plan_set_weight(adcgs_plan *plan, const adcgs_command *command, adcgs_net *net, adcgs_error *error)
{
    target t = {.role = net->role, .net = net};
    return set_weight(plan, command, &t, error);
}
