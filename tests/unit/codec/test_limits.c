/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The cost that a stream can cause in a decoder: streams of a few hundred bytes that use all of a level's limits are decoded
 * within their memory and time, and one unit more of anything is refused before any allocation for it.
 */
#include "free_net.h"
#include "zero_streams.h"
#include "stream_edit.h"

#include "base/cpu_detect.h"
#include "stream/input.h"
#include "stream/parts.h"

#include <adcgs/adcgs.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <time.h>

#include <cmocka.h>

/* Memory in addition to models, payloads and weights: contexts of the coders, headers of blocks, the table of networks. */
#define SLACK ((uint64_t)1 << 20)
#define SECONDS_MOST 2.0

typedef struct cost {
    adcgs_status status;
    uint64_t peak;
    double seconds;
    char text[256];
} cost;

static cost decode(const uint8_t *data, size_t size)
{
    adcgs_memory memory = {.limit = 0};
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    const adcgs_read_options options = {.cpu = adcgs_cpu_best(), .memory = &memory};
    adcgs_span s = {.next = data, .left = size};
    cost c = {.seconds = (double)clock()};
    c.status = adcgs_stream_read(&stream, adcgs_span_read, &s, &options, NULL, NULL, &error);
    c.seconds = ((double)clock() - c.seconds) / CLOCKS_PER_SEC;
    c.peak = memory.peak;
    snprintf(c.text, sizeof c.text, "%s", error.text);
    if (c.status == ADCGS_OK)
        adcgs_stream_clear(&stream, &memory);
    assert_int_equal(memory.used, 0);
    return c;
}

/** The bound of the specification's annex, for streams with one layer of networks in memory at a time. */
static uint64_t bound_of(const nothing *what, uint64_t weights, uint64_t longest_payload)
{
    const adcgs_nets_cost nets = {weights, 0};
    const adcgs_cost each = adcgs_segment_cost(&what->params, what->anchors, what->depth, &nets);
    const uint64_t models = what->segments + (what->predicted ? 2U : 0U); /* kept and new parts, before they join */
    return models * each.bytes + 128 * (uint64_t)what->anchors + 16 * weights + 3 * longest_payload +
           5 * (uint64_t)what->cameras * 50 + SLACK;
}

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define SANITIZED
#endif
#endif

/** True if the build or the machine is too slow for meaningful times. */
static int is_slow(void)
{
#if !defined(__OPTIMIZE__) || defined(SANITIZED) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return 1;
#else
    return adcgs_cpu_best() == ADCGS_CPU_SCALAR;
#endif
}

/** A stream at the limit is decoded within memory and time. One beyond the limit is refused almost without allocations. */
static void check_edge(const char *name, const nothing *inside, const nothing *outside, uint64_t weights, const char *refusal)
{
    adcgs_buffer bytes;
    make_bytes(&bytes, inside);
    const cost in = decode(bytes.data, bytes.size);
    const uint64_t bound = bound_of(inside, weights, bytes.size);
    print_message("%s: %zu bytes, %llu of %llu KiB, %.3f s\n", name, bytes.size, (unsigned long long)in.peak >> 10,
                  (unsigned long long)bound >> 10, in.seconds);
    adcgs_buffer_clear(&bytes);
    if (in.status != ADCGS_OK)
        fail_msg("%s: %s", name, in.text);
    assert_true(in.peak <= bound);
    assert_true(is_slow() || in.seconds < SECONDS_MOST);
    make_bytes(&bytes, outside);
    const cost out = decode(bytes.data, bytes.size);
    adcgs_buffer_clear(&bytes);
    assert_int_equal(out.status, ADCGS_ERR_LIMIT);
    if (!strstr(out.text, refusal))
        fail_msg("%s: refused with: %s", name, out.text);
    assert_true(out.peak <= in.peak + SLACK);
}

/* REQ-STRM-034 */
static void test_anchors(void **state)
{
    nothing in = least, out;
    (void)state;
    in.anchors = 4096;
    in.depth = 12;
    out = in;
    out.anchors++;
    check_edge("anchors", &in, &out, 0, "max_anchors");
    out = in;
    out.depth++;
    check_edge("depth", &in, &out, 0, "depth");
}

/* REQ-STRM-034 */
static void test_segments(void **state)
{
    nothing in = least, out;
    (void)state;
    in.segments = 16;
    in.anchors = 4096;
    in.depth = 4;
    out = in;
    out.segments++;
    check_edge("segments", &in, &out, 0, "segments");
}

/* REQ-STRM-018, REQ-STRM-034 */
static void test_weights(void **state)
{
    nothing in = least, out;
    (void)state;
    in.role = ADCGS_ROLE_ENTROPY_SIGMA;
    in.layers = 2;
    in.width = 512;
    out = in;
    out.layers = 3;
    check_edge("weights", &in, &out, 300000, "weights");
}

/* REQ-STRM-034, REQ-STRM-035 */
static void test_model_bytes(void **state)
{
    nothing in = least, out;
    (void)state;
    in.params = (adcgs_params){.k = 16, .n_fv = 64, .n_fg = 32, .chunks = 1};
    in.anchors = 4096;
    in.depth = 4;
    in.segments = 6;
    out = in;
    out.segments = 7;
    check_edge("model bytes", &in, &out, 20000, "level's limit");
}

