/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reading SOG: our own files and another sample, unpacked folders, both versions and harmonics in files made here, errors,
 * damaged files.
 */
#include "random_splats.h"
#include "splat_damage.h"

#ifdef HAVE_SOG

#include "media/points/points.h"
#include "system/zip.h"

#include <webp/encode.h>

#define N 500

static uint32_t nearest(const adcgs_splats *s, const adcgs_splats *from, uint32_t k)
{
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < s->n; i++) {
        double d = 0.0;
        for (int a = 0; a < 3; a++)
            d += pow((double)s->mean[a][i] - (double)from->mean[a][k], 2);
        if (d < least) {
            least = d;
            best = i;
        }
    }
    return best;
}

static void same_rotation(const adcgs_splats *a, uint32_t i, const adcgs_splats *b, uint32_t k)
{
    double dot = 0.0;
    for (int c = 0; c < 4; c++)
        dot += (double)a->rotation[c][i] * (double)b->rotation[c][k];
    assert_true(fabs(dot) > 0.9999);
}

/** Our files are read within the format's steps. */
static void test_round_trip(void **state)
{
    adcgs_splats s = random_splats(N, 5.0, 2.0, 6), back;
    int seen[N] = {0};
    expect_good(write_splats(&s, in("w.sog")));
    assert_true(adcgs_splats_is(in("w.sog")));
    expect_good(adcgs_splats_read(&back, in("w.sog"), &error));
    assert_true(back.n == N && back.degree == 0 && back.axes == ADCGS_SPLATS_UP_UNKNOWN && !back.antialiased);
    for (uint32_t k = 0; k < N; k++) {
        const uint32_t i = nearest(&s, &back, k);
        seen[i]++;
        for (int a = 0; a < 3; a++) {
            near(back.mean[a][k], s.mean[a][i], 2e-4, 2e-4);
            near(back.scale[a][k], s.scale[a][i], 0.02, 0.0);
            near(back.colour[a][k], s.colour[a][i], 0.0, 0.01);
        }
        near(back.opacity[k], s.opacity[i], 0.0, 0.5 / 255 + 1e-6);
        same_rotation(&back, k, &s, i);
    }
    for (uint32_t i = 0; i < N; i++)
        assert_int_equal(seen[i], 1);
    adcgs_splats_free(&back);
    adcgs_splats_free(&s);
}

/** One frame of a stream in two formats. SPZ clips scales and colours. */
static void test_sample(void **state)
{
    adcgs_splats s, z;
    expect_good(adcgs_splats_read(&s, real_data("splats4d/sog/demo_t0.5.sog"), &error));
    if (adcgs_splats_read(&z, real_data("splats4d/sog/demo_t0.5.spz"), &error) == ADCGS_ERR_UNSUPPORTED)
        skip();
    assert_true(s.n == 20985 && z.n == s.n);
    for (uint32_t k = 0; k < s.n; k += 97) {
        const uint32_t i = nearest(&z, &s, k);
        for (int a = 0; a < 3; a++) {
            near(s.mean[a][k], z.mean[a][i], 1e-4, 2e-4);
            near(fmaxf(s.scale[a][k], 4.54e-5f), z.scale[a][i], 0.06, 0.0);
            if (s.opacity[k] > 0.0f) /* our writer drops colours under an alpha of 0 */
                near(fminf(fmaxf(s.colour[a][k], -0.44f), 1.44f), z.colour[a][i], 0.0, 0.02);
        }
        near(s.opacity[k], z.opacity[i], 0.0, 1.01 / 255);
    }
    adcgs_splats_free(&s);
    adcgs_splats_free(&z);
}

/* ---- Files made here ---- */

enum { WIDTH = 3, SPLATS = 5, IMAGES = 7, CENTROIDS = 66 };

static const char *const names[IMAGES] = {"means_l.webp", "means_u.webp",       "quats.webp",     "scales.webp",
                                          "sh0.webp",     "shN_centroids.webp", "shN_labels.webp"};

