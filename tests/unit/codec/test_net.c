/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Value tables and values; E24 networks against a 64-bit reference on every kernel. */
#include "free_net.h"
#include "net_numbers.h"
#include "second_sources.h"

#include "base/cpu_detect.h"
#include "net/net.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

/* ---- tables and values ---- */

static void check_csv_row(const char *line)
{
    char *end;
    const int level = (int)strtol(line, &end, 10);
    const int support = (int)strtol(end + 1, &end, 10);
    const uint32_t total = (uint32_t)strtoul(end + 1, &end, 10), *cdf = adcgs_table_cdf(level);
    assert_int_equal(adcgs_table_support(level), support);
    for (int i = 0; i <= support; i++) {
        const uint32_t c = (uint32_t)strtoul(end + 1, &end, 10);
        assert_int_equal(cdf[i], c);
        assert_int_equal(cdf[2 * support + 1 - i], total - c);
    }
    assert_int_equal(cdf[2 * support + 2], 65536);
    for (int i = 0; i < 2 * support + 2; i++)
        assert_true(cdf[i] < cdf[i + 1]);
}

/* REQ-TABL-001 */
static void test_tables_equal_csv(void **state)
{
    (void)state;
    const char *top = getenv("srcdir");
    char path[4096], line[4096];
    snprintf(path, sizeof path, "%s/spec/tables/values.csv", top ? top : ".");
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    int rows = -1;
    while (fgets(line, sizeof line, file)) {
        if (rows >= 0)
            check_csv_row(line);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, ADCGS_SIGMA_LEVELS);
}

static void code_extremes(adcgs_range_enc *e, adcgs_range_dec *d)
{
    for (int si = 1; si < ADCGS_SIGMA_LEVELS; si++) {
        const int support = adcgs_table_support(si), largest = adcgs_value_max(si);
        const int values[] = {0,    1,     -1,    support, -support,    support + 1, -support - 1, support + 2,
                              1000, -1023, 32767, -32768,  largest - 1, largest,     -largest};
        for (size_t i = 0; i < ADCGS_COUNTOF(values); i++)
            if (e)
                adcgs_value_enc(e, si, values[i]);
            else
                assert_int_equal(adcgs_value_dec(d, si), values[i]);
    }
}

/* REQ-PARS-006, REQ-PARS-011 */
static void test_values_round_trip(void **state)
{
    (void)state;
    adcgs_buffer b;
    adcgs_buffer_init(&b);
    adcgs_range_enc e;
    adcgs_range_enc_init(&e, &b);
    code_extremes(&e, NULL);
    adcgs_range_enc_finish(&e);
    adcgs_range_dec d;
    adcgs_range_dec_init(&d, b.data, b.size);
    code_extremes(NULL, &d);
    assert_int_equal(adcgs_range_dec_finish(&d, NULL), ADCGS_OK);
    adcgs_buffer_clear(&b);
}

/* The cost used for decisions equals the length that the coder then produces. */
static void test_value_cost(void **state)
{
    (void)state;
    uint64_t seed = 1, cost = 0;
    adcgs_buffer b;
    adcgs_buffer_init(&b);
    adcgs_range_enc e;
    adcgs_range_enc_init(&e, &b);
    for (int i = 0; i < 100000; i++) {
        const int si = 1 + (int)(random32(&seed) % 63);
        const int32_t value = draw(&seed, i % 10 ? adcgs_table_support(si) : i % 100 ? 600 : adcgs_value_max(si));
        adcgs_value_enc(&e, si, value);
        cost += adcgs_value_cost(si, value);
    }
    adcgs_range_enc_finish(&e);
    const double bits = 8.0 * (double)b.size, predicted = (double)cost / 65536;
    assert_true(fabs(bits - predicted) < 70 + predicted * 2e-4);
    adcgs_buffer_clear(&b);
}

