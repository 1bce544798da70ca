/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats in SPZ: written and read back, within the format's steps; old versions; errors; another program's files, and its
 * reading of ours.
 */
#include "outside_files.h"

#ifdef HAVE_SPZ

#include "spz_files.h"

#include <math.h>
#include <zlib.h>
#include <zstd.h>

/* ---- Round trip ---- */

static void test_round_trip(void **state)
{
    static const struct {
        double size, offset;
        int bits;
    } cases[] = {{0.9, 0.0, 23}, {30.0, -500.0, 13}, {2.0, 8388000.0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        adcgs_splats s = random_splats(1000, cases[i].size, cases[i].offset, 3 + i), back;
        size_t bytes;
        expect_good(write_splats(&s, in("w.spz")));
        uint8_t *const file = load_file("w.spz", &bytes);
        assert_memory_equal(file, "NGSP\4\0\0\0\xe8\3\0\0\0", 13);
        assert_true(file[13] == cases[i].bits && file[14] == 0 && file[15] == 5 && adcgs_load_le32(file + 16) == 32);
        free(file);
        expect_good(adcgs_splats_read(&back, in("w.spz"), &error));
        near_splats(&back, &s, cases[i].bits);
        assert_true(back.axes == ADCGS_SPLATS_Y_UP && !back.degree && !back.harmonics);
        adcgs_splats_free(&s);
        adcgs_splats_free(&back);
    }
}

/**
 * Old versions are one gzip stream. Version 3 differs from 4 in its container alone. Version 2 rounds x, y, z to 1/127.5; their
 * errors add up in w.
 */
static void test_versions(void **state)
{
    adcgs_splats s = random_splats(70000, 30.0, -500.0, 3), three, four, two; /* more than one part of gzip's output */
    size_t bytes;
    s.antialiased = 1;
    expect_good(write_version(&s, 4, in("w4.spz")));
    expect_good(write_splats(&s, in("w.spz")));
    uint8_t *const by_default = load_file("w.spz", &bytes), *const chosen = load_file("w4.spz", &bytes);
    assert_memory_equal(by_default, chosen, bytes);
    free(by_default);
    free(chosen);
    expect_good(write_version(&s, 3, in("w3.spz")));
    expect_good(write_version(&s, 2, in("w2.spz")));
    uint8_t *const old = load_file("w3.spz", &bytes);
    assert_memory_equal(old, "\x1f\x8b\x08\0\0\0\0\0", 8); /* no name and no time, so files do not depend on them */
    free(old);
    expect_good(adcgs_splats_read(&four, in("w4.spz"), &error));
    expect_good(adcgs_splats_read(&three, in("w3.spz"), &error));
    expect_good(adcgs_splats_read(&two, in("w2.spz"), &error));
    assert_true(three.n == s.n && two.n == s.n && three.antialiased && two.antialiased);
    near_splats(&three, &s, 13);
    expect_versions(&two, &three, &four, &s);
    adcgs_splats_free(&two);
    adcgs_splats_free(&three);
    adcgs_splats_free(&four);
    for (int version = 2; version <= 3; version++) {
        s.n = 1;
        expect_good(write_version(&s, version, in("one.spz")));
        s.n = 0;
        expect_error(write_version(&s, version, in("none.spz")), ADCGS_ERR_UNSUPPORTED, "none.spz", "at least one splat");
    }
    expect_error(write_version(&s, 3, in("w.ply")), ADCGS_ERR_USAGE, "w.ply", "only SPZ");
    adcgs_splats_free(&s);
}

/** Values outside the format's ranges are clamped. A position that does not fit is an error. */
static void test_ranges(void **state)
{
    adcgs_splats s = random_splats(2, 1.0, 0.0, 5), back;
    for (uint32_t i = 0; i < 2; i++) {
        s.scale[0][i] = i ? 1e6f : 1e-6f;
        s.colour[0][i] = i ? 9.0f : -9.0f;
        s.opacity[i] = i ? 0.999f : 0.001f;
    }
    expect_good(write_splats(&s, in("w.spz")));
    expect_good(adcgs_splats_read(&back, in("w.spz"), &error));
    for (uint32_t i = 0; i < 2; i++) {
        near(back.scale[0][i], (float)exp(i ? 255 / 16.0 - 10 : -10.0), 1e-6, 0.0);
        near(back.colour[0][i], (float)(0.5 + (i ? 1 : -1) * ADCGS_SPLATS_DC / 0.3), 1e-6, 0.0);
        assert_true(back.opacity[i] == (i ? 1.0f : 0.0f));
    }
    adcgs_splats_free(&back);
    s.mean[2][1] = -8388608.0f;
    expect_error(write_splats(&s, in("far.spz")), ADCGS_ERR_UNSUPPORTED, "far.spz", "positions up to 2^23");
    s.n = 0;
    expect_error(write_splats(&s, in("far.spz")), ADCGS_ERR_UNSUPPORTED, "far.spz", "at least one splat");
    assert_true(access(in("far.spz"), F_OK) != 0);
    s.n = 2;
    expect_error(write_splats(&s, in("no/w.spz")), ADCGS_ERR_IO, "no/w.spz", "No such");
    expect_error(write_splats(&s, in("w.splat")), ADCGS_ERR_USAGE, "w.splat", "must end in .ply");
    expect_error(adcgs_splats_write(&s, &(adcgs_splats_style){.rest_degree = 3}, in("w.spz"), &error), ADCGS_ERR_USAGE, "w.spz",
                 "only PLY");
    adcgs_splats_free(&s);
}

/* ---- Versions 2 and 3 ---- */

static void test_old(void **state)
{
    uint8_t raw[256];
    adcgs_splats s;
    for (int version = 2; version <= 3; version++) {
        put_gzip("old.spz", raw, make_old(raw, version));
        expect_good(adcgs_splats_read(&s, in("old.spz"), &error));
        assert_true(s.n == 2 && s.degree == 1 && s.axes == ADCGS_SPLATS_Y_UP);
        const float mean[2][3] = {{1.0f, -1.0f, 0x1p-12f}, {2048.0f - 0x1p-12f, -2048.0f, 0.0f}};
        const float opacity[2] = {0.0f, 1.0f}, dc[2][3] = {{127, 0, 255}, {128, 1, 2}};
        const float scale[2][3] = {{160, 0, 255}, {80, 90, 100}};
        for (int i = 0; i < 2; i++) {
            assert_true(s.opacity[i] == opacity[i]);
            for (int a = 0; a < 3; a++) {
                assert_true(s.mean[a][i] == mean[i][a]);
                near(s.scale[a][i], (float)exp((double)scale[i][a] / 16 - 10), 1e-6, 0.0);
                near(s.colour[a][i], (float)(0.5 + ADCGS_SPLATS_DC * ((double)dc[i][a] / 255 - 0.5) / 0.15), 1e-6, 1e-7);
                for (int k = 0; k < 3; k++) { /* in the file the channels of a coefficient are together */
                    const int byte = i ? 14 * (9 + 3 * k + a) : 128 + 3 * k + a;
                    assert_true(s.harmonics[9 * i + 3 * a + k] == (float)(byte - 128) / 128);
                }
            }
        }
        /* Version 2: x is 1, with rounding in y and z; the second has x = -1. Version 3: w is 1; y is sqrt(1/2), z positive. */
        near(s.rotation[version == 2 ? 1 : 0][0], 1.0f, 0.0, 1e-4);
        near(s.rotation[1][1], version == 2 ? -1.0f : 0.0f, 0.0, 1e-4);
        near(s.rotation[2][1], version == 2 ? 0.0f : (float)SQRT_HALF, 0.0, 5e-3);
        adcgs_splats_free(&s);
    }
}

/* ---- Errors ---- */

static void expect_bad(const uint8_t *data, size_t bytes, adcgs_status status, const char *what)
{
    adcgs_splats s;
    expect_error(adcgs_splats_parse(&s, data, bytes, "b.spz", &error), status, "b.spz: ", what);
    assert_true(!s.n && !s.block && !s.harmonics);
}

/** Version 4 with one byte changed. */
static void test_bad(void **state)
{
    static const struct {
        int at;
        uint8_t value;
        adcgs_status status;
        const char *what;
    } cases[] = {
        {4, 3, ADCGS_ERR_DATA, "version 3 not packed by gzip"},
        {4, 5, ADCGS_ERR_UNSUPPORTED, "version 5"},
        {8, 0, ADCGS_ERR_DATA, "no splats"},
        {8, 6, ADCGS_ERR_DATA, "positions: 63 bytes, expected 54 of 6 splats"},
        {11, 2, ADCGS_ERR_DATA, "expected at most 16777216"},
        {12, 1, ADCGS_ERR_DATA, "5 streams of SPZ, expected 6"},
        {12, 4, ADCGS_ERR_UNSUPPORTED, "degree 4, expected at most 3"},
        {12, 9, ADCGS_ERR_DATA, "degree 9, expected 0 to 3"},
        {13, 31, ADCGS_ERR_DATA, "31 fractional bits, expected at most 30"},
        {15, 4, ADCGS_ERR_DATA, "4 streams of SPZ, expected 5"},
        {15, 7, ADCGS_ERR_DATA, "7 streams of SPZ, expected 5"},
        {16, 31, ADCGS_ERR_DATA, "table of 5 streams at 31"},
        {19, 255, ADCGS_ERR_DATA, "table of 5 streams at"},
        {34, 1, ADCGS_ERR_DATA, "positions: a stream of"},
        {39, 255, ADCGS_ERR_DATA, "positions: a stream of"},
        {47, 1, ADCGS_ERR_DATA, "positions: 72057594037927999 bytes, expected 63"},
        {112, 0, ADCGS_ERR_DATA, "positions: damaged zstd stream"},
    };
    adcgs_splats s = random_splats(7, 1.0, 0.0, 8);
    size_t bytes;
    expect_good(write_splats(&s, in("w.spz")));
    adcgs_splats_free(&s);
    uint8_t *const file = load_file("w.spz", &bytes);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const uint8_t was = file[cases[i].at];
        file[cases[i].at] = cases[i].value;
        if (cases[i].at == 8 && !cases[i].value)
            memset(file + 9, 0, 3);
        expect_bad(file, bytes, cases[i].status, cases[i].what);
        file[cases[i].at] = was;
    }
    for (size_t cut = 0; cut < bytes; cut++) {
        uint8_t *const part = malloc(cut + 1);
        memcpy(part, file, cut);
        part[cut] = 0;
        expect_bad(part, cut, ADCGS_ERR_DATA, "");
        free(part);
    }
    free(file);
}

