/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats in compressed PLY: known values of files of other programs, all features in made files, errors, damage. */
#include "splat_bytes.h"
#include "splat_damage.h"

static void test_packed_samples(void **state)
{
    const tolerance most = {1.5e-3, 3e-3, 2.5e-3, 1e-3, 1.5e-3};
    expect_state("splats4d/compressed_frames/scene000.compressed.ply", "compressed_frames", 0, &most);
    expect_state("splats4d/compressed_frames/scene002.compressed.ply", "compressed_frames", 1, &most);
}

/** One scene by two programs, in the same order. SPZ is turned by half a turn about x. */
static void test_biker(void **state)
{
    double mean = 0.0, rotation = 0.0, opacity = 0.0, scale = 0.0, colour = 0.0;
    adcgs_splats s = open_splats(real_data("splats/biker.compressed.ply")), z;
    if (adcgs_splats_read(&z, real_data("splats/biker.spz"), &error) == ADCGS_ERR_UNSUPPORTED)
        skip();
    assert_true(s.n == 152746 && z.n == s.n);
    for (uint32_t i = 0; i < s.n; i++) {
        double dot = 0.0;
        for (int a = 0; a < 3; a++) {
            mean = fmax(mean, fabs((double)s.mean[a][i] - (a ? -1.0 : 1.0) * (double)z.mean[a][i]));
            scale += fabs(log((double)s.scale[a][i] / (double)z.scale[a][i])) / (3.0 * s.n);
            colour += fabs((double)s.colour[a][i] - (double)z.colour[a][i]) / (3.0 * s.n);
        }
        for (int a = 0; a < 4; a++)
            dot += (a > 1 ? -1.0 : 1.0) * (double)s.rotation[a][i] * (double)z.rotation[a][i];
        rotation += (1.0 - fabs(dot)) / s.n;
        opacity = fmax(opacity, fabs((double)s.opacity[i] - (double)z.opacity[i]));
    }
    assert_true(mean < 1.3e-4 && opacity < 1e-6 && scale < 0.016 && colour < 2e-3 && rotation < 1e-6); /* half of SPZ's steps */
    adcgs_splats_free(&s);
    adcgs_splats_free(&z);
}

