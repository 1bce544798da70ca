/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats in PLY: writing, reading and errors. */
#include "ply_splats.h"

#include "media/splats/harmonics.h"
#include "media/splats/splats.h"

#include <adcgs/adcgs.h>

#include <math.h>

/* ---- Files made here ---- */

static void test_read(void **state)
{
    adcgs_splats s;
    put_splats("t.ply", NULL, "z", "double", 0, "2", GOOD "4 5 6 0 0 0 3 0 0 0 1 -1 1 -1\n");
    expect_good(adcgs_splats_read(&s, in("t.ply"), &error));
    assert_true(s.n == 2 && s.degree == 0 && !s.harmonics);
    for (int a = 0; a < 3; a++) {
        const float mean[3] = {1.0f, -2.0f, 0.5f}, f_dc[3] = {0.0f, 1.0f, -1.0f}, log_scale[3] = {0.0f, -1.0f, 1.0f};
        assert_true(s.mean[a][0] == mean[a]);
        assert_true(s.scale[a][0] == (float)exp((double)log_scale[a]));
        assert_true(s.colour[a][0] == (float)(0.5 + 0.28209479177387814 * (double)f_dc[a]));
    }
    assert_true(s.opacity[0] == 0.5f && s.opacity[1] == (float)(1.0 / (1.0 + exp(-3.0))));
    assert_true(s.rotation[0][0] == 1.0f && s.rotation[1][0] == 0.0f); /* 2 0 0 0 */
    assert_true(s.rotation[0][1] == 0.5f && s.rotation[1][1] == -0.5f && s.rotation[3][1] == -0.5f);
    adcgs_primitives p;
    adcgs_splats_primitives(&s, &p);
    assert_int_equal(p.n, 64);
    for (uint32_t i = 2; i < p.n; i++)
        assert_true(p.opacity[i] == 0.0f && p.scale[1][i] > 0.0f && p.rotation[0][i] == 1.0f);
    adcgs_splats_free(&s);
}

static void expect_bad(adcgs_status status, const char *what)
{
    adcgs_splats s;
    expect_error(adcgs_splats_read(&s, in("t.ply"), &error), status, "t.ply", what);
    assert_true(s.n == 0 && !s.block && !s.harmonics);
}

#define BAD(left_out, odd, type, rest, count, lines, what)            \
    do {                                                              \
        put_splats("t.ply", left_out, odd, type, rest, count, lines); \
        expect_bad(ADCGS_ERR_DATA, what);                             \
    } while (0)

static void test_bad(void **state)
{
    adcgs_splats s;
    for (int i = 0; i < NAMES; i++)
        if (i != 9) /* scale_2 */
            BAD(names[i], NULL, NULL, 0, "1", GOOD, names[i]);
    BAD("opacity", NULL, NULL, 0, "1", GOOD, "no property opacity");
    for (int i = 0; i < NAMES; i++)
        BAD(NULL, names[i], "uchar", 0, "1", GOOD, "of type uchar, expected float");
    BAD(NULL, "rot_1", "list uchar float", 0, "1", GOOD, "no property rot_1");
    BAD(NULL, NULL, NULL, 1, "1", GOOD, "1 properties f_rest_*, expected none, 9, 24 or 45");
    BAD(NULL, NULL, NULL, 44, "1", GOOD GOOD GOOD GOOD, "44 properties f_rest_*");
    BAD(NULL, NULL, NULL, 0, "0", "", "no splats");
    BAD(NULL, NULL, NULL, 0, "3", GOOD, "bytes follow");
    BAD(NULL, NULL, NULL, 0, "2", GOOD "1 2 3 4 5 6 7 8.88888 9.99999 10", "ends in item 1 of 2");
    BAD(NULL, NULL, NULL, 0, "4000000000", GOOD, "bytes follow");
    BAD(NULL, NULL, NULL, 0, "18446744073709551615", GOOD, "bytes follow");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 nan 0 0 0 0 0 0 0 1 0 0 0\n", "vertex 0: z is not a finite number");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 inf 0 0 0 0 0 0 0 1 0 0 0\n", "vertex 0: z is not a finite number");
    BAD(NULL, NULL, NULL, 0, "2", GOOD "1 2 3 0 0 0 nan 0 0 0 1 0 0 0\n", "vertex 1: opacity is not a finite number");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 3 0 0 0 0 0 nan 0 1 0 0 0\n", "vertex 0: scale_1 is not a finite number");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 3 0 0 0 0 0 inf 0 1 0 0 0\n", "vertex 0: scale_1 is not a finite number");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 3 0 -inf 0 0 0 0 0 1 0 0 0\n", "vertex 0: f_dc_1 is not a finite number");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 3 0 0 0 0 0 0 0 1 -inf 0 0\n", "vertex 0: rot_1 is not a finite number");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 1e39 0 0 0 0 0 0 0 1 0 0 0\n", "vertex 0: z is not a finite number");
    BAD(NULL, NULL, NULL, 9, "1", "1 2 3 0 0 0 0 0 0 0 1 0 0 0 0 0 0 0 0 nan 0 0 0\n", "f_rest_5 is not a finite number");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 3 0 0 0 0 0 81 0 1 0 0 0\n", "scale_1 is 81");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 3 0 0 0 0 0 0 0 0 0 0 0\n", "rot_0..3 are all zero");
    BAD(NULL, NULL, NULL, 0, "1", "1 2 3 0 0 0 0 0 zero 0 1 0 0 0\n", "expected a number");
    put_text("t.ply", "");
    expect_bad(ADCGS_ERR_DATA, "not splats");
    put_text("t.ply", "ply\n");
    expect_bad(ADCGS_ERR_DATA, "ends early");
    put_text("t.ply", "ply\nformat binary_little_endian 1.0\nelement chunk 1\nproperty float min_x\nelement vertex 1\n"
                      "property uint packed_position\nproperty uint packed_rotation\nend_header\n............");
    expect_bad(ADCGS_ERR_DATA, "compressed splats without the property min_y of the element chunk");
    expect_error(adcgs_splats_read(&s, in("absent.ply"), &error), ADCGS_ERR_IO, "absent.ply", "No such file");
    expect_error(adcgs_splats_alloc(&s, ADCGS_SPLATS_MAX + 1ull, "many", &error), ADCGS_ERR_DATA, "many", "at most 16777216");
}

