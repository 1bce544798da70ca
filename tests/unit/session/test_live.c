/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The parts of --live: lengths of Y4M frames; segments of footage that comes in any order, with gaps or not at all; growing
 * files; streams that are put in order at their end.
 */
#define _POSIX_C_SOURCE 200809L
#include "live_footage.h"
#include "random_model.h"

#include "encode/settle.h"
#include "media/video/y4m_shape.h"
#include "scene/live/live_scene.h"
#include "session/resume_reader.h"
#include "stream/grow.h"
#include "stream/input.h"
#include "system/growing.h"

#include <adcgs/adcgs.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

/* ---- Y4M ---- */

static void expect_shape(const char *line, adcgs_status status, size_t bytes)
{
    adcgs_y4m_shape shape;
    assert_int_equal(adcgs_y4m_shape_parse(&shape, line, "x.y4m", &error), status);
    if (status == ADCGS_OK)
        assert_int_equal(shape.frame_bytes, bytes);
}

static void test_shapes(void **state)
{
    adcgs_y4m_shape shape;
    (void)state;
    expect_shape("YUV4MPEG2 W5 H3", ADCGS_OK, 15 + 2 * 3 * 2);
    expect_shape("YUV4MPEG2 W5 H3 C420jpeg XYSCSS=420JPEG", ADCGS_OK, 15 + 2 * 3 * 2);
    expect_shape("YUV4MPEG2 H3 W5 C422 A1:1", ADCGS_OK, 15 + 2 * 3 * 3);
    expect_shape("YUV4MPEG2 W5 H3 C444", ADCGS_OK, 45);
    expect_shape("YUV4MPEG2 W5 H3 C444alpha", ADCGS_OK, 60);
    expect_shape("YUV4MPEG2 W5 H3 C411", ADCGS_OK, 15 + 2 * 2 * 3);
    expect_shape("YUV4MPEG2 W5 H3 Cmono", ADCGS_OK, 15);
    expect_shape("YUV4MPEG2 W5 H3 Cmono12", ADCGS_OK, 30);
    expect_shape("YUV4MPEG2 W5 H3 C420p10 XYSCSS=420P10", ADCGS_OK, 2 * (15 + 2 * 3 * 2));
    expect_shape("YUV4MPEG2 W5 H3 C444p16", ADCGS_OK, 90);
    expect_shape("YUV4MPEG2 W5 H3 C421", ADCGS_ERR_UNSUPPORTED, 0);
    expect_shape("YUV4MPEG2 W5 H3 C420p11", ADCGS_ERR_UNSUPPORTED, 0);
    expect_shape("YUV4MPEG2 W5", ADCGS_ERR_DATA, 0);
    expect_shape("YUV4MPEG2 W0 H3", ADCGS_ERR_DATA, 0);
    expect_shape("YUV4MPEG2 W99999999999999999999 H3", ADCGS_ERR_DATA, 0);
    expect_shape("YUV4MPEG2 W-5 H3", ADCGS_ERR_DATA, 0);
    expect_shape("P6 5 3 255", ADCGS_ERR_DATA, 0);
    assert_int_equal(adcgs_y4m_shape_parse(&shape, "YUV4MPEG2 W5 H3 F30000:1001", "x", &error), ADCGS_OK);
    assert_true(shape.rate.num == 30000 && shape.rate.den == 1001);
    assert_int_equal(adcgs_y4m_shape_parse(&shape, "YUV4MPEG2 W5 H3 F0:0", "x", &error), ADCGS_OK);
    assert_int_equal(shape.rate.den, 0);
}

/* ---- Footage ---- */

/** Timestamps 0, 0.05, .., 1.15. Each image may come before its predecessor. Views at a cut are in both segments. */
static void test_segments(void **state)
{
    (void)state;
    for (int unbounded = 0; unbounded < 2; unbounded++) {
        adcgs_live_segment s = {.scene = NULL};
        adcgs_live *live = open_live(0.48, unbounded);
        for (int i = 0; i < FRAMES; i++)
            for (int c = 0; c < CAMERAS; c++)
                put(c, i ^ 1);
        put_end();
        expect_segment(live, &s, 0, 0.5, 6 + 5, 11);
        expect_segment(live, &s, 0.5, 0.95, 5 + 5, 10);
        expect_segment(live, &s, 0.95, 1.15, 2 + 3, 5);
        expect_over(live, &s);
        expect_over(live, &s);
        adcgs_live_segment_clear(&s);
        adcgs_live_close(&live);
        start_again();
    }
}