/** A channel of a pixel: each image has different numbers, small enough for short codebooks. */
static uint8_t channel(int image, int i, int c, int degree)
{
    const int each = (degree + 1) * (degree + 1) - 1;
    switch (image) {
    case 0:
        return (uint8_t)(17 * i + 50 * c);
    case 1:
        return (uint8_t)(200 - 40 * i + c);
    case 2:
        return (uint8_t)(c < 3 ? (i == 4 ? 128 : 100 + 20 * c) : 252 + i % 4);
    case 3:
        return (uint8_t)(c < 3 ? (i + c) % 4 : 1);
    case 4:
        return (uint8_t)(c < 3 ? (i + 2 * c) % 4 : 1 + 50 * i); /* alpha 1 must not spoil the colour */
    case 5:
        return (uint8_t)(c < 3 ? (i / (64 * each) * 64 + i % (64 * each) / each + i % each + c) % 5 : 255);
    default:
        return (uint8_t)(c == 0 ? i * 16 + (i == 4) : c == 3 ? 255 : 0); /* labels 0, 16, 32, 48, 65 */
    }
}

static void add_image(adcgs_zip *zip, int image, int degree, int lossy)
{
    const int each = (degree + 1) * (degree + 1) - 1, width = image == 5 ? 64 * each : WIDTH;
    static uint8_t pixels[4 * 64 * 15 * 2];
    uint8_t *packed = NULL;
    for (int i = 0; i < 2 * width; i++)
        for (int c = 0; c < 4; c++)
            pixels[4 * i + c] = channel(image, i, c, degree);
    const size_t bytes = lossy ? WebPEncodeRGBA(pixels, width, 2, 4 * width, 90.0f, &packed)
                               : WebPEncodeLosslessRGBA(pixels, width, 2, 4 * width, &packed);
    assert_true(bytes > 0);
    adcgs_zip_add(zip, names[image], packed, bytes);
    put_bytes(names[image], packed, bytes);
    WebPFree(packed);
}

static const char *const means = "\"mins\":[-1,-0.5,0],\"maxs\":[1,1.5,3],\"files\":[\"means_l.webp\",\"means_u.webp\"]}";

/** The text of meta.json; that of the first version without bands and counts. */
static void make_meta(char *text, size_t room, int version, int degree)
{
    size_t at;
    if (version == 1)
        at = (size_t)snprintf(text, room,
                              "{\"means\":{\"shape\":[5,3],%s,\"quats\":{\"files\":[\"quats.webp\"]},"
                              "\"scales\":{\"mins\":[-4,-3,-2],\"maxs\":[0,0.5,0],\"files\":[\"scales.webp\"]},"
                              "\"sh0\":{\"mins\":[-1,-2,-3,-5],\"maxs\":[1,2,3,5],\"files\":[\"sh0.webp\"]}",
                              means);
    else
        at = (size_t)snprintf(text, room,
                              "{\"version\":2,\"count\":5,\"antialias\":true,\"means\":{%s,"
                              "\"scales\":{\"codebook\":[-4,-3,-2,-1],\"files\":[\"scales.webp\"]},"
                              "\"quats\":{\"files\":[\"quats.webp\"]},"
                              "\"sh0\":{\"codebook\":[-1.5,0,0.5,1.5],\"files\":[\"sh0.webp\"]}",
                              means);
    if (degree && version == 1)
        at += (size_t)snprintf(text + at, room - at,
                               ",\"shN\":{\"mins\":-1,\"maxs\":1.55,\"files\":[\"shN_centroids.webp\",\"shN_labels.webp\"]}");
    else if (degree)
        at += (size_t)snprintf(text + at, room - at,
                               ",\"shN\":{\"count\":66,\"bands\":%d,\"codebook\":[-0.2,0.1,0.4,0.5,0.9],"
                               "\"files\":[\"shN_centroids.webp\",\"shN_labels.webp\"]}",
                               degree);
    snprintf(text + at, room - at, "}");
}

