/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Splats in GLB: written and read back; files made here with other kinds of numbers; another program's files. */
#include "glb_files.h"
#include "second_sources.h"

#include "media/splats/harmonics.h"
#include "media/splats/splats_move.h"

#include <math.h>

/** Expects the read splats to equal the written ones, except for the rounding of binary32. */
static void test_round_trip(void **state)
{
    adcgs_splats s = random_splats(1000, 30.0, -500.0, 3), back;
    size_t bytes;
    expect_good(write_splats(&s, in("w.glb")));
    uint8_t *const file = load_file("w.glb", &bytes);
    assert_true(!memcmp(file, "glTF\2\0\0\0", 8) && adcgs_load_le32(file + 8) == bytes && bytes % 4 == 0);
    assert_memory_equal(file + 16, "JSON", 4);
    const size_t text = adcgs_load_le32(file + 12);
    assert_true(text % 4 == 0 && adcgs_load_le32(file + 20 + text) == 56 * 1000 && bytes == 28 + text + 56 * 1000);
    assert_memory_equal(file + 24 + text, "BIN\0", 4);
    free(file);
    expect_good(adcgs_splats_read(&back, in("w.glb"), &error));
    same_splats(&back, &s, 0.0, 0.0);
    assert_true(back.axes == ADCGS_SPLATS_Y_UP && !back.degree && !back.harmonics);
    adcgs_splats_free(&back);
    s.n = 0;
    expect_error(write_splats(&s, in("none.glb")), ADCGS_ERR_UNSUPPORTED, "none.glb", "at least one splat");
    expect_error(write_splats(&s, in("no/w.glb")), ADCGS_ERR_IO, "no/w.glb", "No such");
    assert_true(access(in("none.glb"), F_OK) != 0);
    adcgs_splats_free(&s);
}

/* ---- Files made here ---- */

static void test_kinds(void **state)
{
    uint8_t numbers[134], file[4096];
    adcgs_splats s;
    fill_numbers(numbers);
    const size_t bytes = make(file, good, numbers, sizeof numbers);
    expect_good(adcgs_splats_parse(&s, file, bytes, "k.glb", &error));
    assert_true(s.n == 2 && s.degree == 1 && s.axes == ADCGS_SPLATS_Y_UP);
    assert_true(s.mean[0][0] == 1.0f && s.mean[2][0] == 3.0f && s.mean[0][1] == -4.0f && s.mean[2][1] == 6.0f);
    assert_true(s.rotation[0][0] == 1.0f && s.rotation[1][1] == -1.0f);
    assert_true(s.scale[0][0] == 1.0f && s.scale[1][0] == 0.2f && s.scale[2][0] == (float)(1 / 255.0));
    assert_true(s.scale[0][1] > 1e-35f && s.scale[0][1] < 2e-35f); /* flat */
    assert_true(s.opacity[0] == 1.0f && s.opacity[1] == (float)(0x3333 / 65535.0));
    near(s.colour[1][0], (float)(0.5 + ADCGS_SPLATS_DC), 1e-7, 0.0);
    near(s.colour[0][1], (float)(0.5 + 2 * ADCGS_SPLATS_DC), 1e-7, 0.0);
    for (int i = 0; i < 18; i++) /* coefficient 2 of each channel */
        assert_true(s.harmonics[i] == (i % 3 == 2 ? (float)(i / 3 + 1) : 0.0f));
    adcgs_splats_free(&s);
}

/* ---- Nodes ---- */

/** m m^T of an ellipsoid: rotation times scales. */
static void covariance(const adcgs_splats *s, uint32_t i, double out[9])
{
    const double w = s->rotation[0][i], x = s->rotation[1][i], y = s->rotation[2][i], z = s->rotation[3][i];
    const double r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    for (int a = 0; a < 9; a++) {
        out[a] = 0.0;
        for (int k = 0; k < 3; k++)
            out[a] += r[3 * (a / 3) + k] * r[3 * (a % 3) + k] * s->scale[k][i] * s->scale[k][i];
    }
}