/** Frames that never come, one whose file is no image, and a camera that ends earlier. */
static void test_gaps(void **state)
{
    adcgs_live_segment s = {.scene = NULL};
    double time = -1;
    (void)state;
    for (int i = 0; i < FRAMES; i++)
        if (i != 3 && i != 5)
            put(0, i);
    for (int i = 0; i < 8; i++)
        put(1, i);
    assert_int_equal(truncate(in_folder("c%d-%02d.ppm", 1, 1), 20), 0);
    put_end();
    adcgs_live *live = open_live(0.5, 0);
    expect_segment(live, &s, 0, 0.5, 4 + 4, 8);
    assert_string_equal(adcgs_live_missing(live, &time), "a");
    assert_float_equal(time, 0.3, 1e-6);
    assert_string_equal(adcgs_live_missing(live, &time), "b");
    assert_float_equal(time, 0.15, 1e-6);
    assert_null(adcgs_live_missing(live, &time));
    expect_segment(live, &s, 0.5, 1, 5 + 3, 8);
    expect_segment(live, &s, 1, 1.1, 2, 2);
    expect_over(live, &s);
    assert_null(adcgs_live_missing(live, &time));
    adcgs_live_segment_clear(&s);
    adcgs_live_close(&live);
    start_again();
}

/**
 * Footage that continues a stream begins behind its last segment. If that segment was cut short, it begins again at its start,
 * except if the stream was cut elsewhere. Earlier footage may be gone.
 */
static void test_going_on(void **state)
{
    static const struct {
        double last[2], begin;
    } cases[] = {{{0.5, 0.95}, 0.95}, {{0.5, 0.95 - 1e-7}, 0.95}, {{0.5, 0.8}, 0.5}, {{0.4, 0.8}, 0.95}, {{0, 0.5}, 0.5},
                 {{0, 0.15}, 0},      {{0.95, 1.15}, 0.95},       {{0.7, 1.2}, 2}};
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        adcgs_live_segment s = {.scene = NULL};
        adcgs_live *live = NULL;
        const double begin = cases[i].begin;
        const adcgs_live_options options = {.seconds = 0.48,
                                            .interrupted = is_interrupted,
                                            .origin = {1, 2, 3},
                                            .scale = 4,
                                            .last = {cases[i].last[0], cases[i].last[1]}};
        for (int f = (int)(10 * begin + 0.01); f < FRAMES; f++)
            for (int c = 0; c < CAMERAS; c++)
                put(c, f);
        put_end();
        assert_int_equal(adcgs_live_open(&live, folder, &options, &error), ADCGS_OK);
        if (begin < 0.4)
            expect_segment(live, &s, 0, 0.5, 6 + 5, 11);
        if (begin < 0.9)
            expect_segment(live, &s, 0.5, 0.95, 5 + 5, 10);
        if (begin < 1)
            expect_segment(live, &s, 0.95, 1.15, 2 + 3, 5);
        if (begin < 1)
            assert_true(adcgs_live_whole(live)->scale == 4 && adcgs_live_whole(live)->origin[2] == 3);
        expect_over(live, &s);
        adcgs_live_segment_clear(&s);
        adcgs_live_close(&live);
        start_again();
    }
}

/** An interrupt is an end. A single time makes no segment. A missing scene and an unusable scene are errors. */
static void test_ends(void **state)
{
    adcgs_live_segment s = {.scene = NULL};
    (void)state;
    for (int i = 0; i < 6; i++)
        for (int c = 0; c < CAMERAS; c++)
            put(c, i);
    adcgs_live *live = open_live(0.5, 0);
    expect_segment(live, &s, 0, 0.5, 6 + 5, 11);
    interrupted = 2;
    assert_int_equal(adcgs_live_next(live, &s, &error), ADCGS_OK); /* views seen behind the cut may make a segment, or not */
    if (s.scene)
        expect_over(live, &s);
    adcgs_live_close(&live);
    start_again();

    put(0, 0);
    put_end();
    live = open_live(0.5, 0);
    assert_int_equal(adcgs_live_next(live, &s, &error), ADCGS_ERR_DATA);
    adcgs_live_close(&live);
    start_again();
    const adcgs_live_options options = {.seconds = 1, .interrupted = is_interrupted};
    assert_int_equal(adcgs_live_open(&live, "/nowhere/scene.json", &options, &error), ADCGS_ERR_IO);
    assert_null(live);
}

/* ---- Files ---- */

static size_t size_of(const char *path)
{
    struct stat s;
    return stat(path, &s) ? 0 : (size_t)s.st_size;
}

