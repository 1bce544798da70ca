/* SPDX-License-Identifier: BSD-2-Clause */
/** \file params.npz of Dynamic 3D Gaussians. */
#include "dynamic_fixture.h"
#include "npz_files.h"

#define SAMPLE SAMPLES "dynamic3dgaussians/params.npz"

static void expect_frame(const adcgs_dynamic *d, double seconds, const json_t *answer)
{
    adcgs_splats s;
    const uint32_t row = (uint32_t)number_of(answer, "index", 0);
    assert_int_equal(adcgs_dynamic_at(d, seconds, &s, &error), ADCGS_OK);
    assert_true(s.n == d->n && row < s.n);
    for (size_t a = 0; a < 3; a++)
        expect_near((double)s.mean[a][row], number_of(answer, "position", a), 1e-5, "position", (int)row);
    for (uint32_t i = 0; i < s.n; i++) {
        double square = 0.0;
        for (int a = 0; a < 4; a++)
            square += (double)s.rotation[a][i] * (double)s.rotation[a][i];
        expect_near(square, 1.0, 1e-6, "length of the rotation", (int)i);
    }
    /* Splat 0, of round numbers, stands. */
    expect_near((double)s.mean[0][0], -2.0, 1e-6, "x", 0);
    expect_near((double)s.scale[1][0], 0.05, 1e-6, "scale", 0);
    expect_near((double)s.colour[2][0], 0.25, 1e-6, "colour", 0);
    expect_near((double)s.opacity[0], 0.75, 1e-5, "alpha", 0);
    expect_near(fabs((double)s.rotation[3][0]), sqrt(0.5), 1e-6, "rotation", 0);
    adcgs_splats_free(&s);
}

/** Frames begin at i / rate and last until the next one. */
static void test_frames(void **state)
{
    const adcgs_dynamic_options fast = {.rate = {60, 1}, .frames = 3};
    json_t *root, *const answers = json_object_get(expected(&root, "dynamic3dgaussians"), "answers");
    for (int pass = 0; pass < 2; pass++) {
        const double rate = pass ? 60.0 : 30.0;
        adcgs_dynamic *d = open_sample(SAMPLE, pass ? &fast : NULL);
        assert_true(d->n == 1700 && d->frames == 8 && adcgs_fps_value(d->rate) == rate);
        assert_true(d->has_identity && !d->is_continuous);
        for (size_t i = 0; i < json_array_size(answers); i++) {
            const json_t *const answer = json_array_get(answers, i);
            const double frame = number_of(answer, "frame", 0);
            expect_frame(d, frame / rate, answer);
            expect_frame(d, (frame + 0.99) / rate, answer);
        }
        adcgs_dynamic_free(&d);
    }
    json_decref(root);
    assert_true(adcgs_dynamic_is(real_data(SAMPLE)));
}

/* ---- Small files ---- */

static void test_messages(void **state)
{
    static const npz_array good[] = {{"means3D.npy", "(2, 3, 3)", 18, 1.0f},
                                     {"rgb_colors.npy", "(2, 3, 3)", 18, 0.5f},
                                     {"unnorm_rotations.npy", "(2, 3, 4)", 24, 2.0f},
                                     {"log_scales.npy", "(3, 3)", 9, -1.0f},
                                     {"logit_opacities.npy", "(3, 1)", 3, 0.0f}};
    static const struct {
        int which;
        npz_array with;
        const char *first, *second;
    } cases[] = {
        {0, {"means3D.npy", "(3, 3)", 9, 1.0f}, "means3D: header: shape", "expected (frames, n, 3)"},
        {0, {"means3D.npy", "(2, 3, 4)", 24, 1.0f}, "means3D: header: shape", "expected (frames, n, 3)"},
        {0, {"means3D.npy", "(2, 3, 3)", 17, 1.0f}, "68 bytes behind the header", "expected 72 for 6 rows"},
        {0, {"means3D.npy", "(1000000000, 1000000000, 3)", 9, 1.0f}, "1000000000 frames", "fewer than 2^40 rows"},
        {0, {"means3D.npy", "(0, 3, 3)", 0, 1.0f}, "rgb_colors has 2 frames and 6 rows", "expected 0 and 0"},
        {0, {"means3D.npy", "(3, 2, 3)", 18, 1.0f}, "rgb_colors has 2 frames", "expected 3 and 6"},
        {0, {"means3D.npy", "(2, 3, 3)", 18, NAN}, "means3D of splat 0 in frame 0", "is not finite"},
        {1, {"rgb_colors.npy", "(2, 2, 3)", 12, 1.0f}, "rgb_colors has 2 frames and 4 rows", "expected 2 and 6"},
        {1, {NULL, NULL, 0, 0.0f}, "no array rgb_colors", ""},
        {2, {"unnorm_rotations.npy", "(2, 3, 4)", 24, 0.0f}, "unnorm_rotations of splat 0 in frame 0", "or zero"},
        {3, {"log_scales.npy", "(2, 3)", 6, 1.0f}, "log_scales: 2 splats", "expected 3, as in means3D"},
        {3, {"log_scales.npy", "(3, 3)", 9, 100.0f}, "log_scales of splat 0", "too large"},
        {4, {"logit_opacities.npy", "(3, 1)", 3, NAN}, "logit_opacities: splat 0", "not a number"},
        {4, {"logit_opacities.npy", "(3,)", 3, 0.0f}, "logit_opacities: header: shape", "expected (n, 1)"},
    };
    adcgs_dynamic *d;
    for (size_t i = 0; i <= ADCGS_COUNTOF(cases); i++) {
        npz_array arrays[5];
        size_t bytes;
        memcpy(arrays, good, sizeof arrays);
        if (i < ADCGS_COUNTOF(cases))
            arrays[cases[i].which] = cases[i].with;
        uint8_t *const data = make_npz(arrays, 5, &bytes);
        const adcgs_status status = adcgs_dynamic_parse(&d, data, bytes, "a.npz", NULL, &error);
        free(data);
        if (i < ADCGS_COUNTOF(cases)) {
            expect_error(status, ADCGS_ERR_DATA, cases[i].first, cases[i].second);
            assert_null(d);
        }
    }
    adcgs_splats s;
    assert_true(d && d->n == 3 && d->frames == 2);
    assert_int_equal(adcgs_dynamic_at(d, 9.0, &s, &error), ADCGS_OK);
    assert_true(s.opacity[2] == 0.5f && s.rotation[0][1] == 0.5f && s.mean[2][0] == 1.0f);
    adcgs_splats_free(&s);
    adcgs_dynamic_free(&d);
}

static void test_damage(void **state)
{
    survive_damage(SAMPLE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frames),
        cmocka_unit_test(test_messages),
        cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
