/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats in .splat and .ksplat: known values of other programs' files, all levels and features in files made here, errors,
 * damaged files. Splats of all formats as points.
 */
#include "splat_bytes.h"
#include "splat_damage.h"

#include "media/points/points.h"

/* ---- .splat ---- */

static void test_splat_samples(void **state)
{
    const tolerance most = {2e-6, 2e-6, 2e-6, 2e-6, 2e-6};
    expect_state("splats4d/splat_frames/frame_0000.splat", "splat4d", 0, &most);
    expect_state("splats4d/splat_frames/frame_0006.splat", "splat4d", 1, &most);
    adcgs_splats s = open_splats(real_data("splats/james.splat"));
    assert_int_equal(s.n, 20018);
    adcgs_splats_free(&s);
}

static void put_record(made_file *b, const double *reals, const char *tail)
{
    for (int i = 0; i < 6; i++)
        put_real(b, reals[i]);
    put(b, tail, 8);
}

static void test_splat_numbers(void **state)
{
    static const double reals[6] = {1.0, -2.5, 3e5, 0.0, 0.25, 4.0};
    static made_file b;
    adcgs_splats s;
    b.n = 0;
    put_record(&b, reals, "\xff\x80\0\x33\0\x80\x80\x80"); /* a rotation of (-1, 0, 0, 0) */
    expect_good(parse(&s, &b));
    assert_true(s.n == 1 && s.mean[0][0] == 1.0f && s.mean[1][0] == -2.5f && s.mean[2][0] == 3e5f);
    assert_true(s.scale[0][0] == ADCGS_SPLATS_SCALE_MIN && s.scale[1][0] == 0.25f && s.scale[2][0] == 4.0f);
    assert_true(s.colour[0][0] == 1.0f && s.colour[1][0] == 128 / 255.0f && s.colour[2][0] == 0.0f);
    assert_true(s.opacity[0] == 0.2f && s.rotation[0][0] == -1.0f && s.rotation[1][0] == 0.0f);
    adcgs_splats_free(&s);
    for (size_t cut = 0; cut < 32; cut++) {
        b.n = cut;
        expect_error(parse(&s, &b), ADCGS_ERR_DATA, "file: not splats, expected PLY", ".splat");
    }
    b.n = 0;
    for (int i = 0; i < 200; i++)
        put_record(&b, reals, "\xff\x80\0\x33\0\x80\x80\x80");
    expect_good(parse(&s, &b));
    assert_int_equal(s.n, 200);
    adcgs_splats_free(&s);
    memset(b.data + 32 * 150 + 28, 0x80, 4); /* behind the bytes that identify the format */
    expect_error(parse(&s, &b), ADCGS_ERR_DATA, "file: splat 150: the length of the rotation is 0", "a quaternion");
    b.data[32 * 150 + 28] = 0xff;
    adcgs_store_le32(b.data + 32 * 170 + 4, 0x7f800000);
    expect_error(parse(&s, &b), ADCGS_ERR_DATA, "file: splat 170: a coordinate is inf", "finite");
}

/* ---- .ksplat ---- */

static void test_ksplat_sample(void **state)
{
    adcgs_splats k = open_splats(real_data("splats4d/ksplat/minimal.ksplat"));
    adcgs_splats s = open_splats(real_data("splats4d/ksplat/minimal.splat"));
    same_splats(&k, &s, 0.0, 0.0);
    assert_int_equal(k.n, 4);
    assert_true(k.mean[0][0] == -1.0f && k.mean[1][0] == 0.0f && k.mean[2][0] == -1.0f && k.opacity[0] == 230 / 255.0f);
    adcgs_splats_free(&k);
    adcgs_splats_free(&s);
}

static uint16_t half_of(float v) /* exact for the numbers below */
{
    const uint32_t u = adcgs_float_bits(v);
    return (uint16_t)(v == 0.0f ? u >> 16 : (u >> 16 & 0x8000) | ((u >> 13 & 0x3ffff) - ((127 - 15) << 10)));
}

static void put_number(made_file *b, double value, int level)
{
    uint8_t le[2];
    if (level == 0) {
        put_real(b, value);
        return;
    }
    adcgs_store_le16(le, half_of((float)value));
    put(b, le, 2);
}

enum { SPLATS = 7, CAPACITY = 3 };

