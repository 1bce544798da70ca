/* SPDX-License-Identifier: BSD-2-Clause */
/** \file FTGS PLY, of FreeTimeGS. */
#include "dynamic_fixture.h"

#define SCENE SAMPLES "ftgs/scene.ftgs.ply"

static const tolerance most = {1e-5, 1e-5, 1.01e-4, 1e-5, 1e-5}; /* the expected opacities have the floor of 1e-4 */

/** Frame i is at i / 29 of the length, for every clock. */
static void test_scene(void **state)
{
    const adcgs_dynamic_options slow = {.rate = {15, 1}, .frames = 59};
    adcgs_dynamic *d = open_sample(SCENE, NULL);
    assert_true(d->n == 2700 && d->frames == 30 && adcgs_fps_value(d->rate) == 30.0 && d->has_identity && d->is_continuous);
    expect_answers(d, "ftgs", 29.0 / 30.0, &most);
    adcgs_dynamic_free(&d);
    d = open_sample(SCENE, &slow);
    assert_int_equal(d->frames, 59);
    expect_answers(d, "ftgs", 58.0 / 15.0, &most);
    adcgs_dynamic_free(&d);
}

/** All splats of a frame equal those of the player's formulas, besides the floor of opacity. */
static void test_truth(void **state)
{
    static const int frames[] = {0, 10, 29};
    adcgs_dynamic *d = open_sample(SCENE, NULL);
    for (size_t k = 0; k < ADCGS_COUNTOF(frames); k++) {
        char name[64];
        adcgs_splats truth, s;
        snprintf(name, sizeof name, SAMPLES "ftgs/truth/frame_%05d.ply", frames[k]);
        assert_int_equal(adcgs_splats_read(&truth, real_data(name), &error), ADCGS_OK);
        assert_int_equal(adcgs_dynamic_at(d, frames[k] / 30.0, &s, &error), ADCGS_OK);
        assert_true(truth.n == s.n && s.n == d->n);
        for (uint32_t i = 0; i < s.n; i++) {
            const double alpha = (double)truth.opacity[i], floor = 1e-4;
            expect_near((double)s.opacity[i], alpha, alpha < 1.01 * floor ? floor : 1e-5, "alpha", (int)i);
            for (int a = 0; a < 3; a++)
                expect_near((double)s.mean[a][i], (double)truth.mean[a][i], 1e-5, "position", (int)i);
        }
        adcgs_splats_free(&truth);
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&d);
}

static void test_harmonics(void **state)
{
    adcgs_dynamic *d = open_sample(SAMPLES "ftgs/scene_sh1.ftgs.ply", NULL);
    adcgs_splats s, plain;
    expect_answers(d, "ftgs", 29.0 / 30.0, &most);
    assert_int_equal(adcgs_dynamic_at(d, 0.5, &s, &error), ADCGS_OK);
    adcgs_dynamic_free(&d);
    assert_int_equal(s.degree, 1);
    /* An ordinary PLY with the same f_rest columns holds the same harmonics. */
    uint8_t *data;
    size_t bytes;
    char *at;
    assert_int_equal(adcgs_file_load(&data, &bytes, real_data(SAMPLES "ftgs/scene_sh1.ftgs.ply"), 1 << 24, &error), ADCGS_OK);
    assert_non_null(at = strstr((char *)data, "log_duration"));
    memcpy(at, "xxx", 3); /* its name tells it from static splats */
    assert_int_equal(adcgs_splats_parse(&plain, data, bytes, "plain.ply", &error), ADCGS_OK);
    assert_true(plain.degree == 1 && plain.n == s.n);
    assert_memory_equal(plain.harmonics, s.harmonics, (size_t)s.n * 9 * sizeof(float));
    free(data);
    adcgs_splats_free(&plain);
    adcgs_splats_free(&s);
}

/* ---- Headers ---- */

#define SETTINGS "comment time_units normalized\ncomment sh_degree 0\ncomment min_duration 0.02\ncomment opacity_floor 0.0001\n"
#define COLUMNS                                                                                                           \
    "property float x\nproperty float y\nproperty float z\nproperty float f_dc_0\nproperty float f_dc_1\nproperty float " \
    "f_dc_2\nproperty float opacity\nproperty float scale_0\nproperty float scale_1\nproperty float scale_2\nproperty "   \
    "float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3\nproperty float time\nproperty float " \
    "log_duration\n"