/** A growing file replaces the old one with its first piece and holds each piece at once. Without a piece the old file stays. */
static void test_growing(void **state)
{
    adcgs_growing g;
    const char *path = in_folder("grown", 0, 0);
    (void)state;
    assert_int_equal(adcgs_atomic_save(path, "old", 3, &error), ADCGS_OK);
    assert_int_equal(adcgs_growing_open(&g, path, &error), ADCGS_OK);
    assert_int_equal(size_of(path), 3);
    adcgs_growing_close(&g);
    assert_int_equal(size_of(path), 3);
    assert_int_equal(adcgs_growing_open(&g, path, &error), ADCGS_OK);
    for (size_t n = 1; n < 4; n++) {
        assert_int_equal(adcgs_growing_append(&g, "0123456789", 10, &error), ADCGS_OK);
        assert_int_equal(size_of(path), 10 * n);
    }
    adcgs_growing_close(&g);
    adcgs_growing_close(&g);
    assert_int_equal(size_of(path), 30);
    for (int shown = 0; shown < 2; shown++) { /* hidden pieces appear with the first visible one */
        assert_int_equal(adcgs_growing_open(&g, path, &error), ADCGS_OK);
        g.is_hidden = 1;
        assert_int_equal(adcgs_growing_append(&g, "01234", 5, &error), ADCGS_OK);
        assert_int_equal(adcgs_growing_append(&g, "56789", 5, &error), ADCGS_OK);
        assert_int_equal(size_of(path), 30);
        g.is_hidden = 0;
        if (shown)
            assert_int_equal(adcgs_growing_append(&g, "!", 1, &error), ADCGS_OK);
        adcgs_growing_close(&g);
        assert_int_equal(size_of(path), shown ? 11 : 30);
    }
    assert_int_equal(adcgs_growing_open(&g, "/dev/full", &error), ADCGS_OK);
    assert_int_equal(adcgs_growing_append(&g, "0123456789", 10, &error), ADCGS_ERR_IO);
    adcgs_growing_close(&g);
    unlink(path);
}

static int64_t read_at(void *user, uint64_t offset, void *buffer, size_t bytes)
{
    return adcgs_file_read_at(user, offset, buffer, bytes);
}

/** A stream that grew, and the HEAD with its final length. */
static void grow_stream(adcgs_stream *s, adcgs_buffer *bytes, adcgs_buffer *head, size_t ends[SEGMENTS])
{
    adcgs_grow *grow_stream;
    adcgs_stream front;
    uint64_t seed = 5;
    adcgs_stream_init(s);
    adcgs_random_small_params(&s->params, 2, &seed);
    s->slice_log2 = ADCGS_SLICE_LOG2_MIN;
    assert_int_equal(adcgs_random_turns(s, SEGMENTS, 80, 4, 70, &seed, &error), ADCGS_OK);
    front = *s;
    front.n_segments = 0;
    front.level = 3;
    assert_int_equal(adcgs_grow_create(&grow_stream, &front, 500, &error), ADCGS_OK);
    for (uint32_t i = 0; i < SEGMENTS; i++) {
        assert_int_equal(adcgs_grow_segment(grow_stream, i ? &s->segments[i - 1] : NULL, &s->segments[i], bytes, &error),
                         ADCGS_OK);
        ends[i] = bytes->size;
    }
    assert_int_equal(adcgs_grow_end(grow_stream, bytes, &error), ADCGS_OK);
    assert_int_equal(adcgs_grow_settle(grow_stream, head, &error), ADCGS_OK);
    adcgs_grow_free(&grow_stream);
}

