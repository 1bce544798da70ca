/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Segments with a crossfade from the one before: frames are blended as the specification says, and are the same for every way of
 * reading a stream. A decoder without the segment before renders the next one alone.
 */
#include "config.h"

#include "stream_fixture.h"

#include "base/cpu_detect.h"
#include "base/digest.h"
#include "render/render.h"
#include "splat/splat.h"
#include "stream/chunk.h"

#include <adcgs/adcgs.h>

#include <math.h>

enum { SEGMENTS = 7, WIDTH = 31, HEIGHT = 23, PIXELS = WIDTH * HEIGHT, VALUES = 3 * PIXELS, TIMES = 150 };

static const adcgs_camera camera = {.width = WIDTH,
                                    .height = HEIGHT,
                                    .fx = 25,
                                    .fy = 25,
                                    .cx = 15,
                                    .cy = 11,
                                    .near_plane = 0.1,
                                    .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -12}};

/** Crossfade of each segment in ticks: a whole segment, none, longer than the segment, one tick, others. */
static const int reach[SEGMENTS] = {40, 0, 90, 1, 12, 20, 33};

static float drawn_alone[2][VALUES], expected[TIMES][VALUES];

/** Times in an arbitrary order, some at the ends of segments and crossfades. */
static double time_of(int i)
{
    return i < 2 * SEGMENTS ? (i % 2 ? 40 * (i / 2) : 40 * (i / 2) + reach[i / 2]) * 1e-3 : (i - 20) * 0.00237;
}

static void draw_alone(const adcgs_stream *s, uint32_t segment, double time, float *out)
{
    static float planar[VALUES];
    adcgs_splat *splat;
    adcgs_raster *raster;
    adcgs_primitives primitives;
    adcgs_view view;
    const adcgs_model *m = &s->segments[segment];
    const double span = m->time_end + m->reach - m->time_start;
    assert_int_equal(adcgs_view_init(&view, &camera, s->scene_origin, s->scene_scale, NULL), ADCGS_OK);
    assert_int_equal(adcgs_splat_create(&splat, m, ADCGS_CPU_SCALAR, NULL, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_create(&raster, ADCGS_CPU_SCALAR, NULL, NULL, NULL), ADCGS_OK);
    assert_int_equal(adcgs_splat_at(splat, (float)((time - m->time_start) / span), &primitives, NULL), ADCGS_OK);
    assert_int_equal(adcgs_raster_forward(raster, &primitives, &view, s->background, s->screen_filter, planar, 0, NULL),
                     ADCGS_OK);
    for (int i = 0; i < VALUES; i++)
        out[i] = planar[i % 3 * PIXELS + i / 3];
    adcgs_raster_free(&raster);
    adcgs_splat_free(&splat);
}

static uint32_t segment_of(const adcgs_stream *s, double time)
{
    uint32_t i = 0;
    while (i + 1 < s->n_segments && s->segments[i + 1].time_start <= time)
        i++;
    return i;
}

/** True if a time lies in a crossfade; weight: how far in. */
static int is_fade(const adcgs_stream *s, double time, float *weight)
{
    const uint32_t i = segment_of(s, time);
    if (i == 0 || time >= s->segments[i - 1].time_end + s->segments[i - 1].reach)
        return 0;
    const double start = s->segments[i].time_start, until = s->segments[i - 1].time_end + s->segments[i - 1].reach;
    *weight = (float)((time - start) / (until - start));
    return 1;
}

static int setup(void **state)
{
    fixture *f = fixture_new(state);
    adcgs_stream *s = &f->stream;
    uint64_t seed = 14;
    adcgs_random_params(&s->params, 1, &seed);
    s->slice_log2 = ADCGS_SLICE_LOG2_MIN;
    s->background[1] = 0.3f;
    if (adcgs_random_turns(s, SEGMENTS, 120, 5, 60, &seed, NULL) != ADCGS_OK)
        return -1;
    for (int i = 0; i < SEGMENTS; i++)
        s->segments[i].reach = adcgs_ticks_to_seconds(s, reach[i]);
    for (int i = 0; i < TIMES; i++) {
        const double time = time_of(i);
        const uint32_t segment = segment_of(s, time);
        float weight;
        draw_alone(s, segment, time, expected[i]);
        if (!is_fade(s, time, &weight))
            continue;
        draw_alone(s, segment - 1, time, drawn_alone[0]);
        for (int v = 0; v < VALUES; v++)
            expected[i][v] = drawn_alone[0][v] + weight * (expected[i][v] - drawn_alone[0][v]);
    }
    return adcgs_stream_write(s, &f->bytes, NULL) == ADCGS_OK ? 0 : -1;
}

static void draw(adcgs_decoder *d, double time, float *out)
{
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_frame frame = {WIDTH, HEIGHT, out};
    if (adcgs_render(d, &camera, time, &frame, &error) != ADCGS_OK)
        fail_msg("at %g: %s", time, error.text);
}

static void check_frame(adcgs_decoder *d, int i)
{
    static float found[VALUES];
    draw(d, time_of(i), found);
    if (memcmp(found, expected[i], sizeof found))
        fail_msg("the frame at %.17g differs", time_of(i));
}

static int64_t read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    const adcgs_buffer *b = user;
    assert_true(offset < b->size && bytes <= b->size - offset);
    memcpy(buffer, b->data + offset, bytes);
    return (int64_t)bytes;
}

