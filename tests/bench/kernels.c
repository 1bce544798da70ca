/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kernels of networks, entropy coding and training. */
#include "bench_parts.h"
#include "unit/decode_positions.h"

#include "bits/range.h"
#include "geom/geom.h"
#include "grad/dsp.h"
#include "grad/random.h"
#include "net/net.h"

#include <stdlib.h>

/* ---- Dense layers and their gradients ---- */

typedef struct layer {
    adcgs_train_dsp dsp, bf16;
    int width;
    float *w, *bias, *x, *y, *gw, *gb;
} layer;

static void run_dense(const adcgs_train_dsp *dsp, const layer *l)
{
    dsp->dense.dense(l->y, NULL, l->bias, l->w, (size_t)l->width, l->x, l->width, l->width);
}

static void run_weight_grad(const adcgs_train_dsp *dsp, const layer *l)
{
    dsp->weight_grad(l->gw, (size_t)l->width, l->gb, l->y, 0, l->x, 0, 1, l->width, l->width);
}

static void dense(void *arg)
{
    run_dense(&((layer *)arg)->dsp, arg);
}

static void dense_bf16(void *arg)
{
    run_dense(&((layer *)arg)->bf16, arg);
}

static void weight_grad(void *arg)
{
    run_weight_grad(&((layer *)arg)->dsp, arg);
}

static void weight_grad_bf16(void *arg)
{
    run_weight_grad(&((layer *)arg)->bf16, arg);
}

/** Numbers within (-size, size). */
static float *random_floats(size_t n, float size)
{
    float *p = bench_floats(n);
    for (size_t i = 0; i < n; i++)
        p[i] = size * (float)(2 * adcgs_random_unit(1, n, i) - 1);
    return p;
}

static void dense_layers(const bench *b)
{
    static const int widths[] = {32, 48, 64, 128, 256};
    const int each = adcgs_bf16_check(b->level, NULL) == ADCGS_OK ? 2 : 1;
    for (size_t i = 0; i < ADCGS_COUNTOF(widths); i++) {
        const size_t n = (size_t)widths[i];
        const double operations = 2.0 * 64 * (double)(n * n);
        char group[32];
        layer l = {.width = widths[i]};
        snprintf(group, sizeof group, "dense layer of %d", widths[i]);
        adcgs_train_dsp_init(&l.dsp, b->level);
        adcgs_train_dsp_init_bf16(&l.bf16, b->level);
        l.w = random_floats(n * n, 0.1f);
        l.x = random_floats(64 * n, 1);
        l.bias = bench_floats(n);
        l.y = bench_floats(64 * n);
        l.gw = bench_floats(n * n);
        l.gb = bench_floats(n);
        const bench_place place = {.group = group, .anchors = 64, .threads = 1};
        const bench_item forward[] = {{"forward", dense, &l, operations, "operation", 1},
                                      {"forward in bf16", dense_bf16, &l, operations, "operation", 1}};
        const bench_item weights[] = {{"gradient of weights", weight_grad, &l, operations, "operation", 1},
                                      {"the same in bf16", weight_grad_bf16, &l, operations, "operation", 1}};
        bench_group(b, &place, forward, each, 1);
        bench_group(b, &place, weights, each, 1);
        float *const parts[] = {l.w, l.bias, l.x, l.y, l.gw, l.gb};
        for (size_t j = 0; j < ADCGS_COUNTOF(parts); j++)
            adcgs_free(NULL, parts[j]);
    }
}

/* ---- Integer networks ---- */

typedef struct integer_net {
    adcgs_e24 *net;
    int16_t *x, *mu;
    uint8_t *si;
    void *scratch;
} integer_net;

static void evaluate(void *arg)
{
    integer_net *n = arg;
    adcgs_e24_eval(n->net, n->x, n->mu, n->si, n->scratch);
}

static void fill_tensor(adcgs_tensor *t, uint32_t rows, uint32_t cols)
{
    *t = (adcgs_tensor){.rows = rows, .cols = cols, .m = (void *)bench_floats((size_t)rows * cols)};
    for (size_t i = 0; i < (size_t)rows * cols; i++)
        t->m[i] = (int32_t)(adcgs_random64(2, rows, i) % 101) - 50;
}

