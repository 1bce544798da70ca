/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats in SOG: the archive, its images decoded here, codebooks; another program's reading. */
#include "outside_files.h"
#include "random_splats.h"

#ifdef HAVE_SOG

#include "media/splats/codebook.h"

#include <jansson.h>
#include <math.h>
#include <webp/decode.h>
#include <zlib.h>

#define N 500

/* ---- The archive ---- */

/** Finds a stored file's bytes in an archive through the directory at its end, and checks its checksum. */
static const uint8_t *find(const uint8_t *zip, size_t bytes, const char *name, size_t *size)
{
    const uint8_t *const end = zip + bytes - 22;
    assert_memory_equal(end, "PK\5\6", 4);
    const uint8_t *at = zip + adcgs_load_le32(end + 16);
    assert_ptr_equal(at + adcgs_load_le32(end + 12), end);
    for (int i = 0; i < adcgs_load_le16(end + 10); i++) {
        const size_t length = adcgs_load_le16(at + 28);
        assert_memory_equal(at, "PK\1\2", 4);
        if (length == strlen(name) && !memcmp(at + 46, name, length)) {
            const uint8_t *const local = zip + adcgs_load_le32(at + 42), *const data = local + 30 + length;
            assert_memory_equal(local, "PK\3\4", 4);
            assert_memory_equal(local + 4, at + 6, 24);
            assert_memory_equal(local + 30, name, length);
            *size = adcgs_load_le32(at + 20);
            assert_true(crc32(0, data, (uInt)*size) == adcgs_load_le32(at + 16) && adcgs_load_le16(at + 10) == 0);
            return data;
        }
        at += 46 + length;
    }
    fail_msg("no %s", name);
    return NULL;
}

static uint8_t *picture(const uint8_t *zip, size_t bytes, const char *name)
{
    size_t size;
    int width, height;
    const uint8_t *const data = find(zip, bytes, name, &size);
    uint8_t *const pixels = WebPDecodeRGBA(data, size, &width, &height);
    assert_non_null(pixels);
    assert_true(width == 24 && height == 24);
    return pixels;
}

static double number(json_t *root, const char *key, const char *list, size_t i)
{
    json_t *const value = json_array_get(json_object_get(json_object_get(root, key), list), i);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

/** The splat whose position is nearest. */
static uint32_t nearest(const adcgs_splats *s, const double mean[3])
{
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < s->n; i++) {
        double d = 0.0;
        for (int a = 0; a < 3; a++)
            d += pow((double)s->mean[a][i] - mean[a], 2);
        if (d < least) {
            least = d;
            best = i;
        }
    }
    return best;
}

static void test_pictures(void **state)
{
    static const char *const names[5] = {"means_l.webp", "means_u.webp", "quats.webp", "scales.webp", "sh0.webp"};
    adcgs_splats s = random_splats(N, 5.0, 2.0, 6);
    uint8_t *pixels[5];
    size_t bytes, size;
    int seen[N] = {0};
    expect_good(write_splats(&s, in("w.sog")));
    uint8_t *const zip = load_file("w.sog", &bytes);
    for (int k = 0; k < 5; k++)
        pixels[k] = picture(zip, bytes, names[k]);
    const char *const text = (const char *)find(zip, bytes, "meta.json", &size);
    json_t *const root = json_loadb(text, size, 0, NULL);
    assert_true(json_integer_value(json_object_get(root, "version")) == 2);
    assert_true(json_integer_value(json_object_get(root, "count")) == N);
    for (size_t k = 0; k < N; k++) {
        double mean[3], q[4], sum = 0.0, dot = 0.0;
        for (size_t a = 0; a < 3; a++) {
            const double low = number(root, "means", "mins", a), high = number(root, "means", "maxs", a);
            const double l = low + (high - low) * (pixels[0][4 * k + a] + 256 * pixels[1][4 * k + a]) / 65535.0;
            mean[a] = copysign(expm1(fabs(l)), l);
        }
        const uint32_t i = nearest(&s, mean);
        seen[i]++;
        for (int a = 0; a < 3; a++) {
            near((float)mean[a], s.mean[a][i], 2e-4, 2e-4);
            const double scale = number(root, "scales", "codebook", pixels[3][4 * k + (size_t)a]);
            const double f_dc = number(root, "sh0", "codebook", pixels[4][4 * k + (size_t)a]);
            near((float)scale, (float)log((double)s.scale[a][i]), 0.0, 0.02);
            near((float)(0.5 + ADCGS_SPLATS_DC * f_dc), s.colour[a][i], 0.0, 0.01);
        }
        near(pixels[4][4 * k + 3] / 255.0f, s.opacity[i], 0.0, 0.5 / 255 + 1e-6);
        const int largest = pixels[2][4 * k + 3] - 252;
        const uint8_t *from = pixels[2] + 4 * k;
        assert_in_range(largest, 0, 3);
        for (int a = 0; a < 4; a++)
            if (a != largest) {
                q[a] = (*from++ / 255.0 - 0.5) * sqrt(2.0);
                sum += q[a] * q[a];
            }
        q[largest] = sqrt(fmax(0.0, 1.0 - sum));
        for (int a = 0; a < 4; a++)
            dot += q[a] * (double)s.rotation[a][i];
        assert_true(fabs(dot) > 0.9999);
    }
    for (uint32_t i = 0; i < N; i++)
        assert_int_equal(seen[i], 1);
    json_decref(root);
    for (int k = 0; k < 5; k++)
        WebPFree(pixels[k]);
    free(zip);
    adcgs_splats_free(&s);
}

