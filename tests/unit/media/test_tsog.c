/* SPDX-License-Identifier: BSD-2-Clause */
/** \file TSOG: continuous, discrete and static splats. */
#include "dynamic_fixture.h"

#ifdef HAVE_SOG

#include <zlib.h>

#define CONTINUOUS SAMPLES "tsog/continuous16.tsog"
#define DISCRETE SAMPLES "tsog/discrete.tsog"

static const tolerance most = {2e-5, 2e-5, 2e-5, 1e-5, 1e-5};

static void test_continuous(void **state)
{
    static const struct {
        const char *file, *name;
        double rate;
    } cases[] = {{CONTINUOUS, "tsog_continuous16", 30.0}, {SAMPLES "tsog/continuous8.tsog", "tsog_continuous8", 24.0}};
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        adcgs_dynamic *d = open_sample(cases[i].file, NULL);
        assert_true(d->n == 2700 && d->frames == ADCGS_DYNAMIC_FRAMES && adcgs_fps_value(d->rate) == cases[i].rate);
        assert_true(d->has_identity && d->is_continuous && !*d->remark);
        expect_answers(d, cases[i].name, adcgs_dynamic_duration(d), &most);
        adcgs_dynamic_free(&d);
    }
    assert_true(adcgs_dynamic_is(real_data(CONTINUOUS)));
    assert_true(adcgs_dynamic_is(real_data(DISCRETE))); /* over 64 KiB: the directory is beyond the first bytes */
    assert_false(adcgs_dynamic_is(real_data(SAMPLES "sog/demo_t0.5.sog")));
}

/** Splats of each of eight frames; a frame begins at i / 10 seconds. */
static void test_discrete(void **state)
{
    const adcgs_dynamic_options options = {.frames = 3};
    adcgs_dynamic *d = open_sample(DISCRETE, &options);
    json_t *root, *const sample = expected(&root, "tsog_discrete"), *const counts = json_object_get(sample, "frame_counts"),
                         *const answers = json_object_get(sample, "answers");
    assert_true(d->frames == 8 && d->n == 810 && adcgs_fps_value(d->rate) == 10.0 && !d->has_identity && !d->is_continuous);
    assert_int_equal(json_array_size(counts), 8);
    for (size_t i = 0; i < 16; i++) {
        adcgs_splats s;
        assert_int_equal(adcgs_dynamic_at(d, 0.05 * (double)i, &s, &error), ADCGS_OK);
        assert_int_equal(s.n, json_integer_value(json_array_get(counts, i / 2)));
        if (i == 0) /* the first frame has the first splats of the file */
            expect_splat(&s, 0, json_array_get(json_object_get(json_array_get(answers, 0), "splats"), 0), &most);
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&d);
    json_decref(root);
}

/* ---- Changed samples ---- */

/** Where bytes begin in others; a failure without them. */
static size_t place(const uint8_t *data, size_t bytes, const char *text, size_t n)
{
    for (size_t i = 0; i + n <= bytes; i++)
        if (!memcmp(data + i, text, n))
            return i;
    fail_msg("no %s", text);
    return 0;
}

/** A sample, whose files are stored, with another text of the same length in its meta.json. */
static adcgs_status parse(adcgs_dynamic **out, const char *name, const char *from, const char *to,
                          const adcgs_dynamic_options *options)
{
    uint8_t *data;
    size_t bytes;
    assert_int_equal(strlen(from), strlen(to));
    assert_int_equal(adcgs_file_load(&data, &bytes, real_data(name), 1 << 24, &error), ADCGS_OK);
    memcpy(data + place(data, bytes, from, strlen(from)), to, strlen(to));
    const size_t entry = place(data, bytes, "PK\1\2", 4), meta = 30 + strlen("meta.json"); /* it is the first file */
    assert_memory_equal(data + 30, "meta.json", 9);
    adcgs_store_le32(data + entry + 16, (uint32_t)crc32(0, data + meta, adcgs_load_le32(data + entry + 24)));
    const adcgs_status status = adcgs_dynamic_parse(out, data, bytes, "a.tsog", options, &error);
    free(data);
    return status;
}