/** REQ-REND-012: each number of a frame, at every CPU level and with threads. */
static void test_frames(void **state)
{
    fixture *f = *state;
    int fading = 0, half = 0;
    float weight = 0;
    for (int i = 0; i < TIMES; i++) {
        fading += is_fade(&f->stream, time_of(i), &weight);
        half += weight > 0.2f && weight < 0.8f;
    }
    assert_true(fading > TIMES / 4 && half > TIMES / 8 && fading < TIMES - 20);
    for (int cpu = ADCGS_CPU_SCALAR; cpu <= (int)adcgs_cpu_best(); cpu++) {
        adcgs_decoder *d = NULL;
        adcgs_config config;
        adcgs_config_init(&config, sizeof config);
        config.cpu = (adcgs_cpu_level)cpu;
        config.threads = cpu;
        assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size, &config, NULL), ADCGS_OK);
        for (int i = 0; i < TIMES; i++)
            check_frame(d, i);
        adcgs_close(&d);
    }
}

/** Reads on demand, forwards, backwards and in any order. At most two models are in memory. */
static void test_seek(void **state)
{
    fixture *f = *state;
    adcgs_decoder *d = NULL;
    adcgs_info info;
    uint32_t most = 0;
    uint64_t seed = 3;
    for (int i = 0; i + 1 < SEGMENTS; i++)
        most = ADCGS_MAX(most, f->stream.segments[i].n + f->stream.segments[i + 1].n);
    assert_int_equal(adcgs_open_at(&d, read_at, &f->bytes, f->bytes.size, NULL, NULL), ADCGS_OK);
    for (int i = 0; i < 4 * TIMES; i++) {
        check_frame(d, i < TIMES ? i : i < 2 * TIMES ? 2 * TIMES - 1 - i : (int)adcgs_random_range(&seed, 0, TIMES - 1));
        adcgs_get_info(d, &info, sizeof info, NULL);
        assert_in_range(info.anchors, 1, most);
    }
    adcgs_close(&d);
}