/** A stream that unpacks to more or less than its column, or is too small for it. */
static void test_bad_streams(void **state)
{
    adcgs_splats s = random_splats(7, 1.0, 0.0, 8);
    uint8_t column[80] = {0}, stream[200], file[1024] = {0};
    size_t bytes;
    expect_good(write_splats(&s, in("w.spz")));
    adcgs_splats_free(&s);
    uint8_t *const good = load_file("w.spz", &bytes);
    const size_t first = (size_t)adcgs_load_le64(good + 32), rest = bytes - 112 - first;
    for (size_t n = 62; n <= 64; n++) {
        const size_t packed = ZSTD_compress(stream, sizeof stream, column, n, 3);
        memcpy(file, good, 112);
        adcgs_store_le64(file + 32, packed);
        memcpy(file + 112, stream, packed);
        memcpy(file + 112 + packed, good + 112 + first, rest);
        if (n == 63) {
            expect_good(adcgs_splats_parse(&s, file, 112 + packed + rest, "b.spz", &error));
            adcgs_splats_free(&s);
        } else
            expect_bad(file, 112 + packed + rest, ADCGS_ERR_DATA, n < 63 ? "positions: 62 bytes, expected 63" : "damaged zstd");
    }
    free(good);
    /* Sixteen million splats in a few bytes: refused before any memory is allocated for them. */
    adcgs_store_le32(file + 8, ADCGS_SPLATS_MAX);
    adcgs_store_le64(file + 40, (uint64_t)9 * ADCGS_SPLATS_MAX);
    expect_bad(file, 400, ADCGS_ERR_DATA, "positions: a stream of");
}

