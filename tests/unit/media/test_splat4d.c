/* SPDX-License-Identifier: BSD-2-Clause */
/** \file .splat4d: another encoder's sample against its source, changed headers, damage. */
#include "dynamic_fixture.h"

#ifdef HAVE_SPZ

#include "dynamic_threads.h"
#include "splat4d_maker.h"

#include "media/dynamic/splat4d.h"

#define SAMPLE SAMPLES "splat4d/scene.splat4d"

/* Bounds of the sample: half a step of bins, and their rounding; definition (its header). */
#define BOUND_MEAN 0.002001
#define BOUND_SCALE 0.0201 /* relative */
#define BOUND_LEVEL (4.01 / 255.0)

enum { N = 2000, FRAMES = 24, RECORD = 32 };

/* ---- Against the source ---- */

static double get_float(const uint8_t *record, int i)
{
    return (double)adcgs_bits_float(adcgs_load_le32(record + 4 * i));
}

/** True if a splat is within the bounds of a record of .splat: position, scale, colour and opacity, rotation. */
static int fits(const adcgs_splats *s, uint32_t i, const uint8_t *record)
{
    const double levels[4] = {(double)s->colour[0][i], (double)s->colour[1][i], (double)s->colour[2][i], (double)s->opacity[i]};
    double dot = 0.0, square = 0.0;
    for (int a = 0; a < 3; a++)
        if (!(fabs((double)s->mean[a][i] - get_float(record, a)) <= BOUND_MEAN) ||
            !(fabs(log((double)s->scale[a][i] / get_float(record, 3 + a))) <= BOUND_SCALE))
            return 0;
    for (int a = 0; a < 4; a++) {
        const double turn = (record[28 + a] - 128) / 128.0;
        if (!(fabs(levels[a] - record[24 + a] / 255.0) <= BOUND_LEVEL))
            return 0;
        dot += (double)s->rotation[a][i] * turn;
        square += turn * turn;
    }
    return fabs(dot) / sqrt(square) > 1.0 - 1e-6;
}