/** A settled stream is a normal stream of the same duration and models, with an index, at a lower level. */
static void test_settle(void **state)
{
    adcgs_stream s;
    adcgs_buffer bytes, head;
    adcgs_decoder *d = NULL;
    adcgs_info info;
    uint8_t found[16], expected[16];
    (void)state;
    adcgs_buffer_init(&bytes);
    adcgs_buffer_init(&head);
    size_t ends[SEGMENTS];
    grow_stream(&s, &bytes, &head, ends);
    FILE *from = tmpfile(), *to = tmpfile();
    assert_true(from && to && fwrite(bytes.data, 1, bytes.size, from) == bytes.size && !fseek(from, 0, SEEK_SET));
    assert_int_equal(adcgs_encode_replace_head(to, from, head.data, head.size, "x", &error), ADCGS_OK);
    assert_int_equal(ftell(to), bytes.size);
    rewind(to);
    assert_int_equal(adcgs_open_stream(&d, adcgs_file_read, to, NULL, &error), ADCGS_OK);
    assert_int_equal(adcgs_get_info(d, &info, sizeof info, &error), ADCGS_OK);
    assert_int_equal(info.level, 1);
    adcgs_close(&d);
    assert_int_equal(adcgs_open_at(&d, read_at, to, bytes.size, NULL, &error), ADCGS_OK);
    for (uint32_t i = 0; i < SEGMENTS; i++) {
        adcgs_model_digest(&s.segments[i], expected);
        assert_int_equal(adcgs_get_model_digest(d, (int)i, found, &error), ADCGS_OK);
        assert_memory_equal(found, expected, 16);
    }
    adcgs_close(&d);
    for (size_t cut = 0; cut < bytes.size; cut += 97) { /* a stream that ends early cannot be settled */
        FILE *part = tmpfile();
        assert_true(part && fwrite(bytes.data, 1, cut, part) == cut && !fseek(part, 0, SEEK_SET));
        assert_int_equal(adcgs_encode_replace_head(to, part, head.data, head.size, "x", &error), ADCGS_ERR_DATA);
        fclose(part);
    }
    rewind(from);
    assert_int_equal(adcgs_encode_replace_head(to, from, head.data, head.size - 1, "x", &error), ADCGS_ERR_DATA);
    fclose(from);
    fclose(to);
    adcgs_stream_clear(&s, NULL);
    adcgs_buffer_clear(&bytes);
    adcgs_buffer_clear(&head);
}

/** Expects, from a stream whose bytes are right up to `right`, its whole segments, unchanged. */
static void expect_past(const adcgs_stream *s, const uint8_t *data, size_t n, size_t right, const size_t *ends)
{
    const char *path = in_folder("past", 0, 0);
    adcgs_resume_reader past;
    adcgs_model model;
    uint32_t found = 0, whole = 0;
    assert_int_equal(adcgs_atomic_save(path, data, n, &error), ADCGS_OK);
    assert_int_equal(adcgs_resume_reader_open(&past, path, ADCGS_CPU_SCALAR, NULL, &error), ADCGS_OK);
    while (whole < SEGMENTS && ends[whole] <= right)
        whole++;
    for (;; found++) {
        assert_int_equal(adcgs_resume_reader_next(&past, &model, &error), ADCGS_OK);
        if (!model.n)
            break;
        assert_true(found < SEGMENTS && adcgs_model_equal(&s->segments[found], &model, &error));
        assert_true(model.time_start == s->segments[found].time_start && model.predicted == s->segments[found].predicted);
        adcgs_model_clear(&model, NULL);
    }
    assert_true(found >= whole && found <= whole + 1); /* a segment is whole even if the digest behind it is not */
    assert_int_equal(past.fault.status != ADCGS_OK, right < n);
    assert_int_equal(adcgs_resume_reader_next(&past, &model, &error), ADCGS_OK);
    assert_int_equal(model.n, 0);
    adcgs_resume_reader_close(&past);
    unlink(path);
}

/** Cut off, and damaged, at many places. */
static void test_past(void **state)
{
    adcgs_stream s;
    adcgs_buffer bytes, head;
    adcgs_resume_reader past;
    size_t ends[SEGMENTS];
    (void)state;
    adcgs_buffer_init(&bytes);
    adcgs_buffer_init(&head);
    grow_stream(&s, &bytes, &head, ends);
    for (size_t n = 0; n <= bytes.size; n += 53)
        expect_past(&s, bytes.data, n, n, ends);
    for (uint32_t i = 0; i < SEGMENTS; i++)
        for (size_t n = ends[i] - 1; n < ends[i] + 2; n++)
            expect_past(&s, bytes.data, n, n, ends);
    expect_past(&s, bytes.data, bytes.size, bytes.size, ends);
    for (size_t n = 2; n < bytes.size; n += 211) {
        bytes.data[n] ^= 0x55;
        expect_past(&s, bytes.data, bytes.size, n, ends);
        bytes.data[n] ^= 0x55;
    }
    assert_int_equal(adcgs_resume_reader_open(&past, "/nowhere/x", ADCGS_CPU_SCALAR, NULL, &error), ADCGS_ERR_IO);
    adcgs_resume_reader_close(&past);
    adcgs_stream_clear(&s, NULL);
    adcgs_buffer_clear(&bytes);
    adcgs_buffer_clear(&head);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes),   cmocka_unit_test(test_segments), cmocka_unit_test(test_gaps),
        cmocka_unit_test(test_ends),     cmocka_unit_test(test_growing),  cmocka_unit_test(test_settle),
        cmocka_unit_test(test_going_on), cmocka_unit_test(test_past),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