static void integer_nets(const bench *b)
{
    static const int widths[] = {16, 24, 64, 128};
    adcgs_error error = {.status = ADCGS_OK};
    for (size_t i = 0; i < ADCGS_COUNTOF(widths); i++) {
        const uint32_t n_in = 36, width = (uint32_t)widths[i], n_out = 24;
        char group[40];
        snprintf(group, sizeof group, "integer network %u > %u > %u", n_in, width, n_out);
        adcgs_net net = {.present = 1, .role = ADCGS_ROLE_ENTROPY_SIGMA, .n_layers = 2, .in_shift = 4, .sigma_shift = 8};
        net.layer[0].shift = net.layer[1].shift = 8;
        fill_tensor(&net.layer[0].w, width, n_in);
        fill_tensor(&net.layer[0].b, width, 1);
        fill_tensor(&net.layer[1].w, n_out, width);
        fill_tensor(&net.layer[1].b, n_out, 1);
        integer_net e = {.x = (void *)bench_floats((size_t)n_in * 32),
                         .mu = (void *)bench_floats((size_t)n_out * 32),
                         .si = (void *)bench_floats((size_t)n_out * 16)};
        bench_check(adcgs_e24_create(&e.net, &net, b->level, NULL, &error), &error);
        e.scratch = bench_floats(adcgs_e24_scratch(e.net) / sizeof(float) + 16);
        for (size_t j = 0; j < (size_t)n_in * 64; j++)
            e.x[j] = (int16_t)(adcgs_random64(3, width, j) % 4001 - 2000);
        const double operations = 2.0 * 64 * (double)(n_in * width + width * n_out);
        bench_group(b, &(bench_place){.group = group, .anchors = 64, .threads = 1},
                    &(bench_item){"evaluate", evaluate, &e, operations, "operation", -1}, 1, 0);
        adcgs_e24_free(&e.net, NULL);
        void *const parts[] =
            {e.x, e.mu, e.si, e.scratch, net.layer[0].w.m, net.layer[0].b.m, net.layer[1].w.m, net.layer[1].b.m};
        for (size_t j = 0; j < ADCGS_COUNTOF(parts); j++)
            adcgs_free(NULL, parts[j]);
    }
}

/* ---- Range coding and geometry ---- */

enum { SYMBOLS = 1 << 16, LEVELS = 16, POSITIONS = 10000, DEPTH = 11 };

typedef struct coded {
    adcgs_buffer symbols, bits, positions;
    uint32_t cdf[LEVELS + 1], *voxels, *decoded;
} coded;

static void decode_symbols(void *arg)
{
    coded *c = arg;
    adcgs_range_dec d;
    adcgs_range_dec_init(&d, c->symbols.data, c->symbols.size);
    for (int i = 0; i < SYMBOLS; i++)
        adcgs_range_dec_symbol(&d, c->cdf, LEVELS);
    bench_check(adcgs_range_dec_finish(&d, NULL), NULL);
}

static void decode_bits(void *arg)
{
    coded *c = arg;
    adcgs_range_dec d;
    adcgs_adaptive context = ADCGS_ADAPTIVE_INIT;
    adcgs_range_dec_init(&d, c->bits.data, c->bits.size);
    for (int i = 0; i < SYMBOLS; i++)
        adcgs_adaptive_dec(&d, &context);
    bench_check(adcgs_range_dec_finish(&d, NULL), NULL);
}

static void decode_some_positions(void *arg)
{
    coded *c = arg;
    bench_check(decode_positions(c->positions.data, c->positions.size, POSITIONS, DEPTH, c->decoded, NULL), NULL);
}

/** Symbols of a peaked distribution, bits of which one in five is set, positions on a sphere. */
static void make_coded(coded *c)
{
    adcgs_range_enc e;
    adcgs_adaptive context = ADCGS_ADAPTIVE_INIT;
    adcgs_error error = {.status = ADCGS_OK};
    for (uint32_t i = 0, left = 1 << 16; i < LEVELS; i++) {
        c->cdf[i] = (1 << 16) - left;
        left = i + 1 < LEVELS ? left / 2 + LEVELS : 0;
    }
    c->cdf[LEVELS] = 1 << 16;
    adcgs_range_enc_init(&e, &c->symbols);
    for (uint32_t i = 0; i < SYMBOLS; i++) {
        const uint32_t at = (uint32_t)(adcgs_random64(4, 0, i) & 0xffff);
        int symbol = 0;
        while (c->cdf[symbol + 1] <= at)
            symbol++;
        adcgs_range_enc_symbol(&e, c->cdf, LEVELS, symbol);
    }
    adcgs_range_enc_finish(&e);
    adcgs_range_enc_init(&e, &c->bits);
    for (uint32_t i = 0; i < SYMBOLS; i++)
        adcgs_adaptive_enc(&e, &context, adcgs_random64(5, 0, i) % 5 == 0);
    adcgs_range_enc_finish(&e);
    for (uint32_t i = 0; i < POSITIONS; i++)
        for (uint64_t a = 0; a < 3; a++) /* the low bits of the first coordinate make them distinct */
            c->voxels[3 * i + a] = a ? (uint32_t)(adcgs_random64(6, a, i / 64) % 1024) + (uint32_t)(adcgs_random64(7, a, i) % 64)
                                     : (i / 64 * 13 + i % 64) & ((1u << DEPTH) - 1);
    bench_check(adcgs_morton_sort(c->voxels, POSITIONS, NULL, &error) == 0 ? ADCGS_OK : ADCGS_ERR_INTERNAL, &error);
    bench_check(adcgs_geom_encode(&c->positions, c->voxels, POSITIONS, DEPTH, &error), &error);
}

