/* SPDX-License-Identifier: BSD-2-Clause */
/** \file NETW: the shapes of networks in bytes, then all their values in one range-coded sub-stream. */
#include "model/model_priv.h"
#include "stream/parts.h"

#define FORM_RESIDUAL 128
#define FORM_MODE 64
#define FORM_E 63

static int is_e24(int role)
{
    return role < ADCGS_ROLE_PREDICTION;
}

void adcgs_net_table_clear(adcgs_net_table *table)
{
    for (uint32_t i = 0; i < table->n; i++)
        adcgs_net_release(&table->nets[i], table->memory);
    adcgs_free(table->memory, table->nets);
    *table = (adcgs_net_table){.memory = table->memory};
}

/** Reserve memory for n ids. */
static adcgs_status reserve(adcgs_net_table *table, uint32_t n, adcgs_error *error)
{
    uint32_t capacity = table->capacity ? table->capacity : 16;
    while (capacity < n)
        capacity *= 2;
    if (capacity == table->capacity)
        return ADCGS_OK;
    adcgs_net *nets = adcgs_alloc(table->memory, capacity, sizeof *nets, error);
    if (!nets)
        return adcgs_alloc_status(error);
    if (table->n > 0)
        memcpy(nets, table->nets, table->n * sizeof *nets);
    adcgs_free(table->memory, table->nets);
    table->nets = nets;
    table->capacity = capacity;
    return ADCGS_OK;
}

static adcgs_status add_net(adcgs_net_table *table, adcgs_net *net, uint32_t id, adcgs_error *error)
{
    ADCGS_TRY(reserve(table, id + 1, error));
    table->n = ADCGS_MAX(table->n, id + 1);
    table->nets[id] = *net;
    table->weights += adcgs_net_weights(net);
    memset(net, 0, sizeof *net);
    return ADCGS_OK;
}

static void set_form(adcgs_tensor *t, uint32_t rows, uint32_t cols, uint8_t form)
{
    t->rows = rows;
    t->cols = cols;
    t->mode = (form & FORM_MODE) != 0;
    t->e = form & FORM_E;
}

static adcgs_status parse_layer(adcgs_parse *p, adcgs_net *net, int i, uint32_t n_in, uint32_t *n_out)
{
    adcgs_layer *l = &net->layer[i];
    adcgs_syn_layer weight;
    adcgs_syn_layer_bias bias;
    if (i < net->n_layers - 1)
        ADCGS_TRY(adcgs_parse_varint(p, "width", 1, ADCGS_NET_WIDTH_MAX, n_out));
    ADCGS_TRY(adcgs_syn_layer_parse(p, &weight));
    set_form(&l->w, *n_out, n_in, weight.weight_form);
    l->residual = (weight.weight_form & FORM_RESIDUAL) != 0;
    if (net->role != ADCGS_ROLE_TIME) {
        ADCGS_TRY(adcgs_syn_layer_bias_parse(p, &bias));
        set_form(&l->b, *n_out, 1, bias.bias_form);
    }
    if (is_e24(net->role)) {
        adcgs_syn_layer_e24 e24;
        ADCGS_TRY(adcgs_syn_layer_e24_parse(p, &e24));
        l->shift = e24.shift;
    }
    return ADCGS_OK;
}

/** Parse everything except the values. check_shapes() refuses a role without outputs, which the parameters do not have. */
static adcgs_status parse_shape(adcgs_parse *p, const adcgs_params *params, adcgs_net *net)
{
    adcgs_syn_net head;
    uint32_t n_in, n_out, width = 0;
    ADCGS_TRY(adcgs_syn_net_parse(p, &head));
    adcgs_role_shape(params, head.role, &n_in, &n_out);
    net->present = 1;
    net->role = head.role;
    net->n_layers = head.n_layers;
    if (is_e24(head.role)) {
        adcgs_syn_net_e24 e24;
        ADCGS_TRY(adcgs_syn_net_e24_parse(p, &e24));
        net->in_shift = e24.in_shift;
    }
    if (adcgs_role_is_prior(head.role)) {
        adcgs_syn_net_prior prior;
        ADCGS_TRY(adcgs_syn_net_prior_parse(p, &prior));
        net->sigma_shift = prior.sigma_shift;
        net->sigma_offset = prior.sigma_offset;
    }
    for (int i = 0; i < net->n_layers; i++, n_in = width) {
        width = n_out; /* the last layer's width; parse_layer() reads those of the other layers */
        ADCGS_TRY(parse_layer(p, net, i, n_in, &width));
    }
    return ADCGS_OK;
}