/** Splat i of a section; numbers are exact at each level. */
static void put_splat(made_file *b, int level, int degree, int i)
{
    const int steps[3] = {100 * i, -64 * i, 32}; /* of 1/64, from the bucket's centre (i / 3, 0, -i / 3) */
    const int bucket = i / CAPACITY;
    for (int a = 0; a < 3; a++) {
        uint8_t le[2];
        const double centre[3] = {(double)bucket, 0.0, (double)-bucket};
        adcgs_store_le16(le, (uint16_t)(1024 + steps[a]));
        if (level)
            put(b, le, 2);
        else
            put_real(b, centre[a] + steps[a] / 64.0);
    }
    for (int a = 0; a < 3; a++)
        put_number(b, 0.25 * (a + 1), level);
    for (int a = 0; a < 4; a++)
        put_number(b, a == i % 4 ? 2.0 : 0.0, level);
    put(b, (uint8_t[]){(uint8_t)(10 * i), 51, 102, 204}, 4);
    for (int k = 0; k < 3 * ((degree + 1) * (degree + 1) - 1); k++) {
        const uint8_t byte = (uint8_t)(5 * (k + 1));
        if (level == 2)
            put(b, &byte, 1);
        else
            put_number(b, (k + 1) / 32.0, level);
    }
}

static void put_section_header(made_file *b, int level, int degree, int n)
{
    const size_t begin = b->n;
    put32(b, (uint32_t)n);
    put32(b, (uint32_t)n + 1); /* room for one more */
    put32(b, CAPACITY);
    put32(b, SPLATS / CAPACITY + 1);
    put_real(b, 32.0);          /* 2048 steps of 1/64 */
    put32(b, 12);               /* bytes of a bucket */
    put32(b, level ? 1024 : 0); /* steps to a side */
    put32(b, 0);
    put32(b, SPLATS / CAPACITY);
    put32(b, 1);
    put32(b, (uint32_t)degree);
    while (b->n < begin + 1024)
        put(b, "", 1);
}

/** A file with two sections: of this degree, and of none. */
static void make_ksplat(made_file *b, int level, int degree)
{
    b->n = 0;
    put(b, "\0\1\0\0\3\0\0\0\0\0\0\0\0\0\0\0", 16);
    put32(b, 2 * SPLATS);
    put32(b, (uint32_t)level);
    while (b->n < 36)
        put(b, "", 1);
    put_real(b, -2.0);
    put_real(b, 3.1); /* bytes are 0.02 apart */
    while (b->n < 4096)
        put(b, "", 1);
    put_section_header(b, level, degree, SPLATS);
    put_section_header(b, level, 0, SPLATS);
    while (b->n < 4096 + 3 * 1024)
        put(b, "", 1);
    for (int section = 0; section < 2; section++) {
        put32(b, SPLATS % CAPACITY);
        for (int i = 0; i <= SPLATS / CAPACITY; i++) {
            put_real(b, i);
            put_real(b, 0.0);
            put_real(b, -i);
        }
        for (int i = 0; i <= SPLATS; i++)
            put_splat(b, level, section ? 0 : degree, i);
    }
}

static void expect_ksplat(const adcgs_splats *s, int level, int degree)
{
    const size_t per = 3 * (size_t)((degree + 1) * (degree + 1) - 1);
    assert_true(s->n == 2 * SPLATS && s->degree == degree);
    for (uint32_t k = 0; k < s->n; k++) {
        const int i = (int)k % SPLATS;
        assert_true(s->mean[0][k] == (float)(i / CAPACITY + 100 * i / 64.0));
        assert_true(s->mean[1][k] == (float)-i && s->mean[2][k] == (float)(0.5 - i / CAPACITY));
        for (int a = 0; a < 3; a++)
            assert_true(s->scale[a][k] == 0.25f * (float)(a + 1));
        for (int a = 0; a < 4; a++)
            assert_true(s->rotation[a][k] == (a == i % 4 ? 1.0f : 0.0f));
        assert_true(s->colour[0][k] == (float)(10 * i / 255.0) && s->colour[1][k] == 0.2f && s->opacity[k] == 0.8f);
        for (size_t j = 0; j < per; j++) {
            /* The file has degree 1 of red, green, blue, then degree 2 of them; we have all degrees of red first. */
            const size_t channel = j / (per / 3), c = j % (per / 3);
            const size_t place = c < 3 ? 3 * channel + c : 9 + 5 * channel + (c - 3);
            const double v = level == 2 ? -2.0 + 0.02 * 5 * (double)(place + 1) : (double)(place + 1) / 32.0;
            near(s->harmonics[k * per + j], k < SPLATS ? (float)v : 0.0f, 1e-6, 1e-6);
        }
    }
}

static void test_ksplat_levels(void **state)
{
    static made_file b;
    adcgs_splats s;
    for (int level = 0; level <= 2; level++)
        for (int degree = 0; degree <= 2; degree++) {
            make_ksplat(&b, level, degree);
            expect_good(parse(&s, &b));
            expect_ksplat(&s, level, degree);
            adcgs_splats_free(&s);
        }
}