static void test_round_trip(void **state)
{
    adcgs_splats s = random_splats(1000, 30.0, -500.0, 3), back;
    expect_good(write_splats(&s, in("w.ply")));
    expect_good(adcgs_splats_read(&back, in("w.ply"), &error));
    same_splats(&back, &s, OPACITY_ERROR, SCALE_ERROR);
    adcgs_splats_free(&back);
    s.opacity[7] = 1.0f;
    expect_error(write_splats(&s, in("w2.ply")), ADCGS_ERR_UNSUPPORTED, "w2.ply", "splat 7");
    assert_true(access(in("w2.ply"), F_OK) != 0);
    s.opacity[7] = 0.5f;
    expect_error(write_splats(&s, in("no/w.ply")), ADCGS_ERR_IO, "no/w.ply", "No such");
    adcgs_splats_free(&s);
}

/** f_rest_* for programs that require them: zeros, which reading drops. */
static void test_rest(void **state)
{
    static const size_t rest[] = {0, 9, 24, 45};
    adcgs_splats s = random_splats(20, 1.0, 0.0, 4), back;
    for (int degree = 0; degree <= 3; degree++) {
        const adcgs_splats_style style = {.comment = "here", .rest_degree = degree};
        size_t bytes;
        expect_good(adcgs_splats_write(&s, &style, in("r.ply"), &error));
        uint8_t *const file = load_file("r.ply", &bytes);
        size_t header = 0;
        while (header + 11 < bytes && memcmp(file + header, "end_header\n", 11))
            header++;
        assert_int_equal(bytes, header + 11 + 4 * 20 * (17 + rest[degree]));
        assert_true(!degree == !strstr((char *)file, "property float f_dc_2\nproperty float f_rest_0\n"));
        free(file);
        expect_good(adcgs_splats_read(&back, in("r.ply"), &error));
        assert_true(back.degree == 0 && !back.harmonics);
        same_splats(&back, &s, OPACITY_ERROR, SCALE_ERROR);
        adcgs_splats_free(&back);
    }
    adcgs_splats_free(&s);
}