static adcgs_status decode_tensor(adcgs_parse *p, adcgs_range_dec *d, adcgs_tensor *t, adcgs_memory *memory)
{
    const size_t n = (size_t)t->rows * t->cols;
    t->m = adcgs_alloc(memory, n, sizeof *t->m, p->error);
    if (!t->m)
        return adcgs_alloc_status(p->error);
    return n > 0 ? adcgs_tensor_decode(d, t, p->error) : ADCGS_OK;
}

static adcgs_status decode_values(adcgs_parse *p, adcgs_net *nets, uint32_t n, adcgs_memory *memory)
{
    const size_t left = adcgs_reader_left(&p->r);
    const uint8_t *data;
    adcgs_range_dec d;
    ADCGS_TRY(adcgs_parse_bytes(p, "values", left, &data));
    adcgs_range_dec_init(&d, data, left);
    for (uint32_t i = 0; i < n; i++)
        for (int l = 0; l < nets[i].n_layers; l++) {
            ADCGS_TRY(decode_tensor(p, &d, &nets[i].layer[l].w, memory));
            if (nets[i].role != ADCGS_ROLE_TIME)
                ADCGS_TRY(decode_tensor(p, &d, &nets[i].layer[l].b, memory));
        }
    ADCGS_TRY(adcgs_range_dec_finish(&d, p->error));
    adcgs_parse_trace_end(p, &d);
    return ADCGS_OK;
}

/** The network of an id; NULL if it does not exist or was not read. */
static const adcgs_net *known(const adcgs_net_table *table, uint32_t id)
{
    return id < table->n && table->nets[id].present ? &table->nets[id] : NULL;
}

/**
 * Perform all checks that are possible before the values are decoded, so that damage costs neither time nor memory. A repeated
 * network must have as many weights as the network that it repeats; only new networks count towards the level's weights.
 */
static adcgs_status check_shapes(const adcgs_params *params, const adcgs_level *limits, const adcgs_net *nets, uint32_t n,
                                 uint32_t first_id, const adcgs_net_table *table, adcgs_cost *left, adcgs_error *error)
{
    uint64_t weights = table->weights;
    if (first_id > table->n && !table->has_gaps)
        return adcgs_fail(error, ADCGS_ERR_DATA, "NETW: network id is %u, expected at most %u", first_id, table->n);
    for (uint32_t i = 0; i < n; i++) {
        const adcgs_net *before = known(table, first_id + i);
        if (!adcgs_role_allowed(params, nets[i].role))
            return adcgs_fail(error, ADCGS_ERR_DATA, "NETW: role %u is not used with these parameters", nets[i].role);
        if (before && adcgs_net_weights(before) != adcgs_net_weights(&nets[i]))
            return adcgs_fail(error, ADCGS_ERR_DATA, "NETW: network %u is repeated with other contents", first_id + i);
        weights += before ? 0 : adcgs_net_weights(&nets[i]);
        if (weights > limits->weights)
            return adcgs_fail(error, ADCGS_ERR_LIMIT, "NETW: more than %u weights, the level's limit", limits->weights);
        if (first_id + i >= limits->networks)
            return adcgs_fail(error, ADCGS_ERR_LIMIT, "NETW: more than %u networks, the level's limit", limits->networks);
        const uint64_t work = adcgs_weights_work(adcgs_net_weights(&nets[i])); /* repeated ones count: they are decoded */
        if (work > left->work)
            return adcgs_fail(error, ADCGS_ERR_LIMIT, "NETW: decoding the stream is more work than %llu, the level's limit",
                              (unsigned long long)limits->work);
        left->work -= work;
    }
    return ADCGS_OK;
}

/** Enter the networks of a chunk into the table; networks that the table takes over are zeroed here. */
static adcgs_status enter_nets(adcgs_parse *p, const adcgs_params *params, adcgs_net *nets, uint32_t n, uint32_t id,
                               adcgs_net_table *table)
{
    for (uint32_t i = 0; i < n; i++, id++) {
        if (known(table, id)) {
            if (!adcgs_net_equal(&nets[i], &table->nets[id]))
                return adcgs_fail(p->error, ADCGS_ERR_DATA, "NETW: network %u is repeated with other contents", id);
            continue;
        }
        ADCGS_TRY(adcgs_net_validate(params, nets[i].role, &nets[i], p->error));
        ADCGS_TRY(add_net(table, &nets[i], id, p->error));
    }
    return ADCGS_OK;
}