/** A stated duration is the unit of time. */
static void test_duration(void **state)
{
    static const char *const from = "\"profile\": {\"id\": \"org.opsiclear.tsog-playback\", \"version\": 1}";
    static const char *const to = "\"playback\": {\"duration\": 2.5, \"fps\": 24}, \"audio\": {}         ";
    const adcgs_dynamic_options fast = {.rate = {60, 1}};
    adcgs_dynamic *d;
    for (int pass = 0; pass < 2; pass++) {
        const adcgs_status status = parse(&d, CONTINUOUS, from, to, pass ? &fast : NULL);
        if (status != ADCGS_OK)
            fail_msg("%s", error.text);
        assert_true(d->frames == (pass ? 150 : 60) && strstr(d->remark, "sound"));
        json_t *root, *const answers = json_object_get(expected(&root, "tsog_continuous16"), "answers");
        adcgs_splats s;
        assert_int_equal(adcgs_dynamic_at(d, 2.5 * 0.25, &s, &error), ADCGS_OK);
        expect_splat(&s, 1203, json_array_get(json_object_get(json_array_get(answers, 1), "splats"), 1), &most);
        adcgs_splats_free(&s);
        json_decref(root);
        adcgs_dynamic_free(&d);
    }
    assert_int_equal(parse(&d, DISCRETE, from, to, NULL), ADCGS_OK);
    expect_near(adcgs_fps_value(d->rate), 8 / 2.5, 1e-9, "rate", 0);
    adcgs_dynamic_free(&d);
}

/** Without a timeline, the splats of all frames stand in one. */
static void test_static(void **state)
{
    adcgs_dynamic *d;
    adcgs_splats s;
    const adcgs_status status = parse(&d, DISCRETE, "\"timeline\"", "\"other   \"", NULL);
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_true(d->n == 6936 && d->frames == 1 && d->has_identity && !d->is_continuous);
    assert_int_equal(adcgs_dynamic_at(d, 0.0, &s, &error), ADCGS_OK);
    assert_true(s.n == 6936 && s.opacity[0] > 0.7f);
    adcgs_splats_free(&s);
    adcgs_dynamic_free(&d);
}

static void test_messages(void **state)
{
    static const struct {
        const char *file, *from, *to, *first, *second;
        adcgs_status status;
    } cases[] = {
        {CONTINUOUS, "\"version\": 4", "\"version\": 5", "TSOG of version 5", "expected 4", ADCGS_ERR_UNSUPPORTED},
        {CONTINUOUS, "playback\", \"version\": 1", "playback\", \"version\": 2", "tsog-playback version 2", "version 1",
         ADCGS_ERR_UNSUPPORTED},
        {CONTINUOUS, "\"type\": 1", "\"type\": 2", "timeline of type 2", "expected 0", ADCGS_ERR_UNSUPPORTED},
        {CONTINUOUS, "\"type\": 1", "\"t\":    1", "timeline: expected type", "", ADCGS_ERR_DATA},
        {CONTINUOUS, "{\"means\": {\"mins\": [[", "{\"quats\": {\"mins\": [[", "temporal.quats", "expected only temporal.means",
         ADCGS_ERR_UNSUPPORTED},
        {CONTINUOUS, "\"mins\": [[0.0,", "\"mins\": [0.0,[", "meta.json: temporal.means", "three numbers", ADCGS_ERR_DATA},
        {CONTINUOUS, "\"timeline\"", "\"other   \"", "meta.json: temporal", "a continuous timeline", ADCGS_ERR_DATA},
        {CONTINUOUS, "[0.0, 0.02]", "[0.0, -0.2]", "timeline", "not negative", ADCGS_ERR_DATA},
        {CONTINUOUS, "[0.0, 0.02]", "[0.0      ]", "timeline", "two numbers", ADCGS_ERR_DATA},
        {CONTINUOUS, "[\"timeline_l.webp\", \"timeline_u.webp\"]", "[\"timeline_l.webp\"                   ]",
         "timeline: expected files", "two images", ADCGS_ERR_DATA},
        {CONTINUOUS, "[\"motion_l.webp\"", "[\"motion_x.webp\"", "no file motion_x.webp", "", ADCGS_ERR_DATA},
        {CONTINUOUS, "\"fps\": 30", "\"fps\":-30", "fps: expected a number from", "", ADCGS_ERR_DATA},
        {CONTINUOUS, "\"count\": 2700", "\"count\": 9999", "pixels, expected one for each of 9999", "", ADCGS_ERR_DATA},
        {DISCRETE, "\"N\": 8", "\"N\": 0", "timeline: expected N", "frames", ADCGS_ERR_DATA},
        {DISCRETE, "\"delta\": 8192", "\"delta\": 0   ", "timeline: expected delta", "", ADCGS_ERR_DATA},
    };
    adcgs_dynamic *d;
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        expect_error(parse(&d, cases[i].file, cases[i].from, cases[i].to, NULL), cases[i].status, cases[i].first,
                     cases[i].second);
        assert_null(d);
    }
}

static void test_damage(void **state)
{
    survive_damage(CONTINUOUS);
    survive_damage(DISCRETE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_continuous), cmocka_unit_test(test_discrete), cmocka_unit_test(test_duration),
        cmocka_unit_test(test_static),     cmocka_unit_test(test_messages), cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

#else

int main(void)
{
    print_message("skipped: this build reads no SOG\n");
    return 77;
}

#endif