/* REQ-PARS-009, REQ-PARS-011 */
static void test_damaged_values_end(void **state)
{
    (void)state;
    uint64_t seed = 3;
    uint8_t bytes[200];
    for (int trial = 0; trial < 500; trial++) {
        for (size_t i = 0; i < sizeof bytes; i++)
            bytes[i] = (uint8_t)(trial % 7 ? random32(&seed) >> 9 : 255 - (i == 0));
        adcgs_range_dec d;
        adcgs_range_dec_init(&d, bytes, sizeof bytes);
        for (int i = 0; i < 1000; i++) {
            const int si = 1 + (int)(random32(&seed) % 63), largest = adcgs_value_max(si);
            const int32_t value = adcgs_value_dec(&d, si);
            assert_true(value >= -largest && value <= largest);
        }
        assert_int_equal(adcgs_range_dec_finish(&d, NULL), ADCGS_ERR_DATA);
    }
}

/* ---- E24 ---- */

/* A network whose rows are as large as the bound allows. */
static void make_net(adcgs_net *net, int n_layers, const uint32_t *sizes, uint64_t *seed)
{
    *net = (adcgs_net){.present = 1, .n_layers = (uint8_t)n_layers};
    net->in_shift = (uint8_t)(random32(seed) % 9);
    net->sigma_shift = (uint8_t)(random32(seed) % 25);
    net->sigma_offset = (int16_t)draw(seed, 64);
    for (int l = 0; l < n_layers; l++) {
        adcgs_layer *layer = &net->layer[l];
        make_tensor(&layer->w, sizes[l + 1], sizes[l]);
        make_tensor(&layer->b, sizes[l + 1], 1);
        const int32_t limit = sizes[l] ? ADCGS_MIN(2047, (int32_t)(2 * 4000 / sizes[l])) : 0;
        for (uint32_t i = 0; i < sizes[l] * sizes[l + 1]; i++)
            layer->w.m[i] = random32(seed) % 4 ? draw(seed, limit) : 0;
        layer->shift = (uint8_t)(random32(seed) % 13);
        for (uint32_t j = 0; j < sizes[l + 1]; j++) {
            int32_t *row = layer->w.m + j * sizes[l];
            int32_t sum = 0;
            for (uint32_t i = 0; i < sizes[l]; i++) {
                if (sum + abs(row[i]) > 4000)
                    row[i] = 0;
                sum += abs(row[i]);
            }
            layer->b.m[j] = draw(seed, 100000);
        }
        layer->residual = l + 1 < n_layers && sizes[l] == sizes[l + 1];
    }
}

static int64_t shr64(int64_t v, int s)
{
    return s ? (int64_t)floor(((double)v + exp2(s - 1)) / exp2(s)) : v;
}

static int64_t clip64(int64_t v, int64_t limit)
{
    return v > limit ? limit : v < -limit ? -limit : v;
}

static void reference(const adcgs_net *net, const int16_t *x, int sample, int16_t *mu, uint8_t *si)
{
    int64_t h[1024], acc[1024];
    for (uint32_t i = 0; i < adcgs_net_inputs(net); i++)
        h[i] = clip64(shr64(x[i * ADCGS_LANES + (uint32_t)sample], net->in_shift), 2047);
    for (int l = 0; l < net->n_layers; l++) {
        const adcgs_layer *layer = &net->layer[l];
        const uint32_t n_in = layer->w.cols, n_out = layer->w.rows;
        for (uint32_t j = 0; j < n_out; j++) {
            acc[j] = layer->b.m[j];
            for (uint32_t i = 0; i < n_in; i++)
                acc[j] += layer->w.m[j * n_in + i] * h[i];
        }
        for (uint32_t j = 0; j < n_out && l + 1 < net->n_layers; j++) {
            int64_t v = shr64(acc[j], layer->shift);
            v = v < 0 ? shr64(v, 6) : v;
            h[j] = clip64(layer->residual ? h[j] + v : v, 2047);
        }
    }
    const int prior = net->role != ADCGS_ROLE_ENTROPY_STEPS;
    const uint32_t channels = adcgs_net_outputs(net) / (prior ? 2 : 1);
    for (uint32_t c = 0; c < channels; c++) {
        mu[c] = (int16_t)clip64(shr64(acc[c], net->layer[net->n_layers - 1].shift), 32767);
        if (!prior)
            continue;
        const int64_t v = shr64(acc[channels + c], net->sigma_shift) + net->sigma_offset;
        si[c] = (uint8_t)(v < 0 ? 0 : v > 63 ? 63 : v);
    }
}