static void test_refused(void **state)
{
    adcgs_splats s = random_splats(1, 1.0, 0.0, 6);
    expect_good(write_splats(&s, in("one.sog"))); /* no range anywhere */
    s.n = 0;
    expect_error(write_splats(&s, in("none.sog")), ADCGS_ERR_UNSUPPORTED, "none.sog", "at least one splat");
    assert_true(access(in("none.sog"), F_OK) != 0);
    adcgs_splats_free(&s);
    expect_good(adcgs_splats_read(&s, in("one.sog"), &error));
    assert_int_equal(s.n, 1);
    adcgs_splats_free(&s);
}

/* ---- Codebooks ---- */

/** The search finds the nearest entry. Few values are all kept. The mean error is less than that of equal steps. */
static void test_codebook(void **state)
{
    enum { COUNT = 5000 };
    static float values[COUNT], sorted[COUNT];
    float book[ADCGS_CODEBOOK];
    uint64_t seed = 9;
    for (int i = 0; i < COUNT; i++)
        values[i] = sorted[i] = (float)pow((double)any(&seed, -1.0, 1.0), 5.0);
    assert_true(adcgs_codebook_make(book, sorted, COUNT));
    double error_here = 0.0, error_of_steps = 0.0;
    for (int i = 0; i < COUNT; i++) {
        const uint8_t k = adcgs_codebook_find(book, values[i]);
        for (int j = 0; j < ADCGS_CODEBOOK; j++)
            assert_true(fabsf(values[i] - book[k]) <= fabsf(values[i] - book[j]));
        const double step = 2.0 / 255, v = (double)values[i] + 1.0;
        error_here += pow((double)values[i] - (double)book[k], 2);
        error_of_steps += pow(v - step * floor(v / step + 0.5), 2);
    }
    for (int k = 1; k < ADCGS_CODEBOOK; k++)
        assert_true(book[k] >= book[k - 1]);
    assert_true(error_here < 0.5 * error_of_steps);
    for (int i = 0; i < 60; i++)
        sorted[i] = (float)(i % 20);
    assert_true(adcgs_codebook_make(book, sorted, 60));
    for (int i = 0; i < 20; i++)
        assert_true(book[adcgs_codebook_find(book, (float)i)] == (float)i);
}

static void test_splat_transform(void **state)
{
    need_splat_transform();
    adcgs_splats s = random_splats(N, 5.0, 2.0, 6), theirs;
    expect_good(write_splats(&s, in("a.sog")));
    splat_transform("a.sog", "", "b.ply");
    expect_good(adcgs_splats_read(&theirs, in("b.ply"), &error));
    assert_int_equal(theirs.n, N);
    for (uint32_t k = 0; k < N; k++) {
        const double mean[3] = {(double)theirs.mean[0][k], (double)theirs.mean[1][k], (double)theirs.mean[2][k]};
        const uint32_t i = nearest(&s, mean);
        double dot = 0.0;
        near(theirs.opacity[k], s.opacity[i], 0.0, 0.5 / 255 + 1e-5);
        for (int a = 0; a < 3; a++) {
            near(theirs.mean[a][k], s.mean[a][i], 2e-4, 2e-4);
            near(theirs.scale[a][k], s.scale[a][i], 0.02, 0.0);
            near(theirs.colour[a][k], s.colour[a][i], 0.0, 0.01);
        }
        for (int a = 0; a < 4; a++)
            dot += (double)theirs.rotation[a][k] * (double)s.rotation[a][i];
        assert_true(fabs(dot) > 0.9999);
    }
    adcgs_splats_free(&s);
    adcgs_splats_free(&theirs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_codebook),
        cmocka_unit_test(test_splat_transform),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

#else

int main(void)
{
    puts("skipped: this build has no SOG");
    return 77;
}

#endif