/** The bytes of a file are those of the layout, property by property. */
static void test_layout(void **state)
{
    static const char header[] =
        "ply\nformat binary_little_endian 1.0\ncomment here\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float f_dc_0\n"
        "property float f_dc_1\nproperty float f_dc_2\nproperty float opacity\nproperty float scale_0\n"
        "property float scale_1\nproperty float scale_2\n"
        "property float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3\nend_header\n";
    const float dc = (float)(0.5 / 0.28209479177387814);
    const float expected[17] =
        {1.0f, -2.0f, 3.0f, 0.0f, 0.0f, 0.0f, 0.0f, dc, -dc, (float)log(3.0), 0.0f, (float)log(2.0), (float)log(0.25),
         0.5f, -0.5f, 0.5f, 0.5f};
    adcgs_splats s;
    char bytes[sizeof header + sizeof expected + 1];
    expect_good(adcgs_splats_alloc(&s, 1, "one", &error));
    const float mean[3] = {1.0f, -2.0f, 3.0f}, scale[3] = {1.0f, 2.0f, 0.25f}, colour[3] = {0.5f, 1.0f, 0.0f};
    for (int a = 0; a < 3; a++) {
        *s.mean[a] = mean[a];
        *s.scale[a] = scale[a];
        *s.colour[a] = colour[a];
    }
    *s.opacity = 0.75f;
    for (int a = 0; a < 4; a++)
        *s.rotation[a] = a == 1 ? -0.5f : 0.5f;
    expect_good(write_splats(&s, in("one.ply")));
    adcgs_splats_free(&s);
    FILE *file = fopen(in("one.ply"), "rb");
    assert_non_null(file);
    assert_int_equal(fread(bytes, 1, sizeof bytes, file), sizeof header - 1 + sizeof expected);
    fclose(file);
    assert_memory_equal(bytes, header, sizeof header - 1);
    for (size_t i = 0; i < 17; i++)
        assert_true(adcgs_bits_float(adcgs_load_le32((const uint8_t *)bytes + sizeof header - 1 + 4 * i)) == expected[i]);
}

/** Replaces one byte of a good file at a time. Any outcome is valid but a crash, and an error is one line. */
static void test_mutations(void **state)
{
    adcgs_splats s = random_splats(2, 1.0, 0.0, 5);
    uint8_t good[2048], bytes[2048];
    expect_good(write_splats(&s, in("m.ply")));
    adcgs_splats_free(&s);
    FILE *file = fopen(in("m.ply"), "rb");
    assert_non_null(file);
    const size_t n = fread(good, 1, sizeof good, file);
    fclose(file);
    assert_true(n > 100 && n < sizeof good);
    for (size_t i = 0; i < n; i++)
        for (int v = 0; v < 256; v += 5) {
            memcpy(bytes, good, n);
            bytes[i] = (uint8_t)v;
            bytes[n] = 0;
            const adcgs_status status = adcgs_splats_parse(&s, bytes, n, "mutant", &error);
            assert_true(status == ADCGS_OK || !strncmp(error.text, "mutant: ", 8));
            adcgs_splats_free(&s);
        }
    for (size_t cut = 0; cut < n; cut++) {
        memcpy(bytes, good, cut);
        bytes[cut] = 0;
        expect_error(adcgs_splats_parse(&s, bytes, cut, "cut", &error), ADCGS_ERR_DATA, "cut: ", "");
    }
}

/* ---- View-dependent colours ---- */

/** Orthonormal over the sphere; the first three have the usual signs. */
static void test_harmonics(void **state)
{
    enum { STEPS = 64 };
    double product[15][15] = {{0}}, mean[15] = {0};
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < 2 * STEPS; j++) {
            const double h = cos(M_PI * (i + 0.5) / STEPS), r = sqrt(1 - h * h), angle = M_PI * (j + 0.5) / STEPS;
            const double d[3] = {r * cos(angle), r * sin(angle), h}, area = r * M_PI * M_PI / (STEPS * STEPS);
            double y[15];
            adcgs_harmonics(y, d, 3);
            for (int a = 0; a < 15; a++) {
                mean[a] += area * y[a];
                for (int b = 0; b < 15; b++)
                    product[a][b] += area * y[a] * y[b];
            }
        }
    for (int a = 0; a < 15; a++) {
        assert_true(fabs(mean[a]) < 1e-3);
        for (int b = 0; b < 15; b++)
            assert_true(fabs(product[a][b] - (a == b)) < 2e-3);
    }
    const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    double out[15];
    adcgs_harmonics(out, x, 1);
    assert_true(fabs(out[2] + sqrt(0.75 / M_PI)) < 1e-12 && out[1] == 0.0);
    adcgs_harmonics(out, y, 1);
    assert_true(fabs(out[0] + sqrt(0.75 / M_PI)) < 1e-12);
    adcgs_harmonics(out, z, 1);
    assert_true(fabs(out[1] - sqrt(0.75 / M_PI)) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_read),       cmocka_unit_test(test_bad),  cmocka_unit_test(test_layout),
        cmocka_unit_test(test_round_trip), cmocka_unit_test(test_rest), cmocka_unit_test(test_mutations),
        cmocka_unit_test(test_harmonics),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