/** Make s.sog, and its files in the folder. from, to: a change of meta.json, or NULL. drop: an image that is left out, or -1. */
static void make_sog(int version, int degree, const char *from, const char *to, int drop)
{
    char text[2048], changed[4096];
    FILE *file = fopen(in("s.sog"), "wb");
    adcgs_zip zip = {.file = file};
    make_meta(text, sizeof text, version, degree);
    char *const at = from ? strstr(text, from) : text;
    assert_non_null(at);
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, from ? to : "", at + (from ? strlen(from) : 0));
    adcgs_zip_add(&zip, "meta.json", (const uint8_t *)changed, strlen(changed));
    put_text("meta.json", changed);
    for (int k = 0; k < (degree ? IMAGES : 5); k++)
        if (k != drop)
            add_image(&zip, k, degree, 0);
        else
            unlink(in(names[k]));
    adcgs_zip_end(&zip);
    assert_int_equal(fclose(file), 0);
}

static double lerp(double low, double high, int byte)
{
    return low + (high - low) * byte / 255.0;
}

static void expect_made(const adcgs_splats *s, int version, int degree)
{
    static const double low[3] = {-1, -0.5, 0}, high[3] = {1, 1.5, 3}, scales[4] = {-4, -3, -2, -1},
                        colours[4] = {-1.5, 0, 0.5, 1.5}, harmonics[5] = {-0.2, 0.1, 0.4, 0.5, 0.9};
    static const int labels[SPLATS] = {0, 16, 32, 48, 65};
    const int each = (degree + 1) * (degree + 1) - 1;
    assert_true(s->n == SPLATS && s->degree == degree && s->antialiased == (version == 2));
    for (int i = 0; i < SPLATS; i++) {
        double sum = 0.0;
        for (int c = 0; c < 3; c++) {
            const int q = channel(0, i, c, 0) + 256 * channel(1, i, c, 0), scale = (i + c) % 4, colour = (i + 2 * c) % 4;
            const double v = low[c] + (high[c] - low[c]) * q / 65535.0, bounds[3] = {0, 0.5, 0};
            near(s->mean[c][i], (float)(v < 0 ? 1 - exp(-v) : exp(v) - 1), 1e-6, 1e-6);
            near(s->scale[c][i], (float)exp(version == 2 ? scales[scale] : lerp(c - 4, bounds[c], scale)), 1e-6, 0.0);
            near(s->colour[c][i], (float)(0.5 + ADCGS_SPLATS_DC * (version == 2 ? colours[colour] : lerp(-1 - c, 1 + c, colour))),
                 0.0, 1e-6);
        }
        const double alpha = version == 2 ? (1 + 50 * i) / 255.0 : 1.0 / (1.0 + exp(-lerp(-5, 5, 1 + 50 * i)));
        near(s->opacity[i], (float)alpha, 1e-6, 0.0);
        for (int a = 0, c = 0; a < 4; a++) {
            if (a != i % 4)
                near(s->rotation[a][i], (float)((channel(2, i, c++, 0) / 255.0 - 0.5) * sqrt(2.0)), 0.0, 1e-6);
            sum += pow((double)s->rotation[a][i], 2);
        }
        assert_true(s->rotation[i % 4][i] > 0.5f && fabs(sum - 1.0) < 1e-6);
        for (int c = 0; c < 3; c++)
            for (int j = 0; j < each; j++) {
                const int byte = (labels[i] + j + c) % 5;
                near(s->harmonics[(i * 3 + c) * each + j], (float)(version == 2 ? harmonics[byte] : lerp(-1, 1.55, byte)), 0.0,
                     1e-6);
            }
    }
}