#define VELOCITY "property float velocity_0\nproperty float velocity_1\nproperty float velocity_2\n"
#define ROW "1 2 3 0 0 0 0 -1 -1 -1 0 0 0 2 0.5 -9 "

static adcgs_status parse(adcgs_dynamic **out, const char *comments, const char *properties, const char *rows)
{
    static char text[4096];
    const int n =
        snprintf(text, sizeof text, "ply\nformat ascii 1.0\n%selement vertex 1\n%send_header\n%s\n", comments, properties, rows);
    return adcgs_dynamic_parse(out, (uint8_t *)text, (size_t)n, "a.ply", NULL, &error);
}

/** Without use_velocity nothing moves; the shortest duration and 300 frames are those of the player. */
static void test_settings(void **state)
{
    adcgs_dynamic *d;
    adcgs_splats s;
    const adcgs_status status =
        parse(&d, "comment ftgs_version 1\ncomment use_velocity 0\n" SETTINGS, COLUMNS VELOCITY, ROW "5 5 5");
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_int_equal(d->frames, 300);
    const double length = adcgs_dynamic_duration(d);
    assert_int_equal(adcgs_dynamic_at(d, length * 0.52, &s, &error), ADCGS_OK);
    assert_true(s.mean[0][0] == 1.0f && s.rotation[3][0] == 1.0f && s.degree == 0 && !s.harmonics);
    expect_near((double)s.opacity[0], 0.5 * exp(-0.5), 1e-5, "alpha", 0);
    adcgs_splats_free(&s);
    adcgs_dynamic_free(&d);
}

static void test_messages(void **state)
{
    static const struct {
        const char *comments, *properties, *rows, *first, *second;
        adcgs_status status;
    } cases[] = {
        {"comment ftgs_version 2\n", COLUMNS, ROW, "version 2", "expected version 1", ADCGS_ERR_UNSUPPORTED},
        {"comment ftgs_version 2\n", "property float x\n", "1", "version 2", "expected version 1", ADCGS_ERR_UNSUPPORTED},
        {"", COLUMNS, ROW, "a.ply: no comment ftgs_version", "requires", ADCGS_ERR_DATA},
        {"comment ftgs_version 1\ncomment time_units seconds\n", COLUMNS, ROW, "time_units: seconds", "expected normalized",
         ADCGS_ERR_UNSUPPORTED},
        {"comment ftgs_version 1\n" SETTINGS, COLUMNS, ROW, "no comment use_velocity", "requires", ADCGS_ERR_DATA},
        {"comment ftgs_version 1\ncomment use_velocity 0.5\n" SETTINGS, COLUMNS, ROW, "use_velocity: 0.5",
         "a whole number from 0 to 1", ADCGS_ERR_DATA},
        {"comment ftgs_version 1\ncomment use_velocity 1\n" SETTINGS, COLUMNS, ROW, "a.ply: no property velocity_0", "",
         ADCGS_ERR_DATA},
        {"comment ftgs_version 1\ncomment use_velocity 0\n" SETTINGS, COLUMNS "property float f_rest_0\n", ROW "0",
         "it has f_rest_0", "expected 0 harmonics for sh_degree 0", ADCGS_ERR_DATA},
        {"comment ftgs_version 1\ncomment use_velocity 0\n" SETTINGS, COLUMNS, "1 2 3 0 0 0 0 -1 -1 -1 0 0 0 0 0.5 -9", "splat 0",
         "a rotation of length 0", ADCGS_ERR_DATA},
        {"comment ftgs_version 1\ncomment use_velocity 0\n" SETTINGS, COLUMNS, "1 2 3 0 0 0 0 -1 -1 -1 0 0 0 1 0.5 nan",
         "splat 0", "a duration that is not positive", ADCGS_ERR_DATA},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        adcgs_dynamic *d;
        expect_error(parse(&d, cases[i].comments, cases[i].properties, cases[i].rows), cases[i].status, cases[i].first,
                     cases[i].second);
        assert_null(d);
    }
}

static void test_damage(void **state)
{
    survive_damage(SAMPLES "ftgs/scene_sh1.ftgs.ply");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scene),    cmocka_unit_test(test_truth),    cmocka_unit_test(test_harmonics),
        cmocka_unit_test(test_settings), cmocka_unit_test(test_messages), cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
