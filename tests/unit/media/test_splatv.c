/* SPDX-License-Identifier: BSD-2-Clause */
/** \file .splatv, with values rounded to binary16, and blocks of other types. */
#include "dynamic_fixture.h"

static const tolerance most = {2e-5, 2e-5, 2e-5, 1e-5, 1e-5};

/** Of 2048 stored splats, the 48 of padding are dropped. */
static void test_scene(void **state)
{
    const adcgs_dynamic_options clip = {.frames = 24, .rate = {24, 1}};
    adcgs_dynamic *d = open_sample(SAMPLES "splatv/scene.splatv", &clip);
    assert_true(d->n == 2000 && d->frames == 24 && d->has_identity && d->is_continuous);
    expect_answers(d, "splatv", 1.0, &most);
    adcgs_dynamic_free(&d);
}

/** The position of splat 0 of a PLY among those of a state; -1 without it. */
static int find_splat(const adcgs_splats *s, const adcgs_splats *of, uint32_t row)
{
    for (uint32_t i = 0; i < s->n; i++)
        if (s->mean[0][i] == of->mean[0][row] && s->mean[1][i] == of->mean[1][row] && s->mean[2][i] == of->mean[2][row])
            return (int)i;
    return -1;
}

/** A sequence in disguise: at the time of its first frame, a file of ply-to-splatv shows the splats of that frame. */
static void test_sequence(void **state)
{
    const adcgs_dynamic_options clip = {.frames = 6, .rate = {5, 1}};
    adcgs_dynamic *d = open_sample(SAMPLES "splatv_real/hanabi2.splatv", &clip);
    adcgs_splats s, frame;
    assert_int_equal(d->n, 24000);
    assert_int_equal(adcgs_dynamic_at(d, 0.0, &s, &error), ADCGS_OK);
    assert_int_equal(adcgs_splats_read(&frame, real_data(SAMPLES "splatv_real/frame_000.ply"), &error), ADCGS_OK);
    for (uint32_t row = 0; row < frame.n; row += 371) {
        const int i = find_splat(&s, &frame, row);
        assert_true(i >= 0);
        expect_near((double)s.opacity[i], (double)frame.opacity[row], 1.0 / 255, "alpha", (int)row);
        expect_near((double)s.colour[0][i], fmin(fmax((double)frame.colour[0][row], 0.0), 1.0), 1.0 / 255, "colour", (int)row);
    }
    adcgs_splats_free(&frame);
    adcgs_splats_free(&s);
    /* The last frame, whose centre is 1, is seen whole. */
    double sum = 0.0;
    assert_int_equal(adcgs_dynamic_at(d, 1.0, &s, &error), ADCGS_OK);
    for (uint32_t i = 0; i < s.n; i++)
        sum += (double)s.opacity[i];
    expect_near(sum, 894.118, 0.01, "sum of opacities", -1); /* 101.7 at 5/6, where 5 / frames would be */
    adcgs_splats_free(&s);
    adcgs_dynamic_free(&d);
}

/* ---- Small files ---- */

/** A file with the text and the splats, each of 16 words. */
static adcgs_status parse(adcgs_dynamic **out, const char *text, const uint32_t (*splats)[16], size_t n)
{
    static uint8_t data[2048];
    const size_t length = strlen(text);
    adcgs_store_le32(data, 0x674b);
    adcgs_store_le32(data + 4, (uint32_t)length);
    memcpy(data + 8, text, length);
    for (size_t i = 0; i < 16 * n; i++)
        adcgs_store_le32(data + 8 + length + 4 * i, splats[i / 16][i % 16]);
    return adcgs_dynamic_parse(out, data, 8 + length + 64 * n, "a.splatv", NULL, &error);
}

#define ONE 0x3c00u       /* binary16 */
#define ENDLESS 0x7c00u   /* infinite */
#define CLEAR 0x80ffffffu /* white, alpha 128 */

/** Blocks of other types are skipped, padding too; infinite durations never end, scales that became 0 are flat. */
static void test_blocks(void **state)
{
    const uint32_t words[][16] = {
        {0},
        {0, 0, 0x3f800000, ONE, 0, ONE << 16, ONE, CLEAR, [15] = ENDLESS << 16 | ONE},
        {0},
        {0, 0, 0x3f800000, ONE, 0, ONE, ONE, 0x00ffffff, [15] = ONE << 16},
    };
    adcgs_dynamic *d;
    const adcgs_status status =
        parse(&d, "[{\"type\":\"x\",\"size\":64},{\"type\":\"splat\",\"size\":192},{\"type\":\"y\",\"size\":0}]", words, 4);
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
    for (int i = 0; i < 3; i++) {
        adcgs_splats s;
        assert_int_equal(adcgs_dynamic_at(d, 0.5 * i, &s, &error), ADCGS_OK);
        assert_true(s.n == 1 && s.mean[2][0] == 1.0f && s.scale[1][0] == 1.0f && s.rotation[0][0] == 1.0f);
        assert_true(s.scale[0][0] > 0.0f && s.scale[0][0] < 1e-7f);
        expect_near((double)s.opacity[0], 128.0 / 255, 1e-6, "alpha", 0);
        adcgs_splats_free(&s);
    }
    adcgs_dynamic_free(&d);
}

static void test_messages(void **state)
{
    const uint32_t words[][16] = {{0, 0, 0, ONE, 0, ONE, ONE, CLEAR, [15] = ONE << 16}, {0}};
    const uint32_t bad[][16] = {{0x7fc00000, 0, 0, ONE, 0, ONE, ONE, CLEAR, [15] = ONE << 16}};
    static const struct {
        const char *text, *first, *second;
        adcgs_status status;
    } cases[] = {
        {"[{\"type\":\"splat\",\"size\":64}", "a.splatv: line 1", "malformed JSON", ADCGS_ERR_DATA},
        {"{}", "not a list", "expected one of blocks", ADCGS_ERR_DATA},
        {"[]", "no block of type splat", "", ADCGS_ERR_DATA},
        {"[{\"type\":\"splat\"}]", "block 0", "expected a type and a size", ADCGS_ERR_DATA},
        {"[{\"type\":\"splat\",\"size\":192}]", "block 0 has 192 bytes", "but 128 follow", ADCGS_ERR_DATA},
        {"[{\"type\":\"splat\",\"size\":65}]", "block 0", "whole splats, of 64 bytes", ADCGS_ERR_DATA},
        {"[{\"type\":\"splat\",\"size\":64},{\"type\":\"splat\",\"size\":64}]", "block 1", "a second one", ADCGS_ERR_UNSUPPORTED},
        {"[{\"type\":\"x\",\"size\":64},{\"type\":\"splat\",\"size\":64}]", "no visible splat among 1", "", ADCGS_ERR_DATA},
    };
    adcgs_dynamic *d;
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++)
        expect_error(parse(&d, cases[i].text, words, 2), cases[i].status, cases[i].first, cases[i].second);
    expect_error(parse(&d, "[{\"type\":\"splat\",\"size\":64}]", bad, 1), ADCGS_ERR_DATA, "splat 0", "not finite");
    assert_null(d);
}

static void test_damage(void **state)
{
    survive_damage(SAMPLES "splatv/scene.splatv");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scene),    cmocka_unit_test(test_sequence), cmocka_unit_test(test_blocks),
        cmocka_unit_test(test_messages), cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