/** Both versions, all degrees, from an archive and from a folder. */
static void test_versions(void **state)
{
    adcgs_splats s;
    adcgs_points points;
    for (int version = 1; version <= 2; version++)
        for (int degree = 0; degree <= 3; degree++) {
            make_sog(version, degree, NULL, NULL, -1);
            for (int is_folder = 0; is_folder < 2; is_folder++) {
                const char *const path = in(is_folder ? "meta.json" : "s.sog");
                assert_true(adcgs_splats_is(path));
                expect_good(adcgs_splats_read(&s, path, &error));
                expect_made(&s, version, degree);
                adcgs_splats_free(&s);
            }
            expect_good(adcgs_points_read(&points, in("meta.json"), &error));
            assert_int_equal(points.n, SPLATS);
            adcgs_points_free(&points);
        }
    make_sog(2, 0, "[-4,-3,-2,-1]", "[null,-3,-2.4,-1.5]", -1); /* a third of their span below -3 */
    expect_good(adcgs_splats_read(&s, in("s.sog"), &error));
    near(s.scale[0][0], (float)exp(-3.5), 1e-6, 0.0);
    adcgs_splats_free(&s);
}

static void test_faults(void **state)
{
    static const struct {
        int version, degree;
        const char *from, *to;
        adcgs_status status;
        const char *text;
    } cases[] = {
        {2, 0, "\"version\":2", "\"version\":3", ADCGS_ERR_UNSUPPORTED, "SOG of version 3, expected 1 or 2"},
        {2, 0, "\"version\":2", "\"version\":\"2\"", ADCGS_ERR_DATA, "version: expected an integer"},
        {2, 0, "\"count\":5", "\"timeline\":{}", ADCGS_ERR_UNSUPPORTED, "over time (TSOG)"},
        {2, 0, "\"count\":5", "\"count\":0", ADCGS_ERR_DATA, "count: expected 1 to 16777216 splats"},
        {2, 0, "\"count\":5", "\"count\":7", ADCGS_ERR_DATA, "means_l.webp: 3x2 pixels, expected one for each of 7 splats"},
        {2, 0, "\"count\":5", "\"count\":16777216", ADCGS_ERR_DATA, "16777216 splats, but only"},
        {2, 0, "[-1,-0.5,0]", "[-1,-0.5]", ADCGS_ERR_DATA, "means.mins: expected 3 numbers"},
        {2, 0, "[-1,-0.5,0]", "[-1,-0.5,\"0\"]", ADCGS_ERR_DATA, "means.mins: expected 3 numbers"},
        {2, 0, "[1,1.5,3]", "[1,1.5,300]", ADCGS_ERR_DATA, "splat 0: a coordinate is"},
        {2, 0, "\"means_u.webp\"", "7", ADCGS_ERR_DATA, "means.files: expected names of files"},
        {2, 0, ",\"means_u.webp\"", "", ADCGS_ERR_DATA, "means.files: expected two names"},
        {2, 0, "\"means_u.webp\"", "\"../means_u.webp\"", ADCGS_ERR_DATA, "means.files: expected names of files"},
        {2, 0, "\"means_u.webp\"", "\"a/means_u.webp\"", ADCGS_ERR_DATA, "means.files: expected names of files"},
        {2, 0, "\"means_u.webp\"", "\"meta.json\"", ADCGS_ERR_DATA, "meta.json: not a WebP image"},
        {2, 0, "[-4,-3,-2,-1]", "[]", ADCGS_ERR_DATA, "scales.codebook: expected 1 to 256 numbers"},
        {2, 0, "[-4,-3,-2,-1]", "[-4,-3,-2]", ADCGS_ERR_DATA, "splat 1: a scale is nan"},
        {2, 0, "[-4,-3,-2,-1]", "[-4,-3,99,-1]", ADCGS_ERR_DATA, "splat 0: a scale is"},
        {2, 0, "[-1.5,0,0.5,1.5]", "[-1.5,0,null,1.5]", ADCGS_ERR_DATA, "a colour is nan"},
        {2, 0, "quats.webp", "means_u.webp", ADCGS_ERR_DATA, "splat 0: alpha 203 of a rotation, expected 252 to 255"},
        {2, 1, "\"bands\":1", "\"bands\":4", ADCGS_ERR_DATA, "shN.bands: expected 1 to 3"},
        {2, 1, "\"bands\":1", "\"bands\":2", ADCGS_ERR_DATA, "shN_centroids.webp: 192x2 pixels"},
        {2, 1, "\"count\":66", "\"count\":0", ADCGS_ERR_DATA, "shN.count: expected 1 to 65536"},
        {2, 1, "\"count\":66", "\"count\":65", ADCGS_ERR_DATA, "splat 4: centroid 65 of its harmonics, but there are 65"},
        {2, 1, "\"count\":66", "\"count\":129", ADCGS_ERR_DATA, "a row for 64 of 129 centroids"},
        {2, 1, "0.5,0.9]", "0.5]", ADCGS_ERR_DATA, "a harmonic is not a finite number"},
        {2, 1, "\"shN_centroids.webp\"", "\"sh0.webp\"", ADCGS_ERR_DATA, "sh0.webp: 3x2 pixels"},
        {1, 0, "[5,3]", "[0,3]", ADCGS_ERR_DATA, "means.shape: expected 1 to"},
        {1, 0, "\"maxs\":[0,0.5,0]", "\"maxs\":[0,0.5,null]", ADCGS_ERR_DATA, "scales.maxs: expected 3 numbers"},
        {1, 1, "\"mins\":-1,", "", ADCGS_ERR_DATA, "shN.mins: expected 1 numbers"},
        {2, 0, "\"count\":5,", "\"count\":5", ADCGS_ERR_DATA, "meta.json: line 1: malformed JSON"},
    };
    adcgs_splats s;
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        make_sog(cases[i].version, cases[i].degree, cases[i].from, cases[i].to, -1);
        expect_error(adcgs_splats_read(&s, in("s.sog"), &error), cases[i].status, "s.sog: ", cases[i].text);
        expect_error(adcgs_splats_read(&s, in("meta.json"), &error), cases[i].status, "meta.json: ", cases[i].text);
        assert_null(s.block);
    }
}