static adcgs_status parse_nets(adcgs_parse *p, const adcgs_params *params, const adcgs_level *limits, adcgs_cost *left,
                               adcgs_net *nets, adcgs_net_table *table)
{
    uint32_t first_id, n;
    ADCGS_TRY(adcgs_parse_varint(p, "first_id", 0, UINT16_MAX, &first_id));
    ADCGS_TRY(adcgs_parse_varint(p, "networks", 1, ADCGS_ROLES, &n));
    for (uint32_t i = 0; i < n; i++)
        ADCGS_TRY(parse_shape(p, params, &nets[i]));
    ADCGS_TRY(check_shapes(params, limits, nets, n, first_id, table, left, p->error));
    ADCGS_TRY(decode_values(p, nets, n, table->memory));
    table->sent[0] = first_id;
    table->sent[1] = first_id + n;
    return enter_nets(p, params, nets, n, first_id, table);
}

adcgs_status adcgs_netw_parse(adcgs_parse *p, const adcgs_params *params, const adcgs_level *limits, adcgs_cost *left,
                              adcgs_net_table *table)
{
    adcgs_net *nets = adcgs_alloc(table->memory, ADCGS_ROLES, sizeof *nets, p->error);
    if (!nets)
        return adcgs_alloc_status(p->error);
    const adcgs_status status = parse_nets(p, params, limits, left, nets, table);
    for (int i = 0; i < ADCGS_ROLES; i++)
        adcgs_net_release(&nets[i], table->memory);
    adcgs_free(table->memory, nets);
    return status;
}

static adcgs_status write_layer(adcgs_buffer *out, const adcgs_net *net, int i, adcgs_error *error)
{
    const adcgs_layer *l = &net->layer[i];
    const adcgs_syn_layer weight = {(uint8_t)(l->residual * FORM_RESIDUAL + l->w.mode * FORM_MODE + l->w.e)};
    const adcgs_syn_layer_bias bias = {(uint8_t)(l->b.mode * FORM_MODE + l->b.e)};
    const adcgs_syn_layer_e24 e24 = {l->shift};
    if (i < net->n_layers - 1)
        adcgs_write_varint(out, l->w.rows);
    ADCGS_TRY(adcgs_syn_layer_write(out, "NETW", &weight, error));
    if (net->role != ADCGS_ROLE_TIME)
        ADCGS_TRY(adcgs_syn_layer_bias_write(out, "NETW", &bias, error));
    return is_e24(net->role) ? adcgs_syn_layer_e24_write(out, "NETW", &e24, error) : ADCGS_OK;
}

static adcgs_status write_shape(adcgs_buffer *out, const adcgs_net *net, adcgs_error *error)
{
    const adcgs_syn_net head = {net->role, net->n_layers};
    const adcgs_syn_net_e24 e24 = {net->in_shift};
    const adcgs_syn_net_prior prior = {net->sigma_shift, net->sigma_offset};
    ADCGS_TRY(adcgs_syn_net_write(out, "NETW", &head, error));
    if (is_e24(net->role))
        ADCGS_TRY(adcgs_syn_net_e24_write(out, "NETW", &e24, error));
    if (adcgs_role_is_prior(net->role))
        ADCGS_TRY(adcgs_syn_net_prior_write(out, "NETW", &prior, error));
    for (int i = 0; i < net->n_layers; i++)
        ADCGS_TRY(write_layer(out, net, i, error));
    return ADCGS_OK;
}

static void encode_tensor(adcgs_range_enc *e, const adcgs_tensor *t)
{
    if (t->rows > 0 && t->cols > 0)
        adcgs_tensor_encode(e, t);
}

adcgs_status adcgs_netw_write(adcgs_buffer *out, const adcgs_net *const *nets, uint32_t n, uint32_t first_id, adcgs_error *error)
{
    adcgs_range_enc e;
    adcgs_write_varint(out, first_id);
    adcgs_write_varint(out, n);
    for (uint32_t i = 0; i < n; i++)
        ADCGS_TRY(write_shape(out, nets[i], error));
    adcgs_range_enc_init(&e, out);
    for (uint32_t i = 0; i < n; i++)
        for (int l = 0; l < nets[i]->n_layers; l++) {
            encode_tensor(&e, &nets[i]->layer[l].w);
            if (nets[i]->role != ADCGS_ROLE_TIME)
                encode_tensor(&e, &nets[i]->layer[l].b);
        }
    adcgs_range_enc_finish(&e);
    return ADCGS_OK;
}
