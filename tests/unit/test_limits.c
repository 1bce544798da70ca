/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The cost that a stream can cause in a decoder. Streams of a few hundred bytes that use all of a level's limits are decoded
 * within their memory and time. One unit more of anything is refused before any allocation for it. Every allocation of the
 * decoder fails once.
 */
#include "random_model.h"
#include "stream_edit.h"

#include "base/cpu_detect.h"
#include "model/model_priv.h"
#include "stream/input.h"
#include "stream/parts.h"

#include <adcgs/adcgs.h>

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <cmocka.h>

/* Memory in addition to models, payloads and weights: contexts of the coders, headers of blocks, the table of networks. */
#define SLACK ((uint64_t)1 << 20)
#define SECONDS_MOST 2.0

/* ---- Streams whose contents cost no bytes ---- */

/** The parameters of a zero stream: every weight and value is 0, and anchors fill a cube. */
typedef struct nothing {
    adcgs_params params;
    uint32_t segments, anchors;
    int depth;
    int role, layers, width; /**< hidden layers of one network, of this width; the others have none */
    uint32_t cameras;
    int predicted; /**< segments after the first predict all anchors from the one before */
} nothing;

static const nothing least = {.params = {.k = 1, .n_fv = 1, .chunks = 1}, .segments = 1, .anchors = 1};

static void zero_net(adcgs_net *net, const adcgs_params *params, int role, int layers, uint32_t width)
{
    uint32_t n_in, n_out;
    adcgs_role_shape(params, role, &n_in, &n_out);
    *net = (adcgs_net){.present = 1, .role = (uint8_t)role, .n_layers = (uint8_t)(n_in == 0 ? 1 : layers)};
    for (int i = 0; i < net->n_layers; i++) {
        adcgs_layer *l = &net->layer[i];
        const uint32_t rows = i == net->n_layers - 1 ? n_out : width;
        l->w = (adcgs_tensor){.rows = rows, .cols = n_in, .m = adcgs_alloc(NULL, (size_t)rows * n_in, 4, NULL)};
        l->b = (adcgs_tensor){.rows = rows, .cols = 1, .m = adcgs_alloc(NULL, rows, 4, NULL)};
        assert_true(l->w.m && l->b.m);
        n_in = rows;
    }
}

/** Puts anchor i into the voxel with Morton code i. */
static void fill_cube(adcgs_model *m)
{
    for (uint32_t i = 0; i < m->n; i++)
        for (int bit = 0; bit < 10; bit++)
            for (int axis = 0; axis < 3; axis++)
                m->pos[3 * i + (uint32_t)axis] |= (i >> (3 * bit + 2 - axis) & 1) << bit;
}

static void make_model(adcgs_model *m, const nothing *what)
{
    m->params = what->params;
    m->n = what->anchors;
    m->depth = (uint8_t)what->depth;
    m->voxel = 1;
    m->layers = (uint8_t)adcgs_params_layers(&m->params);
    assert_int_equal(adcgs_model_alloc(m, NULL, NULL), ADCGS_OK);
    fill_cube(m);
    for (uint32_t i = 0; i < m->n; i++)
        m->mask[i] = (uint16_t)((1U << m->params.k) - 1);
    for (int i = 0; i < ADCGS_NV_MAX; i++)
        m->d_fv[i] = 1;
    for (int i = 0; i < ADCGS_NG_MAX; i++)
        m->d_fg[i] = 1;
    for (int i = 0; i < ADCGS_SIGMA_MAX; i++)
        m->d_sigma[i] = 1;
    for (int i = 0; i < ADCGS_COLOUR_N; i++)
        m->d_colour[i] = 1;
    for (int role = 0; role < ADCGS_ROLES; role++)
        if (adcgs_role_required(&m->params, role))
            zero_net(&m->net[role], &m->params, role, role == what->role ? 1 + what->layers : 1, (uint32_t)what->width);
}

