/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Frames per second as ratios: from numbers, from text, divided. Times in a stream are exact at any rate. */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "media/video/fps.h"

#include <math.h>

static void expect_rate(adcgs_fps rate, uint32_t num, uint32_t den)
{
    if (rate.num != num || rate.den != den)
        fail_msg("%u/%u, expected %u/%u", rate.num, rate.den, num, den);
}

static void numbers_are_ratios(void **state)
{
    static const struct {
        double value;
        uint32_t num, den;
    } rows[] = {{30, 30, 1},
                {25.0000001, 25, 1},
                {1, 1, 1},
                {10000, 10000, 1},
                {29.97, 30000, 1001},
                {23.976, 24000, 1001},
                {59.94, 60000, 1001},
                {119.88, 120000, 1001},
                {30000.0 / 1001.0, 30000, 1001},
                {15000.0 / 1001.0, 15000, 1001},
                {12.5, 25, 2},
                {0.001, 1, 1000},
                {0.04, 1, 25},
                {1.0 / 3.0, 1, 3},
                {4270.0 / 143.0, 4270, 143},
                {123457.0 / 8191.0, 123457, 8191},
                {0, 0, 0},
                {-1, 0, 0},
                {(double)NAN, 0, 0},
                {(double)INFINITY, 0, 0}};
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++)
        expect_rate(adcgs_fps_of(rows[i].value), rows[i].num, rows[i].den);
    const adcgs_fps pi = adcgs_fps_of(3.14159265358979); /* no ratio of small terms, but close, and its terms fit an int */
    assert_true(fabs(adcgs_fps_value(pi) - 3.14159265358979) < 1e-11 && pi.num < INT32_MAX);
}

static void texts_are_ratios(void **state)
{
    static const struct {
        const char *text;
        uint32_t num, den;
    } rows[] = {{"30", 30, 1},   {"29.97", 30000, 1001}, {"30000/1001", 30000, 1001},    {"60/2", 30, 1}, {"1/1000", 1, 1000},
                {"12.5", 25, 2}, {".5", 1, 2},           {"4294967295/4294967295", 1, 1}};
    static const char *const bad[] = {"",      "/",     "30/",    "/1",     "30/0",
                                      "0/1",   "0",     "-30",    "30/-1",  "+30",
                                      " 30",   "30 ",   "30fps",  "nan",    "inf",
                                      "1e9",   "10001", "1/1001", "30/1.5", "4294967296/4294967296",
                                      "3/1/1", "0x10/1"};
    adcgs_fps rate;
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        assert_int_equal(adcgs_fps_parse(rows[i].text, &rate), 0);
        expect_rate(rate, rows[i].num, rows[i].den);
    }
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++)
        if (!adcgs_fps_parse(bad[i], &rate))
            fail_msg("'%s' was accepted as %u/%u", bad[i], rate.num, rate.den);
}

static void rates_are_divided(void **state)
{
    expect_rate(adcgs_fps_divide((adcgs_fps){30000, 1001}, 2), 15000, 1001);
    expect_rate(adcgs_fps_divide((adcgs_fps){25, 1}, 10), 5, 2);
    expect_rate(adcgs_fps_divide((adcgs_fps){0, 0}, 2), 0, 0);
    expect_rate(adcgs_fps_divide((adcgs_fps){3000, 4294967295u}, 2), 100, 286331153); /* in lowest terms the numbers fit */
    assert_true(fabs(adcgs_fps_value(adcgs_fps_divide((adcgs_fps){4294967291u, 4294967279u}, 7)) * 7 - 1) < 1e-8);
}

/** The header has the scene's ratio, and the stream ends when the scene does, to the bit. */
static void streams_keep_rates_and_times(void **state)
{
    static const struct {
        adcgs_fps rate;
        double frames; /**< duration of the scene */
        int64_t ticks;
        uint32_t parts;
    } rows[] = {{{30, 1}, 85, 85, 1},       {{30000, 1001}, 299, 299, 1}, {{25, 2}, 7, 7, 1},
                {{1, 3}, 2, 2, 1},          {{10, 1}, 2.5, 5, 2},         {{30000, 1001}, 10.0 + 1.0 / 3.0, 31, 3},
                {{4000000000u, 1}, 9, 9, 1}};
    for (size_t i = 0; i < ADCGS_COUNTOF(rows); i++) {
        const adcgs_train_config config = small_config();
        adcgs_scene timed = *scene;
        adcgs_trainer *t;
        adcgs_stream stream;
        timed.rate = rows[i].rate;
        timed.duration = rows[i].frames * rows[i].rate.den / rows[i].rate.num;
        assert_int_equal(adcgs_trainer_create(&t, &timed, &config, ADCGS_CPU_SCALAR, pool, &error), ADCGS_OK);
        assert_int_equal(adcgs_encode_stream(&stream, t, NULL, 0, &error), ADCGS_OK);
        expect_rate((adcgs_fps){stream.rate_num, stream.rate_den}, rows[i].rate.num, rows[i].rate.den);
        assert_int_equal(stream.duration_ticks, rows[i].ticks);
        assert_int_equal(stream.timebase_num, rows[i].rate.den);
        assert_int_equal(stream.timebase_den, rows[i].rate.num * rows[i].parts);
        assert_true(fabs(stream.segments[0].time_end - timed.duration) <= 1e-15 * timed.duration);
        adcgs_stream_clear(&stream, NULL);
        adcgs_trainer_free(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_are_ratios), cmocka_unit_test(texts_are_ratios),
                                       cmocka_unit_test(rates_are_divided), cmocka_unit_test(streams_keep_rates_and_times)};
    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