/** A compressed PLY file with two splats; of these bounds of colours (0: none) and of harmonics of this degree. */
static void make_packed(made_file *b, int colours, int degree, const char *chunks)
{
    static const char *const names[] = {"min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
                                        "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
                                        "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};
    static const double values[] = {-1, 0, 10, 1, 4, 12, -4, -3, -2, 0, 0, 0, -1, 0, 0, 1, 1, 2};
    const int n_rest = 3 * ((degree + 1) * (degree + 1) - 1), n = colours ? 18 : 12;
    char text[4096];
    int at = snprintf(text, sizeof text, "ply\nformat binary_little_endian 1.0\ncomment offset 100 0 0\n%s\n", chunks);
    for (int i = 0; i < n; i++)
        at += snprintf(text + at, sizeof text - (size_t)at, "property float %s\n", names[i]);
    at += snprintf(text + at, sizeof text - (size_t)at,
                   "element vertex 2\nproperty uint packed_position\nproperty uint packed_rotation\nproperty uint packed_scale\n"
                   "property uint packed_color\n");
    if (degree)
        at += snprintf(text + at, sizeof text - (size_t)at, "element sh 2\n");
    for (int i = 0; i < n_rest; i++)
        at += snprintf(text + at, sizeof text - (size_t)at, "property uchar f_rest_%d\n", i);
    at += snprintf(text + at, sizeof text - (size_t)at, "end_header\n");
    b->n = 0;
    put(b, text, (size_t)at);
    for (int i = 0; i < n; i++)
        put_real(b, values[i]);
    put32(b, 0x000ffc00u | 2047); /* least, 511 of 1023, largest */
    put32(b, 1u << 30 | 512u << 20 | 0u << 10 | 1023u);
    put32(b, 0xffe00000u | 2047);
    put32(b, 0xff00ff33u);
    put32(b, 0xffffffffu);
    put32(b, 3u << 30);
    put32(b, 0);
    put32(b, 0x00000000u);
    for (int i = 0; i < 2 * n_rest; i++)
        put(b, (uint8_t[]){(uint8_t)(i == 0 ? 0 : i == 1 ? 255 : 100 + i)}, 1);
}

static void expect_packed(const adcgs_splats *s, int colours, int degree)
{
    const double q[4] = {(512 / 1023.0 - 0.5) * sqrt(2.0), 0.0, -sqrt(0.5), sqrt(0.5)};
    assert_true(s->n == 2 && s->degree == degree && s->offset[0] == 100.0);
    near(s->mean[0][0], -1.0f, 0, 1e-6);
    near(s->mean[1][0], (float)(4 * 511 / 1023.0), 0, 1e-6);
    near(s->mean[2][0], 12.0f, 0, 1e-6);
    near(s->mean[0][1], 1.0f, 0, 1e-6);
    near(s->scale[0][0], 1.0f, 0, 1e-6);
    near(s->scale[1][0], (float)exp(-3), 0, 1e-6);
    near(s->scale[2][0], 1.0f, 0, 1e-6);
    for (int a = 0; a < 4; a++)
        near(s->rotation[a][0], (float)q[a], 0, 1e-3);
    near(s->rotation[0][1], -0.577350f, 0, 1e-6); /* three of the smallest components, longer than a unit together */
    near(s->rotation[3][1], 0.0f, 0, 1e-6);
    near(s->opacity[0], 0.2f, 0, 1e-6);
    near(s->opacity[1], 0.0f, 0, 0);
    near(s->colour[0][0], 1.0f, 0, 1e-6);
    near(s->colour[1][0], 0.0f, 0, 1e-6);
    near(s->colour[2][0], colours ? 2.0f : 1.0f, 0, 1e-6);
    near(s->colour[0][1], colours ? -1.0f : 0.0f, 0, 1e-6);
    if (degree) {
        near(s->harmonics[0], -4.0f, 0, 1e-6);
        near(s->harmonics[1], 4.0f, 0, 1e-6);
        near(s->harmonics[2], (float)(8 * (102.5 / 256 - 0.5)), 0, 1e-6);
    }
}

static void test_packed_numbers(void **state)
{
    static made_file b;
    adcgs_splats s;
    for (int colours = 0; colours < 2; colours++)
        for (int degree = 0; degree <= 3; degree++) {
            make_packed(&b, colours, degree, "element chunk 1");
            expect_good(parse(&s, &b));
            expect_packed(&s, colours, degree);
            adcgs_splats_free(&s);
        }
    make_packed(&b, 1, 1, "comment antialiased 1\nelement chunk 1");
    damage(b.data, b.n, 1024);
    expect_good(parse(&s, &b));
    assert_int_equal(s.antialiased, 1);
    adcgs_splats_free(&s);
}

static void replace(made_file *b, const char *from, const char *to)
{
    const size_t n = strlen(from);
    assert_int_equal(n, strlen(to));
    for (size_t i = 0; i + n < b->n; i++)
        if (!memcmp(b->data + i, from, n)) {
            memcpy(b->data + i, to, n);
            return;
        }
    fail_msg("no %s", from);
}

static void test_packed_faults(void **state)
{
    static const struct {
        const char *chunks, *from, *to, *text;
    } cases[] = {
        {"element chunk 1", "max_b", "max_a", "without the property max_b of the element chunk"},
        {"element chunk 1", "packed_scale", "packed_skale", "without the property packed_scale of the element vertex"},
        {"element chunk 1", "uint packed_color", " int packed_color", "packed_color is of type int, expected uint"},
        {"element chunk 1", "f_rest_8", "f_rest_9", "8 properties f_rest_*, expected none, 9, 24 or 45"},
        {"element chunk 1", "element sh 2", "element sh 1", "harmonics of 1 splats, expected 2"},
        {"element chunk 1", "element chunk", "element chank", "0 items of the element chunk, expected 1"},
        {"element chunk 1", "element vertex 2", "element vertex 0", "no splats"},
        {"element chunk 0", "ply", "ply", "0 items of the element chunk, expected 1"},
        {"element chunk 99999999", "ply", "ply", "items declared, but only"},
    };
    static made_file b;
    adcgs_splats s;
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        make_packed(&b, 1, 1, cases[i].chunks);
        replace(&b, cases[i].from, cases[i].to);
        expect_error(parse(&s, &b), ADCGS_ERR_DATA, "file: ", cases[i].text);
    }
}

static void test_splat_transform(void **state)
{
    static made_file b;
    need_splat_transform();
    for (int degree = 1; degree <= 3; degree++) {
        make_packed(&b, 1, degree, "element chunk 1");
        put_bytes("p.compressed.ply", b.data, b.n);
        expect_as_splat_transform("p.compressed.ply");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_packed_samples), cmocka_unit_test(test_biker),           cmocka_unit_test(test_packed_numbers),
        cmocka_unit_test(test_packed_faults),  cmocka_unit_test(test_splat_transform),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