/** Pushes the stream and renders each frame as soon as it is final; forgets: discard data before the current time. */
static void play_pushed(const fixture *f, int forgets)
{
    int in_order[TIMES];
    adcgs_decoder *d = NULL;
    for (int i = 0; i < TIMES; i++) {
        int at = i;
        for (; at > 0 && time_of(in_order[at - 1]) > time_of(i); at--)
            in_order[at] = in_order[at - 1];
        in_order[at] = i;
    }
    assert_int_equal(adcgs_open_push(&d, NULL, NULL), ADCGS_OK);
    int next = 0;
    for (size_t at = 0; at < f->bytes.size;) {
        size_t used;
        adcgs_arrival arrived;
        adcgs_info info = {.time_committed = -INFINITY};
        assert_int_equal(adcgs_push(d, f->bytes.data + at, f->bytes.size - at, &used, &arrived, NULL), ADCGS_OK);
        at += used;
        adcgs_get_info(d, &info, sizeof info, NULL);
        for (; next < TIMES && time_of(in_order[next]) < info.time_committed; next++) {
            if (forgets)
                assert_int_equal(adcgs_push_discard_before(d, time_of(in_order[next]), NULL), ADCGS_OK);
            check_frame(d, in_order[next]);
        }
    }
    assert_int_equal(next, TIMES);
    adcgs_close(&d);
}

static void test_push(void **state)
{
    play_pushed(*state, 0);
    play_pushed(*state, 1);
}

/** Offset of segment n. */
static size_t segment_at(const adcgs_buffer *b, int n)
{
    for (size_t at = ADCGS_SIGNATURE_BYTES; at < b->size; at += ADCGS_CHUNK_BYTES + adcgs_load_le32(b->data + at + 4))
        if (adcgs_load_le32(b->data + at) == ADCGS_TYPE_SEGM && adcgs_load_le16(b->data + at + 8) == n)
            return at;
    fail_msg("no such segment");
    return 0;
}

static char told[2000];

static void listen(void *user, adcgs_log_level level, const char *text)
{
    (void)user;
    if (level == ADCGS_LOG_WARNING)
        strncat(told, text, sizeof told - strlen(told) - 1);
}

/** Where a segment is lost, the next one, a key, is rendered alone instead of crossfaded, and the log reports it. */
static void test_lost(void **state)
{
    const fixture *f = *state;
    const double time = 0.242; /* in segment 6, into which 5 fades */
    adcgs_buffer b;
    adcgs_config config;
    adcgs_decoder *d = NULL;
    float found[VALUES], weight;
    assert_true(is_fade(&f->stream, time, &weight) && segment_of(&f->stream, time) == 6);
    draw_alone(&f->stream, 6, time, drawn_alone[0]);
    adcgs_buffer_init(&b);
    adcgs_write_bytes(&b, f->bytes.data, f->bytes.size);
    size_t at = segment_at(&b, 5);
    while (adcgs_load_le32(b.data + at) != ADCGS_TYPE_KEEP)
        at += ADCGS_CHUNK_BYTES + adcgs_load_le32(b.data + at + 4);
    b.data[at + ADCGS_CHUNK_HEADER_BYTES] ^= 4;
    adcgs_config_init(&config, sizeof config);
    config.conceal = 1;
    config.log = listen;
    assert_int_equal(adcgs_open_memory(&d, b.data, b.size, &config, NULL), ADCGS_OK);
    assert_non_null(strstr(told, "segment 5 is lost, and the crossfade into the next one"));
    draw(d, time, found);
    assert_memory_equal(found, drawn_alone[0], sizeof found);
    adcgs_close(&d);
    adcgs_buffer_clear(&b);
}

/** After tune-in behind a segment, the next one is rendered alone from its start on. Later ones are crossfaded. */
static void test_joined(void **state)
{
    const fixture *f = *state;
    adcgs_buffer b;
    adcgs_config config;
    adcgs_decoder *d = NULL;
    float found[VALUES];
    const size_t head = ADCGS_CHUNK_BYTES + adcgs_load_le32(f->bytes.data + ADCGS_SIGNATURE_BYTES + 4);
    const size_t at = segment_at(&f->bytes, 3);
    adcgs_buffer_init(&b);
    adcgs_write_bytes(&b, f->bytes.data + ADCGS_SIGNATURE_BYTES, head);
    adcgs_write_bytes(&b, f->bytes.data + at, f->bytes.size - at);
    adcgs_config_init(&config, sizeof config);
    config.tune_in = 1;
    assert_int_equal(adcgs_open_memory(&d, b.data, b.size, &config, NULL), ADCGS_OK);
    for (int i = 0; i < TIMES; i++) {
        const uint32_t segment = segment_of(&f->stream, time_of(i));
        draw_alone(&f->stream, 3, time_of(i), drawn_alone[0]);
        draw(d, time_of(i), found);
        assert_memory_equal(found, segment > 3 ? expected[i] : drawn_alone[0], sizeof found);
    }
    adcgs_close(&d);
    adcgs_buffer_clear(&b);
}