static void test_bad_old(void **state)
{
    uint8_t raw[256], file[512];
    size_t bytes = make_old(raw, 3);
    const size_t whole = put_gzip("old.spz", raw, bytes);
    uint8_t *const good = load_file("old.spz", &bytes);
    for (size_t cut = 2; cut < whole - 16; cut++) {
        memcpy(file, good, cut);
        file[cut] = 0;
        expect_bad(file, cut, ADCGS_ERR_DATA, "early");
    }
    good[whole - 7] ^= 1;
    expect_bad(good, whole, ADCGS_ERR_DATA, "checksum does not match");
    free(good);
    static const struct {
        int at;
        uint8_t value;
        adcgs_status status;
        const char *what;
    } cases[] = {{0, 'M', ADCGS_ERR_DATA, "not SPZ"},
                 {4, 1, ADCGS_ERR_UNSUPPORTED, "version 1, expected 2 to 4"},
                 {4, 4, ADCGS_ERR_DATA, "version 4 packed by gzip"},
                 {8, 3, ADCGS_ERR_DATA, "early"},
                 {10, 9, ADCGS_ERR_DATA, "splats, but only"},
                 {12, 3, ADCGS_ERR_DATA, "SPZ's harmonics: the data end"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const size_t n = make_old(raw, 3);
        raw[cases[i].at] = cases[i].value;
        put_gzip("old.spz", raw, n);
        uint8_t *const bad = load_file("old.spz", &bytes);
        expect_bad(bad, bytes, cases[i].status, cases[i].what);
        free(bad);
    }
}

/** Records before the table: other vendors' are skipped; axes have to be ours. */
static void test_extensions(void **state)
{
    adcgs_splats s = random_splats(7, 1.0, 0.0, 8);
    size_t bytes;
    uint8_t file[1024] = {0};
    expect_good(write_splats(&s, in("w.spz")));
    adcgs_splats_free(&s);
    uint8_t *const good = load_file("w.spz", &bytes);
    memcpy(file, good, 32);
    memcpy(file + 32 + 23, good + 32, bytes - 32);
    free(good);
    bytes += 23;
    file[14] = 2;
    file[16] = 32 + 23;
    adcgs_store_le32(file + 32, 0x12340001);
    adcgs_store_le32(file + 36, 3);
    adcgs_store_le32(file + 43, 0xadbe0003);
    adcgs_store_le32(file + 47, 4);
    for (uint32_t axes = 0; axes <= 6; axes++) {
        adcgs_store_le32(file + 51, axes);
        if (axes % 4)
            expect_bad(file, bytes, ADCGS_ERR_UNSUPPORTED, "axes of the kind");
        else {
            expect_good(adcgs_splats_parse(&s, file, bytes, "b.spz", &error));
            adcgs_splats_free(&s);
        }
    }
    file[47] = 5;
    expect_bad(file, bytes, ADCGS_ERR_DATA, "5 bytes, but 4 follow");
}

/** Replaces one byte of a good file at a time. Any outcome is valid but a crash, and an error is one line. */
static void test_mutations(void **state)
{
    adcgs_splats s = random_splats(3, 1.0, 0.0, 8);
    uint8_t raw[256];
    expect_good(write_splats(&s, in("m4.spz")));
    adcgs_splats_free(&s);
    put_gzip("m3.spz", raw, make_old(raw, 3));
    for (int version = 3; version <= 4; version++) {
        size_t bytes;
        uint8_t *const file = load_file(version == 3 ? "m3.spz" : "m4.spz", &bytes);
        for (size_t i = 0; i < bytes; i++)
            for (int v = 0; v < 256; v += 5) {
                const uint8_t was = file[i];
                file[i] = (uint8_t)v;
                const adcgs_status status = adcgs_splats_parse(&s, file, bytes, "mutant", &error);
                assert_true(status == ADCGS_OK || !strncmp(error.text, "mutant: ", 8));
                adcgs_splats_free(&s);
                file[i] = was;
            }
        free(file);
    }
}

/* ---- Files of other programs ---- */

static void test_biker(void **state)
{
    adcgs_splats s;
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    expect_good(adcgs_splats_read(&s, real_data("splats/biker.spz"), &error));
    assert_true(s.n == 152746 && s.degree == 0);
    for (uint32_t i = 0; i < s.n; i++)
        for (int a = 0; a < 3; a++) {
            low[a] = fmin(low[a], (double)s.mean[a][i]);
            high[a] = fmax(high[a], (double)s.mean[a][i]);
        }
    for (int a = 0; a < 3; a++)
        assert_true(low[a] > -20.0 && high[a] < 20.0 && high[a] - low[a] > 1.0);
    adcgs_splats_free(&s);
}

/** PlayCanvas' program reads our files like our reader does. We read its SPZ file of our PLY, which Niantic's own code writes. */
static void test_splat_transform(void **state)
{
    need_splat_transform();
    adcgs_splats s = random_splats(500, 1.0, 0.0, 77), ours, theirs;
    expect_good(write_splats(&s, in("a.spz")));
    expect_good(write_splats(&s, in("a.ply")));
    splat_transform("a.spz", "", "b.ply");
    expect_good(adcgs_splats_read(&ours, in("a.spz"), &error));
    expect_good(adcgs_splats_read(&theirs, in("b.ply"), &error));
    assert_int_equal(theirs.n, s.n);
    for (uint32_t i = 0; i < s.n; i++) {
        near(ours.opacity[i], theirs.opacity[i], 0.0, 2e-6);
        for (int a = 0; a < 3; a++) {
            near(ours.mean[a][i], theirs.mean[a][i], 1e-6, 1e-7);
            near(ours.scale[a][i], theirs.scale[a][i], 1e-5, 0.0);
            near(ours.colour[a][i], theirs.colour[a][i], 0.0, 1e-5);
        }
        for (int a = 0; a < 4; a++)
            near(ours.rotation[a][i], theirs.rotation[a][i], 0.0, 1e-5);
    }
    adcgs_splats_free(&ours);
    adcgs_splats_free(&theirs);
    for (int version = 3; version <= 4; version++) {
        splat_transform("a.ply", version == 3 ? "--spz-version 3" : "--spz-version 4", "c.spz");
        expect_good(adcgs_splats_read(&theirs, in("c.spz"), &error));
        near_splats(&theirs, &s, 12);
        adcgs_splats_free(&theirs);
    }
    adcgs_splats_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_old),
        cmocka_unit_test(test_versions),
        cmocka_unit_test(test_bad),
        cmocka_unit_test(test_bad_streams),
        cmocka_unit_test(test_bad_old),
        cmocka_unit_test(test_extensions),
        cmocka_unit_test(test_mutations),
        cmocka_unit_test(test_biker),
        cmocka_unit_test(test_splat_transform),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

#else

int main(void)
{
    puts("skipped: this build has no SPZ");
    return 77;
}

#endif