/** Segments that cost a few bytes each count like others. */
/* REQ-STRM-034, REQ-STRM-035, REQ-STRM-048 */
static void test_predicted(void **state)
{
    nothing in = least, out;
    (void)state;
    in.params = (adcgs_params){.k = 16, .n_fv = 64, .n_fg = 32, .chunks = 1};
    in.anchors = 4096;
    in.depth = 4;
    in.segments = 6;
    in.predicted = 1;
    out = in;
    out.segments = 7;
    check_edge("predicted", &in, &out, 20000, "level's limit");
}

/** As near to the bound of work as networks of this width come. */
/* REQ-STRM-040, REQ-CONF-005 */
static void test_work(void **state)
{
    nothing in = least, out;
    (void)state;
    in.params = (adcgs_params){.k = 16, .n_fv = 64, .n_fg = 32, .chunks = 1};
    in.role = ADCGS_ROLE_ENTROPY_FG;
    in.layers = 2;
    in.width = 512;
    in.anchors = 2950;
    in.depth = 4;
    out = in;
    out.anchors = 3050;
    check_edge("work", &in, &out, 350000, "work");
}

static void test_cameras(void **state)
{
    nothing in = least, out;
    (void)state;
    in.cameras = 25000;
    out = in;
    out.cameras = 42000;
    check_edge("cameras", &in, &out, 0, "payload");
}

/** Inserts copies of the only NETW before the last chunk. They repeat known data, but their weights are decoded each time. */
static void repeat_networks(adcgs_buffer *out, const adcgs_buffer *in, int times)
{
    adcgs_found_chunk c, netw = {0}, end = {0};
    for (size_t pos = ADCGS_SIGNATURE_BYTES; adcgs_next_chunk(in->data, in->size, &pos, &c); end = c)
        netw = c.type == ADCGS_TYPE_NETW ? c : netw;
    adcgs_write_bytes(out, in->data, end.at);
    for (int i = 0; i < times; i++)
        adcgs_write_bytes(out, in->data + netw.at, netw.length + ADCGS_CHUNK_BYTES);
    adcgs_write_bytes(out, in->data + end.at, in->size - end.at);
    adcgs_repair_stream(out->data, out->size, 0);
}

/* REQ-STRM-040 */
static void test_repeated_networks(void **state)
{
    nothing what = least;
    adcgs_buffer once, often;
    (void)state;
    what.role = ADCGS_ROLE_ENTROPY_SIGMA;
    what.layers = 2;
    what.width = 512;
    make_bytes(&once, &what);
    adcgs_buffer_init(&often);
    repeat_networks(&often, &once, 50);
    const cost in = decode(often.data, often.size);
    print_message("networks 51 times: %zu bytes, %.3f s\n", often.size, in.seconds);
    assert_int_equal(in.status, ADCGS_OK);
    assert_true(in.peak <= bound_of(&what, 300000, often.size));
    assert_true(is_slow() || in.seconds < SECONDS_MOST);
    often.size = 0;
    repeat_networks(&often, &once, 70);
    const cost out = decode(often.data, often.size);
    assert_int_equal(out.status, ADCGS_ERR_LIMIT);
    assert_non_null(strstr(out.text, "work"));
    adcgs_buffer_clear(&once);
    adcgs_buffer_clear(&often);
}

/** A NETW with the networks from first_id on, each an E_fv without inputs: two biases. */
static void write_tiny_networks(adcgs_buffer *out, const adcgs_net *net, uint32_t first_id, uint32_t n)
{
    const adcgs_net *nets[ADCGS_ROLES];
    for (uint32_t i = 0; i < n; i++)
        nets[i] = net;
    const size_t begin = adcgs_chunk_begin(out, ADCGS_TYPE_NETW, 0, 0);
    assert_int_equal(adcgs_netw_write(out, nets, n, first_id, NULL), ADCGS_OK);
    adcgs_chunk_end(out, begin);
}

static cost decode_tiny_networks(uint32_t networks)
{
    adcgs_buffer bytes, more;
    adcgs_net net;
    adcgs_found_chunk c, end = {0};
    make_bytes(&bytes, &least);
    adcgs_buffer_init(&more);
    zero_net(&net, &least.params, ADCGS_ROLE_ENTROPY_FV, 1, 0);
    for (size_t pos = ADCGS_SIGNATURE_BYTES; adcgs_next_chunk(bytes.data, bytes.size, &pos, &c);)
        end = c;
    adcgs_write_bytes(&more, bytes.data, end.at);
    for (uint32_t id = 4; id < networks; id += ADCGS_ROLES)
        write_tiny_networks(&more, &net, id, ADCGS_MIN(networks - id, (uint32_t)ADCGS_ROLES));
    adcgs_write_bytes(&more, bytes.data + end.at, bytes.size - end.at);
    adcgs_repair_stream(more.data, more.size, 0);
    const cost spent = decode(more.data, more.size);
    free_net(&net);
    adcgs_buffer_clear(&more);
    adcgs_buffer_clear(&bytes);
    return spent;
}

/* REQ-STRM-040 */
static void test_networks(void **state)
{
    (void)state;
    const cost in = decode_tiny_networks(256), out = decode_tiny_networks(257);
    assert_int_equal(in.status, ADCGS_OK);
    assert_true(in.peak <= bound_of(&least, 512, 4096));
    assert_int_equal(out.status, ADCGS_ERR_LIMIT);
    assert_non_null(strstr(out.text, "networks"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_anchors),   cmocka_unit_test(test_segments),
        cmocka_unit_test(test_weights),   cmocka_unit_test(test_model_bytes),
        cmocka_unit_test(test_work),      cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_networks),  cmocka_unit_test(test_repeated_networks),
        cmocka_unit_test(test_predicted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