/** Other kinds of image are blended as well: 8-bit images equal the frame; depth and coverage lie between the values of both. */
static void test_kinds(void **state)
{
    const fixture *f = *state;
    static float found[VALUES], alpha[PIXELS], depth[PIXELS];
    static uint8_t rgba[3][4 * PIXELS], rgb[VALUES];
    const adcgs_frame frame = {WIDTH, HEIGHT, found};
    adcgs_decoder *d = NULL;
    float weight;
    int between = 0;
    const double time = 0.0575;
    assert_true(is_fade(&f->stream, time, &weight) && weight > 0.4f && weight < 0.5f);
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size, NULL, NULL), ADCGS_OK);
    draw(d, time, found);
    adcgs_frame_to_u8(&frame, rgb);
    for (int a = ADCGS_ALPHA_OPAQUE; a <= ADCGS_ALPHA_PREMULTIPLIED; a++)
        assert_int_equal(adcgs_render_rgba8(d, &camera, time, (adcgs_alpha)a, rgba[a], 4 * WIDTH, NULL), ADCGS_OK);
    assert_int_equal(adcgs_render_depth(d, &camera, time, depth, alpha, NULL), ADCGS_OK);
    for (int i = 0; i < PIXELS; i++) {
        assert_memory_equal(rgba[0] + 4 * i, rgb + 3 * i, 3);
        assert_int_equal(rgba[1][4 * i + 3], (int)(alpha[i] * 255.0f + 0.5f));
        assert_int_equal(rgba[2][4 * i + 3], rgba[1][4 * i + 3]);
        for (int c = 0; c < 3; c++) {
            const float own = found[3 * i + c] - (1.0f - alpha[i]) * f->stream.background[c];
            assert_true(fabsf(255.0f * fminf(fmaxf(own, 0), 1) - rgba[2][4 * i + c]) < 0.51f);
        }
        assert_true(alpha[i] > 0 ? depth[i] > 0 : depth[i] == ADCGS_DEPTH_FAR);
        between += alpha[i] > 0.05f && alpha[i] < 0.95f;
    }
    assert_true(between > PIXELS / 20);
    adcgs_close(&d);
}

/** Splats are those of the segment alone. Fewer tiers, layers and back again change both images of a crossfade. */
static void test_splats(void **state)
{
    const fixture *f = *state;
    const double time = 0.0575;
    adcgs_decoder *d = NULL;
    adcgs_primitives p;
    float coarse[VALUES], fine[VALUES];
    assert_int_equal(adcgs_open_memory(&d, f->bytes.data, f->bytes.size, NULL, NULL), ADCGS_OK);
    draw(d, time, fine);
    assert_int_equal(adcgs_get_primitives(d, time, &p, NULL), ADCGS_OK);
    assert_int_equal(p.n, (f->stream.segments[1].n + 63) / 64 * 64 * f->stream.params.k);
    assert_int_equal(adcgs_set_tiers(d, 1, NULL), ADCGS_OK);
    draw(d, time, coarse);
    assert_int_equal(memcmp(coarse, fine, sizeof fine) != 0, f->stream.segments[0].finest > 0);
    assert_int_equal(adcgs_set_tiers(d, 0, NULL), ADCGS_OK);
    draw(d, time, coarse);
    assert_memory_equal(coarse, fine, sizeof fine);
    adcgs_close(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frames), cmocka_unit_test(test_seek),  cmocka_unit_test(test_push),   cmocka_unit_test(test_lost),
        cmocka_unit_test(test_joined), cmocka_unit_test(test_kinds), cmocka_unit_test(test_splats),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