static adcgs_splats frame_of(const adcgs_dynamic *d, int frame)
{
    adcgs_splats s;
    if (adcgs_dynamic_at(d, frame / adcgs_fps_value(d->rate), &s, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_int_equal(s.n, N);
    return s;
}

static void load_frame(uint8_t **data, int frame)
{
    char name[64];
    size_t bytes;
    snprintf(name, sizeof name, SAMPLES "splat_frames/frame_%04d.splat", frame);
    assert_int_equal(adcgs_file_load(data, &bytes, real_data(name), 1 << 20, &error), ADCGS_OK);
    assert_int_equal(bytes, N * RECORD);
}

/** Every splat of every known frame, in any order of time, is within the bounds of one splat of the source, the same in all. */
static void test_frames(void **state)
{
    static uint8_t fit[N][N]; /* of ours, of the source: fits in all frames so far */
    adcgs_dynamic *d = open_sample(SAMPLE, NULL);
    assert_true(d->n == N && d->frames == FRAMES && d->rate.num == 20 && d->rate.den == 1);
    assert_true(d->has_identity && !d->is_continuous);
    memset(fit, 1, sizeof fit);
    for (int k = 0; k < 8; k++) {
        uint8_t *source;
        const int frame = k * 5 % 8 * 3;
        adcgs_splats s = frame_of(d, frame);
        load_frame(&source, frame);
        for (uint32_t i = 0; i < N; i++)
            for (uint32_t j = 0; j < N; j++)
                fit[i][j] = fit[i][j] && fits(&s, i, source + (size_t)RECORD * j);
        adcgs_splats_free(&s);
        free(source);
    }
    for (uint32_t i = 0; i < N; i++)
        if (!memchr(fit[i], 1, N))
            fail_msg("splat %u is no splat of the source", i);
    adcgs_dynamic_free(&d);
}

static void test_answers(void **state)
{
    json_t *root, *const wanted = expected(&root, "splat4d"), *const answers = json_object_get(wanted, "answers");
    json_t *const rows = json_object_get(wanted, "file_index_of_splat_frames_index");
    const tolerance most = {BOUND_MEAN, BOUND_LEVEL, BOUND_LEVEL, 0.1 * BOUND_SCALE, 1e-5};
    adcgs_dynamic *d = open_sample(SAMPLE, NULL);
    for (size_t i = 0; i < json_array_size(answers); i++) {
        const json_t *const answer = json_array_get(answers, i), *const splats = json_object_get(answer, "splats");
        adcgs_splats s = frame_of(d, (int)rint(23.0 * number_of(answer, "t", 0)));
        for (size_t k = 0; k < json_array_size(splats); k++) {
            const json_t *const splat = json_array_get(splats, k);
            char index[16];
            snprintf(index, sizeof index, "%d", (int)json_integer_value(json_object_get(splat, "index")));
            expect_splat(&s, (uint32_t)json_integer_value(json_object_get(rows, index)), splat, &most);
        }
        adcgs_splats_free(&s);
    }
    json_decref(root);
    adcgs_dynamic_free(&d);
}

/** A rate of the options stretches the clip. Between frames the earlier one is shown, also across groups. */
static void test_clock(void **state)
{
    const adcgs_dynamic_options slow = {.rate = {10, 1}, .frames = 3};
    adcgs_dynamic *d = open_sample(SAMPLE, &slow);
    assert_true(d->frames == FRAMES && adcgs_dynamic_duration(d) == 2.3);
    adcgs_splats a = frame_of(d, 9), b = frame_of(d, 10), c;
    assert_int_equal(adcgs_dynamic_at(d, 0.999, &c, &error), ADCGS_OK);
    assert_memory_equal(a.mean[0], c.mean[0], N * sizeof(float));
    assert_memory_not_equal(b.mean[0], c.mean[0], N * sizeof(float));
    adcgs_splats_free(&a);
    adcgs_splats_free(&b);
    adcgs_splats_free(&c);
    adcgs_dynamic_free(&d);
}

static void test_threads(void **state)
{
    adcgs_dynamic *d = open_sample(SAMPLE, NULL);
    expect_threads(d);
    adcgs_dynamic_free(&d);
}

/* ---- A made file ---- */

/** The value that a component of a splat must have. */
static double made_value(int a, int i, int c, int frame)
{
    static const double steps[5] = {0.5, 3.0, 9.0, 5.0, 0.5}, bases[5] = {0.25, 1.0, 1.0, 1.0, 0.25};
    const int is_moving = made_moves(a, i);
    const double value = is_moving ? steps[a] * made_bin(a, i, c, frame) : bases[a] * made_base(a, i, c);
    if (a == 0)
        return value;
    if (a == 4)
        return exp(value);
    if (a != 1)
        return fmin(fmax(value, 0.0), 255.0) / 255.0;
    double square = 0.0;
    for (int k = 0; k < 4; k++)
        square += pow(is_moving ? steps[1] * made_bin(1, i, k, frame) : made_base(1, i, k) - 128, 2);
    return (is_moving ? value : value - 128.0) / sqrt(square);
}

/** Every attribute changes, some splats are static in some attributes, and the last group has one frame. */
static void test_made(void **state)
{
    static uint8_t file[MADE_ROOM];
    const size_t bytes = make_splat4d(file);
    adcgs_dynamic *d;
    if (adcgs_dynamic_parse(&d, file, bytes, "made", NULL, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_true(d->n == MADE_N && d->frames == MADE_FRAMES && d->rate.num == 30000 && d->rate.den == 1001);
    for (int k = 0; k < MADE_FRAMES; k++) {
        const int frame = k * 3 % MADE_FRAMES;
        adcgs_splats s;
        if (adcgs_dynamic_at(d, frame / adcgs_fps_value(d->rate), &s, &error) != ADCGS_OK)
            fail_msg("%s", error.text);
        float *const *const arrays[5] = {s.mean, s.rotation, s.colour, &s.opacity, s.scale};
        for (int a = 0; a < 5; a++)
            for (int i = 0; i < MADE_N; i++)
                for (int c = 0; c < made_channels[a]; c++)
                    expect_near((double)arrays[a][c][i], made_value(a, i, c, frame),
                                1e-5 + 1e-6 * fabs(made_value(a, i, c, frame)), adcgs_splat4d_names[a], i);
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&d);
}

/* ---- Faults ---- */

typedef struct file {
    uint8_t *data;
    size_t bytes;
} file;

static file load_sample(void)
{
    file f;
    assert_int_equal(adcgs_file_load(&f.data, &f.bytes, real_data(SAMPLE), 1 << 20, &error), ADCGS_OK);
    return f;
}

/** Replace the first occurrence of a text in the header by another one of the same length. */
static void replace(file *f, const char *from, const char *to)
{
    char *const at = strstr((char *)f->data + 12, from);
    assert_non_null(at);
    assert_int_equal(strlen(from), strlen(to));
    memcpy(at, to, strlen(to));
}

static void test_headers(void **state)
{
    static const struct {
        const char *from, *to;
        const char *first, *second;
    } cases[] = {
        {"\"n\": 2000", "\"n\": 2e03", "no whole number n", "from 1 to"},
        {"\"n\": 2000", "\"m\": 2000", "no whole number n", "from 1 to"},
        {"\"n\": 2000,", "\"n\":999999", "header is not JSON", "byte 15"},
        {"\"n\": 2000,", "\"n\":99999,", "the static section: 250 symbols", "expected 12500"},
        {"\"fps\": 20.0", "\"fps\": -0.5", "no fps", "10000"},
        {"\"pos\": 0.004", "\"pos\": 0.000", "the step pos", "0"},
        {"\"f0\": 10", "\"f0\": 11", "group 1 begins at frame 11", "expected 10"},
        {"\"f1\": 23", "\"f1\": 22", "the groups end at frame 23", "of 24"},
        {"\"f1\": 23", "\"f1\": 24", "no whole number f1", "20 to 23"},
        {"\"len\": 15550", "\"len\": 99999", "the static section at offset 849 with 99999 bytes", "48277"},
        {"\"n\": 2000", "\"n\": 2001", "the static section: 250 symbols", "expected 251"},
    };
    file f = load_sample();
    adcgs_dynamic *d;
    if (!strstr((char *)f.data + 12, "\"n\": 2000")) /* written without blanks */
        fail_msg("the sample's header has another form");
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        replace(&f, cases[i].from, cases[i].to);
        expect_error(adcgs_dynamic_parse(&d, f.data, f.bytes, "x", NULL, &error), ADCGS_ERR_DATA, cases[i].first,
                     cases[i].second);
        replace(&f, cases[i].to, cases[i].from);
    }
    f.data[4] = 2;
    expect_error(adcgs_dynamic_parse(&d, f.data, f.bytes, "x", NULL, &error), ADCGS_ERR_UNSUPPORTED, "version 2", "expected 1");
    free(f.data);
}

/** Streams of groups are checked when a frame of theirs is requested; other groups stay readable. */
static void test_groups(void **state)
{
    static const struct {
        size_t at; /* from the beginning of the second group */
        uint8_t value;
        const char *first, *second;
    } cases[] = {
        {0, 99, "group 1: 12429 bytes with 99 streams", "at most 10"},
        {2, 9, "group 1: a stream of attribute 9", "symbols of 2 bytes"},
        {3, 2, "group 1: positions of kind 2", "expected 0 or 1"},
        {3, 1, "group 1: 1800 symbols of positions", "expected 16200"},
        {5, 9, "group 1: 1801 symbols of positions", "expected 1800"},
        {12, 99, "group 1: positions of", "follow"},
        {68, 0, "positions of group 1", "zstd"},
        {0, 5, "positions of group 1", "zstd"},
    };
    file f = load_sample();
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        uint8_t *const at = f.data + 28602 + cases[i].at, before = *at;
        adcgs_dynamic *d;
        adcgs_splats s;
        *at = cases[i].value;
        assert_int_equal(adcgs_dynamic_parse(&d, f.data, f.bytes, "x", NULL, &error), ADCGS_OK);
        expect_error(adcgs_dynamic_at(d, 0.5, &s, &error), ADCGS_ERR_DATA, cases[i].first, cases[i].second);
        assert_null(s.block);
        assert_int_equal(adcgs_dynamic_at(d, 0.0, &s, &error), ADCGS_OK);
        adcgs_splats_free(&s);
        adcgs_dynamic_free(&d);
        *at = before;
    }
    free(f.data);
}

static void test_damage(void **state)
{
    survive_damage(SAMPLE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frames),  cmocka_unit_test(test_answers), cmocka_unit_test(test_clock),
        cmocka_unit_test(test_threads), cmocka_unit_test(test_headers), cmocka_unit_test(test_groups),
        cmocka_unit_test(test_damage),  cmocka_unit_test(test_made),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

#else

int main(void)
{
    puts("skipped: this build has no zstd");
    return 77;
}

#endif