static double colour(const adcgs_splats *s, uint32_t i, int channel, const double direction[3])
{
    double values[ADCGS_HARMONICS_MAX], sum = s->colour[channel][i];
    const int n = (s->degree + 1) * (s->degree + 1) - 1;
    adcgs_harmonics(values, direction, s->degree);
    for (int k = 0; k < n; k++)
        sum += values[k] * s->harmonics[(3 * i + (uint32_t)channel) * (uint32_t)n + (uint32_t)k];
    return sum;
}

/** A matrix moves means and ellipsoids as it moves points, and rotates view-dependent colours. */
static void check_moved(const double m[12], const double rotation[9])
{
    adcgs_splats before, after;
    make_splats(&before);
    make_splats(&after);
    expect_good(adcgs_splats_move(&after, m, "m", &error));
    for (uint32_t i = 0; i < before.n; i++) {
        double a[9], b[9], largest = 0.0;
        covariance(&before, i, a);
        covariance(&after, i, b);
        for (int r = 0; r < 3; r++) {
            double mean = m[4 * r + 3];
            for (int c = 0; c < 3; c++)
                mean += m[4 * r + c] * before.mean[c][i];
            assert_true(fabs(after.mean[r][i] - mean) < 1e-5 * (1.0 + fabs(mean)));
            largest = fmax(largest, b[4 * r]);
        }
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) {
                double expected = 0.0;
                for (int k = 0; k < 9; k++)
                    expected += m[4 * r + k / 3] * a[k] * m[4 * c + k % 3];
                if (fabs(b[3 * r + c] - expected) > 1e-5 * largest)
                    fail_msg("splat %u: %g, expected %g", i, b[3 * r + c], expected);
            }
        for (int n = 0; n < 5 && rotation; n++) {
            const double d[3] = {sin(n + 0.3) * cos(2.0 * n), sin(n + 0.3) * sin(2.0 * n), cos(n + 0.3)};
            double local[3];
            for (int c = 0; c < 3; c++)
                local[c] = rotation[c] * d[0] + rotation[3 + c] * d[1] + rotation[6 + c] * d[2];
            assert_true(fabs(colour(&after, i, n % 3, d) - colour(&before, i, n % 3, local)) < 1e-4);
        }
    }
    adcgs_splats_free(&before);
    adcgs_splats_free(&after);
}

static void test_moves(void **state)
{
    static const double turn[9] = {2 / 3., -1 / 3., 2 / 3., 2 / 3., 2 / 3., -1 / 3., -1 / 3., 2 / 3., 2 / 3.};
    static const double mirror[9] = {-2 / 3., -1 / 3., 2 / 3., -2 / 3., 2 / 3., -1 / 3., 1 / 3., 2 / 3., 2 / 3.};
    double m[12] = {0, 0, 0, 5, 0, 0, 0, -6, 0, 0, 0, 7};
    for (int i = 0; i < 9; i++)
        m[4 * (i / 3) + i % 3] = 2.5 * turn[i];
    check_moved(m, turn);
    for (int i = 0; i < 9; i++)
        m[4 * (i / 3) + i % 3] = 2.5 * mirror[i];
    check_moved(m, mirror);
    for (int i = 0; i < 9; i++) /* columns of unequal sizes */
        m[4 * (i / 3) + i % 3] = (0.5 + i % 3) * turn[i];
    check_moved(m, NULL);
}

/** Parents are applied after children: the file's nodes are a matrix, and a rotation with a size. */
static void test_nodes(void **state)
{
    uint8_t numbers[134], file[4096];
    char text[4096];
    adcgs_splats s;
    fill_numbers(numbers);
    const char *const parent = strstr(good, "{\"children\":[1]}"), *const child = strstr(good, "\"scale\":[1,1,1]");
    snprintf(text, sizeof text,
             "%.*s{\"children\":[1],\"matrix\":[2,0,0,0,0,2,0,0,0,0,2,0,10,20,30,1]}%.*s"
             "\"translation\":[1,0,0],\"rotation\":[0,0,0.7071067811865476,0.7071067811865476],\"q\":[0,0,0,1]%s",
             (int)(parent - good), good, (int)(child - parent - 16), parent + 16, strstr(child, "}"));
    const size_t bytes = make(file, text, numbers, sizeof numbers);
    expect_good(adcgs_splats_parse(&s, file, bytes, "n.glb", &error));
    /* (1, 2, 3) turned by a quarter about z is (-2, 1, 3); then moved by one, scaled by two, and moved. */
    near(s.mean[0][0], 8.0f, 1e-6, 0.0);
    near(s.mean[1][0], 22.0f, 1e-6, 0.0);
    near(s.mean[2][0], 36.0f, 1e-6, 0.0);
    near(s.scale[0][0], 2.0f, 1e-6, 0.0);
    near(s.rotation[3][0], 0.70710678f, 1e-6, 0.0);
    adcgs_splats_free(&s);
}

