/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Networks: every NETW of a stream, with the parameters of its HEAD. Valid networks are written and read again; the integer
 * networks are evaluated with every kernel of this machine.
 */
#include "fuzz.h"
#include "stream_edit.h"

#include "base/cpu_detect.h"
#include "base/digest.h"
#include "model/model_priv.h"
#include "stream/parts.h"

#define WEIGHTS_MAX 200000U

const char *const adcgs_fuzz_seeds[] = {"conformance/vectors", "tests/fuzz/regressions/net", NULL};

/** All outputs of a network at a CPU level, for inputs over the whole range. */
static uint32_t evaluate(const adcgs_net *net, adcgs_cpu_level cpu)
{
    const size_t n_in = adcgs_net_inputs(net), channels = adcgs_net_channels(net);
    adcgs_e24 *e24;
    FUZZ_REQUIRE(adcgs_e24_create(&e24, net, cpu, NULL, NULL) == ADCGS_OK);
    int16_t *x = adcgs_alloc(NULL, n_in, ADCGS_LANES * sizeof *x, NULL), *mu = adcgs_alloc(NULL, channels, ADCGS_LANES * 2, NULL);
    uint8_t *si = adcgs_alloc(NULL, channels, ADCGS_LANES, NULL);
    void *scratch = adcgs_alloc(NULL, 1, adcgs_e24_scratch(e24), NULL);
    FUZZ_REQUIRE(x && mu && si && scratch);
    for (size_t i = 0; i < n_in * ADCGS_LANES; i++)
        x[i] = (int16_t)(i % 5 == 0 ? 32767 : i % 7 == 0 ? -32767 : (int)(i * 40503 % 65535) - 32767);
    adcgs_e24_eval(e24, x, mu, si, scratch);
    for (size_t i = 0; i < channels * ADCGS_LANES; i++)
        FUZZ_REQUIRE(mu[i] >= -32767 && si[i] < ADCGS_SIGMA_LEVELS);
    const uint32_t crc = adcgs_crc32c(adcgs_crc32c(0, mu, channels * ADCGS_LANES * 2), si, channels * ADCGS_LANES);
    adcgs_free(NULL, x);
    adcgs_free(NULL, mu);
    adcgs_free(NULL, si);
    adcgs_free(NULL, scratch);
    adcgs_e24_free(&e24, NULL);
    return crc;
}

static void write_again(const adcgs_net_table *table, const adcgs_params *params, const adcgs_level *limits)
{
    adcgs_net_table again = {0};
    adcgs_buffer out;
    adcgs_buffer_init(&out);
    for (uint32_t first = 0; first < table->n; first += ADCGS_ROLES) {
        const adcgs_net *nets[ADCGS_ROLES];
        const uint32_t n = ADCGS_MIN(table->n - first, (uint32_t)ADCGS_ROLES);
        for (uint32_t i = 0; i < n; i++)
            nets[i] = &table->nets[first + i];
        out.size = 0;
        FUZZ_REQUIRE(adcgs_netw_write(&out, nets, n, first, NULL) == ADCGS_OK);
        adcgs_cost left = {UINT64_MAX, UINT64_MAX};
        adcgs_parse p = {.chunk = "NETW"};
        adcgs_reader_init(&p.r, out.data, out.size);
        FUZZ_REQUIRE(adcgs_netw_parse(&p, params, limits, &left, &again) == ADCGS_OK);
    }
    FUZZ_REQUIRE(again.n == table->n);
    for (uint32_t i = 0; i < again.n; i++)
        FUZZ_REQUIRE(adcgs_net_equal(&again.nets[i], &table->nets[i]));
    adcgs_net_table_clear(&again);
    adcgs_buffer_clear(&out);
}

static void check_table(const adcgs_net_table *table, const adcgs_params *params, const adcgs_level *limits)
{
    write_again(table, params, limits);
    for (uint32_t i = 0; i < table->n; i++) {
        if (table->nets[i].role >= ADCGS_ROLE_PREDICTION)
            continue;
        const uint32_t crc = evaluate(&table->nets[i], ADCGS_CPU_SCALAR);
        for (int cpu = ADCGS_CPU_SCALAR + 1; cpu <= (int)adcgs_cpu_best(); cpu++)
            FUZZ_REQUIRE(evaluate(&table->nets[i], (adcgs_cpu_level)cpu) == crc);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    adcgs_level limits = *adcgs_level_get(1);
    adcgs_stream stream;
    adcgs_syn_head head;
    adcgs_net_table table = {0};
    adcgs_found_chunk c;
    adcgs_cost left = {UINT64_MAX, UINT64_MAX};
    int has_head = 0;
    limits.weights = WEIGHTS_MAX;
    adcgs_stream_init(&stream);
    for (size_t pos = ADCGS_SIGNATURE_BYTES; adcgs_next_chunk(data, size, &pos, &c);) {
        adcgs_parse p = {.chunk = "chunk"};
        adcgs_reader_init(&p.r, data + c.payload, c.length);
        if (c.type == ADCGS_TYPE_HEAD && !has_head)
            has_head = adcgs_head_parse(&p, &head, &stream) == ADCGS_OK;
        else if (c.type == ADCGS_TYPE_NETW && has_head)
            (void)adcgs_netw_parse(&p, &stream.params, &limits, &left, &table);
    }
    if (table.n > 0)
        check_table(&table, &stream.params, &limits);
    adcgs_net_table_clear(&table);
    return 0;
}