static void check_net(const adcgs_net *net, uint64_t *seed)
{
    static int16_t x[1024 * ADCGS_LANES], mu[512 * ADCGS_LANES], first_mu[512 * ADCGS_LANES];
    static uint8_t si[256 * ADCGS_LANES], first_si[256 * ADCGS_LANES];
    const int prior = net->role != ADCGS_ROLE_ENTROPY_STEPS;
    const uint32_t n_in = adcgs_net_inputs(net), channels = adcgs_net_channels(net);
    for (uint32_t i = 0; i < n_in * ADCGS_LANES; i++)
        x[i] = (int16_t)draw(seed, i % 3 ? 500 : 32767);
    if (n_in)
        x[0] = INT16_MIN;
    for (int level = ADCGS_CPU_SCALAR; level <= (int)adcgs_cpu_best(); level++) {
        adcgs_error error = {0};
        adcgs_e24 *e24;
        if (adcgs_e24_create(&e24, net, (adcgs_cpu_level)level, NULL, &error) != ADCGS_OK)
            fail_msg("%s", error.text);
        void *scratch = adcgs_alloc(NULL, 1, adcgs_e24_scratch(e24), NULL);
        adcgs_e24_eval(e24, x, mu, prior ? si : NULL, scratch);
        adcgs_free(NULL, scratch);
        adcgs_e24_free(&e24, NULL);
        if (level == ADCGS_CPU_SCALAR) {
            memcpy(first_mu, mu, sizeof mu);
            memcpy(first_si, si, sizeof si);
        }
        assert_memory_equal(mu, first_mu, channels * ADCGS_LANES * sizeof *mu);
        assert_memory_equal(si, first_si, prior ? channels * ADCGS_LANES : 0);
    }
    for (int s = 0; s < ADCGS_LANES; s++) {
        int16_t m[512];
        uint8_t v[256];
        reference(net, x, s, m, v);
        for (uint32_t c = 0; c < channels; c++) {
            assert_int_equal(m[c], mu[c * ADCGS_LANES + (uint32_t)s]);
            assert_true(!prior || v[c] == si[c * ADCGS_LANES + (uint32_t)s]);
        }
    }
}

/* Turns a network of priors into one without: step indices, one per output. */
static void make_steps(adcgs_net *net)
{
    net->role = ADCGS_ROLE_ENTROPY_STEPS;
    net->sigma_shift = 0;
    net->sigma_offset = 0;
}

/* REQ-NETW-004, REQ-NETW-005, REQ-NETW-006, REQ-NETW-007, REQ-NETW-008, REQ-NETW-010 */
static void test_e24_equals_reference(void **state)
{
    (void)state;
    static const uint32_t sizes[][5] = {{1, 2},          {0, 14},          {7, 5, 6},
                                        {32, 48, 64},    {33, 33, 33, 10}, {64, 24, 24, 24, 32},
                                        {1024, 13, 512}, {512, 512, 2},    {80, 1, 1, 22},
                                        {32, 24, 5}};
    static const int layers[] = {1, 1, 2, 2, 3, 4, 2, 2, 3, 2};
    uint64_t seed = 11;
    for (size_t i = 0; i < ADCGS_COUNTOF(layers); i++)
        for (int trial = 0; trial < 4; trial++) {
            adcgs_net net;
            make_net(&net, layers[i], sizes[i], &seed);
            if (trial % 2 || sizes[i][layers[i]] % 2)
                make_steps(&net);
            check_net(&net, &seed);
            free_net(&net);
        }
}