static void make_stream(adcgs_stream *stream, const nothing *what)
{
    adcgs_stream_init(stream);
    stream->params = what->params;
    stream->slice_log2 = ADCGS_SLICE_LOG2_MAX;
    stream->segments = adcgs_alloc(NULL, what->segments, sizeof *stream->segments, NULL);
    stream->cameras = adcgs_alloc(NULL, what->cameras, sizeof *stream->cameras, NULL);
    assert_true(stream->segments && stream->cameras);
    for (; stream->n_segments < what->segments; stream->n_segments++) {
        adcgs_model *m = &stream->segments[stream->n_segments];
        make_model(m, what);
        m->predicted = (uint8_t)(what->predicted && stream->n_segments > 0);
        m->time_start = m->time_end = adcgs_ticks_to_seconds(stream, stream->n_segments);
    }
    for (; stream->n_cameras < what->cameras; stream->n_cameras++)
        stream->cameras[stream->n_cameras] =
            (adcgs_camera){.width = 1, .height = 1, .fx = 1, .fy = 1, .near_plane = 1, .cam_to_world = {1}};
}

static void set_level(uint8_t *stream, size_t size, int level)
{
    stream[ADCGS_SIGNATURE_BYTES + ADCGS_CHUNK_HEADER_BYTES + 5] = (uint8_t)level;
    adcgs_repair_stream(stream, size, 0);
}

/** Writes the zero stream for the level that it needs, then changes its level to 1. */
static void make_bytes(adcgs_buffer *bytes, const nothing *what)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_stream stream;
    adcgs_buffer_init(bytes);
    make_stream(&stream, what);
    if (adcgs_stream_write(&stream, bytes, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    set_level(bytes->data, bytes->size, 1);
    adcgs_stream_clear(&stream, NULL);
}

/* ---- The cost of zero streams ---- */

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
    adcgs_net_clear(&net);
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

/* ---- Failing allocations ---- */

void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void __real_free(void *block);
int __real_pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*function)(void *), void *arg);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void __wrap_free(void *block);
int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*function)(void *), void *arg);

/* Number of allocations that still succeed (below 0: nothing fails); blocks in use. */
static atomic_long left = -1;
static atomic_long blocks = 0;
/* True while a task of a pool runs; number of allocator calls by tasks. The allocator need not be thread-safe. */
static atomic_int in_task = 0, task_calls = 0;
/* Threads that were not started. */
static atomic_int denied = 0;

static int fails(void)
{
    return atomic_load(&left) >= 0 && atomic_fetch_sub(&left, 1) == 0;
}

void *__wrap_calloc(size_t count, size_t size)
{
    void *block = fails() ? NULL : __real_calloc(count, size);
    atomic_fetch_add(&blocks, block != NULL);
    atomic_fetch_add(&task_calls, in_task);
    return block;
}

void *__wrap_realloc(void *old, size_t size)
{
    void *block = fails() ? NULL : __real_realloc(old, size);
    atomic_fetch_add(&blocks, block != NULL && old == NULL);
    atomic_fetch_add(&task_calls, in_task);
    return block;
}

void __wrap_free(void *block)
{
    atomic_fetch_sub(&blocks, block != NULL);
    atomic_fetch_add(&task_calls, in_task);
    __real_free(block);
}

int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*function)(void *), void *arg)
{
    const int fails_now = fails();
    atomic_fetch_add(&denied, fails_now);
    return fails_now ? 11 : __real_pthread_create(id, attributes, function, arg);
}

static const adcgs_camera camera = {.width = 33,
                                    .height = 20,
                                    .fx = 30,
                                    .fy = 30,
                                    .cx = 16,
                                    .cy = 10,
                                    .near_plane = 0.01,
                                    .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -4}};

/**
 * Opens, renders at two times and closes while allocation n fails, or the start of a thread, which is no failure. Returns true if
 * an allocation has failed.
 */
static int fail_allocation(const adcgs_buffer *bytes, int threads, long n)
{
    float rgb[33 * 20 * 3];
    uint8_t pixels[33 * 20 * 4];
    adcgs_frame frame = {33, 20, rgb};
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_config config;
    adcgs_decoder *d = NULL;
    adcgs_config_init(&config, sizeof config);
    config.threads = threads;
    const long before = atomic_load(&blocks);
    const int denied_before = atomic_load(&denied);
    atomic_store(&left, n);
    adcgs_status status = adcgs_open_memory(&d, bytes->data, bytes->size, &config, &error);
    if (status == ADCGS_OK)
        status = adcgs_render(d, &camera, 0, &frame, &error);
    if (status == ADCGS_OK)
        status = adcgs_render_rgba8(d, &camera, 0, ADCGS_ALPHA_PREMULTIPLIED, pixels, 4 * 33, &error);
    const int failed = atomic_load(&left) < 0;
    atomic_store(&left, -1);
    const int is_short = failed && atomic_load(&denied) == denied_before;
    if (status != (is_short ? ADCGS_ERR_MEMORY : ADCGS_OK))
        fail_msg("allocation %ld fails: status %d, %s", n, (int)status, error.text);
    assert_int_equal(error.status, status);
    assert_true(!is_short || error.text[0] != 0);
    if (d && failed) /* it continues as if nothing had happened */
        assert_int_equal(adcgs_render(d, &camera, 0, &frame, &error), ADCGS_OK);
    adcgs_close(&d);
    assert_int_equal(atomic_load(&blocks), before);
    return failed;
}