static void coding(const bench *b)
{
    coded c;
    adcgs_buffer_init(&c.symbols);
    adcgs_buffer_init(&c.bits);
    adcgs_buffer_init(&c.positions);
    c.voxels = (void *)bench_floats(3 * POSITIONS);
    c.decoded = (void *)bench_floats(3 * POSITIONS);
    make_coded(&c);
    const bench_item items[] = {{"symbols", decode_symbols, &c, SYMBOLS, "symbol", 0},
                                {"adaptive bits", decode_bits, &c, SYMBOLS, "bit", 0},
                                {"positions", decode_some_positions, &c, POSITIONS, "position", 0}};
    bench_group(b, &(bench_place){.group = "decode", .threads = 1}, items, ADCGS_COUNTOF(items), 0);
    adcgs_buffer_clear(&c.symbols);
    adcgs_buffer_clear(&c.bits);
    adcgs_buffer_clear(&c.positions);
    adcgs_free(NULL, c.voxels);
    adcgs_free(NULL, c.decoded);
}

/* ---- Training ---- */

enum { ROWS = 32, PARAMETERS = 1 << 16 };

typedef struct values {
    adcgs_train_dsp dsp;
    float *y, *step, *mu, *si, *weight, *dy, *dmu, *dsi, *mean, *p, *g, *m, *v;
    adcgs_rate_table *table;
} values;

static adcgs_rate_io rate_io(values *v)
{
    return (adcgs_rate_io){.n = ROWS,
                           .y = v->y,
                           .step = v->step,
                           .mu = v->mu,
                           .si = v->si,
                           .weight = v->weight,
                           .scale = 1e-6f,
                           .dy = v->dy,
                           .dmu = v->dmu,
                           .dsi = v->dsi,
                           .table = v->table,
                           .mean = v->mean};
}

static void rate(void *arg)
{
    values *v = arg;
    const adcgs_rate_io io = rate_io(v);
    v->dsp.rate(&io);
}

static void rate_exact(void *arg)
{
    values *v = arg;
    const adcgs_rate_io io = rate_io(v);
    v->dsp.rate_exact(&io);
}

static void noise(void *arg)
{
    values *v = arg;
    v->dsp.noise(v->mean, v->y, v->step, ROWS, 7);
}

static void adam(void *arg)
{
    values *v = arg;
    v->dsp.adam(v->p, v->g, v->m, v->v, PARAMETERS, 1e-6f, 1, 1);
}

static void trainers_own(const bench *b)
{
    values v = {.y = random_floats(ROWS * 64, 0.5f),
                .mu = random_floats(ROWS * 64, 0.1f),
                .si = random_floats(ROWS * 64, 1),
                .step = bench_floats(ROWS),
                .weight = bench_floats(64),
                .dy = bench_floats(ROWS * 64),
                .dmu = bench_floats(ROWS * 64),
                .dsi = bench_floats(ROWS * 64),
                .mean = bench_floats(ROWS * 64),
                .p = random_floats(PARAMETERS, 1),
                .g = random_floats(PARAMETERS, 1),
                .m = bench_floats(PARAMETERS),
                .v = bench_floats(PARAMETERS)};
    v.table = (void *)bench_floats(sizeof *v.table / sizeof(float));
    adcgs_train_dsp_init(&v.dsp, b->level);
    adcgs_rate_table_init(v.table);
    for (int i = 0; i < ROWS; i++)
        v.step[i] = 0.1f;
    for (int i = 0; i < 64; i++)
        v.weight[i] = 1;
    const bench_item items[] = {{"rate and its gradient", rate, &v, ROWS * 64, "value", 0},
                                {"exact rate", rate_exact, &v, ROWS * 64, "value", 0},
                                {"noise", noise, &v, ROWS * 64, "value", 0},
                                {"Adam", adam, &v, PARAMETERS, "weight", 0}};
    bench_group(b, &(bench_place){.group = "kernels of training", .threads = 1}, items, ADCGS_COUNTOF(items), 0);
    void *const parts[] = {v.y, v.step, v.mu, v.si, v.weight, v.dy, v.dmu, v.dsi, v.mean, v.p, v.g, v.m, v.v, v.table};
    for (size_t i = 0; i < ADCGS_COUNTOF(parts); i++)
        adcgs_free(NULL, parts[i]);
}

void bench_kernels(const bench *b)
{
    if (bench_wants(b, "dense"))
        dense_layers(b);
    if (bench_wants(b, "integer"))
        integer_nets(b);
    if (bench_wants(b, "decode"))
        coding(b);
    if (bench_wants(b, "kernels"))
        trainers_own(b);
}