static void test_ksplat_faults(void **state)
{
    static const struct {
        size_t at;
        uint32_t value;
        adcgs_status status;
        const char *text;
    } cases[] = {
        {4096, 9, ADCGS_ERR_DATA, "section 0 of KSplat: 9 splats, expected at most its room of 8"},
        {4096 + 4, 0xffffffff, ADCGS_ERR_DATA, "bytes, but"},
        {4096 + 8, 0, ADCGS_ERR_DATA, "splat 1 of a section is in none of its 3 buckets"},
        {4096 + 12, 0xffffffff, ADCGS_ERR_DATA, "bytes, but"},
        {4096 + 12, 0, ADCGS_ERR_DATA, "splat 0 of a section is in none of its 0 buckets"},
        {4096 + 16, 0x7fc00000, ADCGS_ERR_DATA, "splat 0: a coordinate is nan"},
        {4096 + 20, 16, ADCGS_ERR_DATA, "buckets of 16 bytes"},
        {4096 + 36, 0xffffffff, ADCGS_ERR_DATA, "bytes, but"},
        {4096 + 36, 0, ADCGS_ERR_DATA, "is in none of its"},
        {4096 + 40, 3, ADCGS_ERR_UNSUPPORTED, "harmonics of degree 3, expected 0 to 2"},
        {20, 3, ADCGS_ERR_DATA, "not splats"},
        {4, 0xffffff, ADCGS_ERR_DATA, "not splats"},
    };
    static made_file b;
    adcgs_splats s;
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        make_ksplat(&b, 1, 1);
        adcgs_store_le32(b.data + cases[i].at, cases[i].value);
        expect_error(parse(&s, &b), cases[i].status, "file: ", cases[i].text);
    }
    make_ksplat(&b, 1, 0);
    adcgs_store_le32(b.data + 4096, 0);
    adcgs_store_le32(b.data + 4096 + 1024, 0);
    expect_error(parse(&s, &b), ADCGS_ERR_DATA, "file: no splats", "");
    for (int level = 0; level <= 2; level++) {
        make_ksplat(&b, level, 2);
        assert_int_equal(read_damaged(b.data, b.n), ADCGS_OK);
        damage(b.data, b.n, 4096 + 2 * 1024);
    }
}

static void test_splat_transform(void **state)
{
    static made_file b;
    need_splat_transform();
    for (int level = 0; level <= 2; level++) {
        make_ksplat(&b, level, 2);
        put_bytes("t.ksplat", b.data, b.n);
        expect_as_splat_transform("t.ksplat");
    }
}

/* ---- Points ---- */

/** Any file of splats also serves as points: their centres and colours. */
static void expect_points(const char *path)
{
    adcgs_splats s;
    adcgs_points points;
    expect_good(adcgs_splats_read(&s, path, &error));
    expect_good(adcgs_points_read(&points, path, &error));
    assert_true(points.n == s.n && points.coloured);
    for (uint32_t i = 0; i < s.n; i++)
        for (int a = 0; a < 3; a++) {
            const double colour = fmin(fmax((double)s.colour[a][i], 0.0), 1.0);
            assert_true(fabs(points.position[i][a] - s.offset[a] - (double)s.mean[a][i]) <= 1e-5);
            assert_true(fabs(points.colour[i][a] - 255.0 * colour) <= 0.501);
        }
    adcgs_points_free(&points);
    adcgs_splats_free(&s);
}

static void test_points(void **state)
{
    static const char *const ends[] = {"p.ply", "p.glb", "p.spz", "p.sog"};
    static made_file b;
    adcgs_splats s = random_splats(50, 3.0, 1.0, 4);
    for (size_t i = 0; i < ADCGS_COUNTOF(ends); i++) {
        const adcgs_status status = write_splats(&s, in(ends[i]));
        assert_true(status == ADCGS_OK || status == ADCGS_ERR_UNSUPPORTED); /* a build without its library */
        if (status == ADCGS_OK)
            expect_points(in(ends[i]));
    }
    adcgs_splats_free(&s);
    make_ksplat(&b, 1, 1);
    put_bytes("p.ksplat", b.data, b.n);
    expect_points(in("p.ksplat"));
    expect_points(real_data("splats4d/ksplat/minimal.splat"));
    expect_points(real_data("splats4d/compressed_frames/scene000.compressed.ply"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_splat_samples), cmocka_unit_test(test_splat_numbers),   cmocka_unit_test(test_ksplat_sample),
        cmocka_unit_test(test_ksplat_levels), cmocka_unit_test(test_ksplat_faults),

        cmocka_unit_test(test_points),        cmocka_unit_test(test_splat_transform),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