/** Two segments, the second predicted, of several slices. */
static void write_two_segments(adcgs_buffer *bytes)
{
    adcgs_stream stream;
    adcgs_params params;
    uint64_t seed = 2;
    adcgs_random_params(&params, 1, &seed);
    params.k = 2;
    params.n_fg = params.chunks = 2;
    assert_int_equal(adcgs_random_stream(&stream, &params, 2, 130, 4, &seed, NULL), ADCGS_OK);
    stream.slice_log2 = ADCGS_SLICE_LOG2_MIN;
    assert_true(stream.segments[1].predicted); /* with this seed */
    adcgs_buffer_init(bytes);
    assert_int_equal(adcgs_stream_write(&stream, bytes, NULL), ADCGS_OK);
    adcgs_stream_clear(&stream, NULL);
}

static void run_tasks(void *tasks, adcgs_task_fn task, void *work, int n)
{
    in_task = 1;
    for (int i = 0; i < n; i++)
        task(work, i);
    in_task = 0;
    *(int *)tasks += n;
}

/** A caller that lends threads may have an allocator for a single thread only. */
static void test_tasks_allocate_nothing(void **state)
{
    float rgb[33 * 20 * 3];
    adcgs_frame frame = {33, 20, rgb};
    adcgs_buffer bytes;
    adcgs_config config;
    adcgs_decoder *d;
    int tasks = 0;
    (void)state;
    write_two_segments(&bytes);
    adcgs_config_init(&config, sizeof config);
    assert_int_equal(adcgs_pool_wrap(&config.pool, 3, run_tasks, &tasks, NULL), ADCGS_OK);
    assert_int_equal(adcgs_open_memory(&d, bytes.data, bytes.size, &config, NULL), ADCGS_OK);
    assert_true(tasks > 0);
    tasks = 0;
    assert_int_equal(adcgs_render(d, &camera, 0, &frame, NULL), ADCGS_OK);
    assert_true(tasks > 0);
    assert_int_equal(task_calls, 0);
    adcgs_close(&d);
    adcgs_pool_free(&config.pool);
    adcgs_buffer_clear(&bytes);
}

static void test_failing_allocations(void **state)
{
    adcgs_buffer bytes;
    (void)state;
    write_two_segments(&bytes);
    for (int threads = 1; threads <= 2; threads++) {
        long n = 0;
        while (fail_allocation(&bytes, threads, n))
            n++;
        print_message("%d threads: each of %ld allocations failed once\n", threads, n);
        assert_true(n > 100);
    }
    adcgs_buffer_clear(&bytes);
}

/** A pool has as many threads as could be started. */
static void test_no_threads(void **state)
{
    adcgs_pool *pool = NULL;
    (void)state;
    for (int started = 0; started < 3; started++) {
        atomic_store(&left, 2 + started); /* the pool and its list of threads are allocated */
        assert_int_equal(adcgs_pool_create(&pool, 4, NULL), ADCGS_OK);
        atomic_store(&left, -1);
        assert_int_equal(adcgs_pool_threads(pool), 1 + started);
        assert_int_equal(adcgs_pool_missing(pool), 3 - started);
        adcgs_pool_free(&pool);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_anchors),
        cmocka_unit_test(test_segments),
        cmocka_unit_test(test_weights),
        cmocka_unit_test(test_model_bytes),
        cmocka_unit_test(test_work),
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_networks),
        cmocka_unit_test(test_repeated_networks),
        cmocka_unit_test(test_predicted),
        cmocka_unit_test(test_failing_allocations),
        cmocka_unit_test(test_tasks_allocate_nothing),
        cmocka_unit_test(test_no_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