/** A missing image, an archive of something else, a lossy image. */
static void test_other_files(void **state)
{
    adcgs_splats s;
    make_sog(2, 1, NULL, NULL, 6);
    expect_error(adcgs_splats_read(&s, in("s.sog"), &error), ADCGS_ERR_DATA, "s.sog: ", "no file shN_labels.webp");
    expect_error(adcgs_splats_read(&s, in("meta.json"), &error), ADCGS_ERR_IO, "shN_labels.webp", "No such file");
    FILE *file = fopen(in("t.sog"), "wb");
    adcgs_zip zip = {.file = file};
    adcgs_zip_add(&zip, "sh0.webp", (const uint8_t *)"", 0);
    adcgs_zip_end(&zip);
    fclose(file);
    expect_error(adcgs_splats_read(&s, in("t.sog"), &error), ADCGS_ERR_DATA, "t.sog: ", "without meta.json");
    file = fopen(in("t.sog"), "wb");
    zip = (adcgs_zip){.file = file};
    make_sog(2, 0, NULL, NULL, 0);
    add_image(&zip, 0, 0, 1);
    adcgs_zip_end(&zip);
    fclose(file);
    expect_error(adcgs_splats_read(&s, in("meta.json"), &error), ADCGS_ERR_DATA, "means_l.webp: WebP that is lossy", "lossless");
}

static void test_splat_transform(void **state)
{
    need_splat_transform();
    for (int degree = 1; degree <= 3; degree++) {
        make_sog(2, degree, NULL, NULL, -1);
        expect_as_splat_transform("s.sog");
    }
}

static void test_damage(void **state)
{
    size_t bytes;
    for (int version = 1; version <= 2; version++) {
        make_sog(version, 1, NULL, NULL, -1);
        uint8_t *const data = load_file("s.sog", &bytes);
        assert_int_equal(read_damaged(data, bytes), ADCGS_OK);
        damage(data, bytes, 800);
        free(data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),      cmocka_unit_test(test_sample),      cmocka_unit_test(test_versions),
        cmocka_unit_test(test_faults),          cmocka_unit_test(test_other_files), cmocka_unit_test(test_damage),
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