static adcgs_status load_net(const adcgs_net *net)
{
    adcgs_e24 *e24;
    const adcgs_status status = adcgs_e24_create(&e24, net, ADCGS_CPU_SCALAR, NULL, NULL);
    adcgs_e24_free(&e24, NULL);
    return status;
}

/* REQ-NETW-003 */
static void test_e24_row_bound(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {5, 4, 2};
    uint64_t seed = 12;
    adcgs_net net;
    make_net(&net, 2, sizes, &seed);
    /* hidden row 3: 2047 * 8000 + 2^9 + |b| = 2^24 - 1 exactly */
    static const int32_t row[] = {2047, -2047, 2047, -1859, 0};
    memcpy(net.layer[0].w.m + 15, row, sizeof row);
    net.layer[0].shift = 10;
    net.layer[0].b.m[3] = -((1 << 24) - 1 - 2047 * 8000 - 512);
    assert_int_equal(load_net(&net), ADCGS_OK);
    check_net(&net, &seed);
    net.layer[0].b.m[3]--;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    net.layer[0].b.m[3]++;
    net.layer[0].shift = 11;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    net.layer[0].shift = 10;
    net.layer[0].w.m[15 + 4] = -1;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    net.layer[0].w.m[15 + 4] = 0;
    net.layer[0].w.m[0] = 2048;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    net.layer[0].w.m[0] = INT32_MIN;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    net.layer[0].w.m[0] = 0;
    net.layer[1].b.m[0] = INT32_MIN;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    net.layer[1].b.m[0] = 0;
    net.layer[0].residual = 1;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    net.layer[0].residual = 0;
    net.layer[1].w.cols = 3;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    net.layer[1].w.cols = 4;
    net.layer[0].w.mode = 1;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    net.layer[0].w.mode = 0;
    net.in_shift = 9;
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
    free_net(&net);
}

/* All rows of the last layer of step indices use the layer's shift. */
/* REQ-NETW-003, REQ-NETW-010 */
static void test_e24_steps_bound(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {5, 3};
    uint64_t seed = 13;
    adcgs_net net;
    make_net(&net, 1, sizes, &seed);
    assert_int_equal(load_net(&net), ADCGS_ERR_DATA); /* an odd number of outputs is no prior */
    make_steps(&net);
    memset(net.layer[0].w.m, 0, 15 * sizeof(int32_t));
    net.layer[0].shift = 24;
    for (int row = 0; row < 3; row++) {
        net.layer[0].b.m[row] = row % 2 ? -((1 << 23) - 1) : (1 << 23) - 1;
        assert_int_equal(load_net(&net), ADCGS_OK);
        net.layer[0].b.m[row] += row % 2 ? -1 : 1;
        assert_int_equal(load_net(&net), ADCGS_ERR_DATA);
        net.layer[0].b.m[row] = 0;
    }
    check_net(&net, &seed);
    free_net(&net);
}

static void test_e24_known_answer(void **state)
{
    (void)state;
    adcgs_error error = {0};
    if (adcgs_e24_check(&error) != ADCGS_OK)
        fail_msg("%s", error.text);
}

/* REQ-NETW-002 */
static void test_shr(void **state)
{
    (void)state;
    for (int s = 0; s <= 24; s++)
        for (int32_t v = -70000; v <= 70000; v += 7) {
            assert_int_equal(adcgs_shr(v, s), shr64(v, s));
            assert_int_equal(adcgs_shr(v * 200, s), shr64(v * 200, s));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tables_equal_csv),
        cmocka_unit_test(test_values_round_trip),
        cmocka_unit_test(test_value_cost),
        cmocka_unit_test(test_damaged_values_end),
        cmocka_unit_test(test_shr),
        cmocka_unit_test(test_e24_equals_reference),
        cmocka_unit_test(test_e24_row_bound),
        cmocka_unit_test(test_e24_steps_bound),
        cmocka_unit_test(test_e24_known_answer),
    };
    int failed = cmocka_run_group_tests_name("net", tests, NULL, NULL);
    failed += adcgs_test_net_weights();
    return failed;
}