/* ---- Embedded SPZ ---- */

#define SPZ NAME "_compression_spz"
static const char packed[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[\"" NAME "\",\"" SPZ "_2\",\"KHR_materials_unlit\"],"
    "\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":8,\"byteLength\":%zu}],"
    "\"accessors\":[{\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\"}],"
    "\"nodes\":[{\"mesh\":0,\"translation\":[1,2,3]}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0,\"extensions\":{\"" NAME
    "\":{\"extensions\":{\"%s\":{\"bufferView\":%d}}}}}]}]}";

/** Reads a GLB file that contains an SPZ file behind eight bytes; expects this status and message. */
static void read_packed(adcgs_splats *s, const uint8_t *spz, size_t bytes, uint32_t n, const char *name, int view,
                        adcgs_status status, const char *what)
{
    char text[2048];
    uint8_t *const numbers = calloc(bytes + 8, 1), *const file = malloc(bytes + 4096);
    assert_true(numbers && file);
    memcpy(numbers + 8, spz, bytes);
    snprintf(text, sizeof text, packed, bytes + 8, bytes, n, name, view);
    const size_t size = make(file, text, numbers, bytes + 8);
    if (status == ADCGS_OK)
        expect_good(adcgs_splats_parse(s, file, size, "p.glb", &error));
    else
        expect_error(adcgs_splats_parse(s, file, size, "p.glb", &error), status, "p.glb: ", what);
    free(numbers);
    free(file);
}

static void test_packed(void **state)
{
#ifndef HAVE_SPZ
    skip();
#endif
    static const double place[12] = {-1, 0, 0, 1, 0, 1, 0, 2, 0, 0, -1, 3};
    adcgs_splats s, plain, back;
    size_t bytes;
    make_splats(&s);
    expect_good(write_splats(&s, in("a.spz")));
    uint8_t *const spz = load_file("a.spz", &bytes);
    expect_good(adcgs_splats_read(&plain, in("a.spz"), &error));
    expect_good(adcgs_splats_move(&plain, place, "a.spz", &error));
    for (int old = 0; old < 2; old++) {
        read_packed(&back, spz, bytes, s.n, old ? SPZ : SPZ "_2", 0, ADCGS_OK, "");
        same_splats(&back, &plain, 1e-6, 1e-6);
        assert_true(back.axes == ADCGS_SPLATS_Y_UP && back.degree == plain.degree);
        adcgs_splats_free(&back);
    }
    read_packed(&back, spz, bytes, s.n + 1, SPZ "_2", 0, ADCGS_ERR_DATA, "POSITION: 41 elements, but the SPZ has 40");
    read_packed(&back, spz, bytes, s.n, SPZ "_2", 1, ADCGS_ERR_DATA, SPZ "_2: no bufferViews 1");
    read_packed(&back, spz, bytes, s.n, "EXT_odd", 0, ADCGS_ERR_UNSUPPORTED, "by the extension EXT_odd, expected unpacked");
    read_packed(&back, spz, bytes - 9, s.n, SPZ "_2", 0, ADCGS_ERR_DATA, "SPZ");
    for (size_t n = 0; n < 32; n++)
        read_packed(&back, spz, n, s.n, SPZ "_2", 0, ADCGS_ERR_DATA, n < 4 ? "that is not SPZ" : "SPZ");
    adcgs_splats_free(&s);
    adcgs_splats_free(&plain);
    free(spz);
}

/** Splats are read from every node of the scene and from all primitives. */
static void test_many_nodes(void **state)
{
#define BESIDE "\"nodes\":[{\"mesh\":1,\"translation\":[3,0,0]},{\"mesh\":1},{\"mesh\":1,\"translation\":[0,9,0]}]"
#define FLOATS                                                                                                    \
    "{\"attributes\":{\"POSITION\":0,\"" NAME ":ROTATION\":1,\"" NAME ":SCALE\":2,\"" NAME ":OPACITY\":3,\"" NAME \
    ":SH_DEGREE_0_COEF_0\":4},\"mode\":0,\"extensions\":{\"" NAME "\":{}}}"
    uint8_t file[4096];
    adcgs_splats s;
    size_t bytes = change(file, NODES, BESIDE);
    expect_good(adcgs_splats_parse(&s, file, bytes, "k.glb", &error));
    assert_true(s.n == 6 && s.degree == 1 && s.axes == ADCGS_SPLATS_Y_UP);
    assert_true(s.mean[0][0] == 4.0f && s.mean[0][2] == 1.0f && s.mean[0][3] == -4.0f && s.mean[1][4] == 11.0f);
    assert_true(s.harmonics[2] == 1.0f && s.harmonics[18 + 17] == 6.0f && s.harmonics[36 + 2] == 1.0f);
    adcgs_splats_free(&s);
    bytes = change(file, NODES, BESIDE ",\"scene\":1,\"scenes\":[{\"nodes\":[1]},{\"nodes\":[2,0,77]}]");
    expect_good(adcgs_splats_parse(&s, file, bytes, "k.glb", &error));
    assert_true(s.n == 4 && s.mean[0][0] == 4.0f && s.mean[1][2] == 11.0f);
    adcgs_splats_free(&s);
    bytes = change(file, "\"meshes\":[{\"primitives\":[{", "\"meshes\":[{\"primitives\":[" FLOATS ",{");
    expect_good(adcgs_splats_parse(&s, file, bytes, "k.glb", &error));
    assert_true(s.n == 4 && s.degree == 1 && s.mean[2][3] == 6.0f);
    for (int i = 0; i < 18; i++) /* the first part has none */
        assert_true(s.harmonics[i] == 0.0f && s.harmonics[18 + i] == (i % 3 == 2 ? (float)(i / 3 + 1) : 0.0f));
    adcgs_splats_free(&s);
}

/* ---- Files of other programs ---- */

/** GLB files that PlayCanvas' program makes from our PLY, with and without harmonics. */
static void test_splat_transform(void **state)
{
    need_splat_transform();
    adcgs_splats s = random_splats(500, 1.0, 0.0, 77), theirs;
    expect_good(write_splats(&s, in("a.ply")));
    splat_transform("a.ply", "", "c.glb");
    expect_good(adcgs_splats_read(&theirs, in("c.glb"), &error));
    /* PLY defines no up direction. The program assumes y down and x right, and turns the splats about z. */
    for (uint32_t i = 0; i < s.n; i++) {
        assert_true(theirs.mean[0][i] == -s.mean[0][i] && theirs.mean[1][i] == -s.mean[1][i]);
        assert_true(theirs.mean[2][i] == s.mean[2][i]);
        near(theirs.opacity[i], s.opacity[i], 1e-5, 0.0);
        for (int a = 0; a < 3; a++) {
            double is[3], was[3];
            near(theirs.scale[a][i], s.scale[a][i], 1e-5, 0.0);
            near(theirs.colour[a][i], s.colour[a][i], 0.0, 1e-6);
            tip(is, &theirs, i, a);
            tip(was, &s, i, a);
            for (int b = 0; b < 3; b++)
                near((float)is[b], (float)(b < 2 ? -was[b] : was[b]), 0.0, 1e-5);
        }
    }
    adcgs_splats_free(&s);
    adcgs_splats_free(&theirs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),      cmocka_unit_test(test_kinds),  cmocka_unit_test(test_moves),
        cmocka_unit_test(test_nodes),           cmocka_unit_test(test_packed), cmocka_unit_test(test_many_nodes),
        cmocka_unit_test(test_splat_transform),
    };
    int failed = cmocka_run_group_tests(tests, make_folder, remove_folder);
    failed += adcgs_test_glb_faults();
    return failed;
}
