/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Point clouds: variants of PLY and NPY, damage, places far from the origin. */
#include "outside_files.h"
#include "second_sources.h"

#include "media/points/points.h"

#include <math.h>

static adcgs_status read_text(adcgs_points *points, const char *text, size_t bytes)
{
    put_bytes("p.ply", text, bytes);
    return adcgs_points_read(points, in("p.ply"), &error);
}

static void expect_points(const char *text, size_t bytes, uint32_t n, const float position[3], const uint8_t colour[3])
{
    adcgs_points points;
    const adcgs_status status = read_text(&points, text, bytes);
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_int_equal(points.n, n);
    for (int a = 0; a < 3; a++)
        assert_true(points.position[n - 1][a] == (double)position[a]);
    assert_memory_equal(points.colour[n - 1], colour, 3);
    assert_int_equal(points.coloured, colour[0] != colour[2]);
    adcgs_points_free(&points);
}

#define TEXT(s) s, sizeof(s) - 1

static void test_variants(void **state)
{
    static const float p[3] = {1.0f, -2.0f, 0.5f};
    static const uint8_t grey[3] = {128, 128, 128}, orange[3] = {255, 128, 0};
    expect_points(TEXT("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
                       "end_header\n7 7 7\n1 -2 .5\n"),
                  2, p, grey);
    /* Carriage returns, comments, other order, other elements on both sides, lists, no newline at the end. */
    expect_points(TEXT("ply\r\nformat ascii 1.0\r\ncomment x\r\nobj_info y\r\nelement camera 2\r\nproperty list uchar int id\r\n"
                       "property float f\r\nelement vertex 1\r\nproperty uchar blue\r\nproperty float z\r\nproperty uchar red\r\n"
                       "property list int float w\r\nproperty double x\r\nproperty uchar green\r\nproperty float y\r\n"
                       "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
                       "3 1 2 3 0.5\r\n0 0.5\r\n0 0.5 255 2 9 9 1 128 -2\r\n1 0"),
                  1, p, orange);
    /* Float colours. */
    expect_points(TEXT("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                       "property float red\nproperty float green\nproperty float blue\nend_header\n1 -2 0.5 3 0.5 -1\n"),
                  1, p, orange);
    /* Binary, both byte orders. */
    expect_points(TEXT("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                       "property float z\nproperty ushort red\nproperty uint8 green\nproperty char blue\nend_header\n"
                       "\0\0\x80\x3f\0\0\0\xc0\0\0\0\x3f\xff\xff\x80\x80"),
                  1, p, orange);
    expect_points(TEXT("ply\nformat binary_big_endian 1.0\nelement tag 1\nproperty list ushort short v\nelement vertex 1\n"
                       "property float x\nproperty short y\nproperty double z\nend_header\n"
                       "\0\2\1\1\1\1\x3f\x80\0\0\xff\xfe\x3f\xe0\0\0\0\0\0\0"),
                  1, p, grey);
}

static void expect_bad(const char *text, size_t bytes, const char *what)
{
    adcgs_points points;
    expect_error(read_text(&points, text, bytes), ADCGS_ERR_DATA, "p.ply", what);
    assert_true(points.n == 0 && !points.position && !points.colour);
}

#define HEAD "ply\nformat ascii 1.0\nelement vertex "
#define XYZ "\nproperty float x\nproperty float y\nproperty float z\n"

static void test_damage(void **state)
{
    expect_bad(TEXT(""), "no points, expected PLY");
    expect_bad(TEXT("ply"), "no points, expected PLY");
    expect_bad(TEXT("ply\n"), "ends early");
    expect_bad(TEXT("ply\nformat ascii 2.0\n"), "line 2");
    expect_bad(TEXT("ply\nformat middle_endian 1.0\n"), "unknown format");
    expect_bad(TEXT("ply\nelement vertex 1" XYZ "end_header\n1 2 3\n"), "without format");
    expect_bad(TEXT("ply\nformat ascii 1.0\nend_header\n"), "without format or vertices");
    expect_bad(TEXT(HEAD "1\nproperty float x\nproperty float y\nend_header\n1 2\n"), "no x, y and z");
    expect_bad(TEXT(HEAD "1\nproperty quad x\n"), "unknown type");
    expect_bad(TEXT(HEAD "1\nproperty list float int x\n"), "integer");
    expect_bad(TEXT(HEAD "1\nnonsense\n"), "line 4");
    expect_bad(TEXT(HEAD "1" XYZ "end_header\n1 22222\n"), "ends in item 0");
    expect_bad(TEXT(HEAD "1" XYZ "end_header\n1 zwei 3\n"), "expected a number");
    expect_bad(TEXT(HEAD "1" XYZ "end_header\n1 2x 3\n"), "expected a number");
    expect_bad(TEXT(HEAD "1" XYZ "end_header\n1 nan 3\n"), "not a finite");
    expect_bad(TEXT(HEAD "1" XYZ "end_header\n1 1e99 3\n"), "not a finite");
    expect_bad(TEXT(HEAD "4000000000" XYZ "end_header\n1 2 3\n"), "bytes follow");
    expect_bad(TEXT(HEAD "18446744073709551615" XYZ "end_header\n1 2 3\n"), "bytes follow");
    expect_bad(TEXT(HEAD "-1" XYZ "end_header\n1 2 3\n"), "bytes follow");
    expect_bad(TEXT("ply\nformat binary_little_endian 1.0\nelement vertex 2" XYZ "end_header\n0123456789012345678"),
               "bytes follow");
    expect_bad(TEXT("ply\nformat binary_little_endian 1.0\nelement a 1\nproperty list uint double v\nelement vertex 1" XYZ
                    "end_header\n\xff\xff\xff\xff 01234567890123456789"),
               "ends in item 0");
    expect_bad(TEXT("DRACO\2\2"), "Draco");
    expect_bad(TEXT("DRACO\2\2\1\1\0\0\xff\xff\xff\x7f\xff\xff\xff\x7f 0123456789"), "Draco");
    adcgs_points points;
    expect_error(adcgs_points_read(&points, in("absent.ply"), &error), ADCGS_ERR_IO, "absent.ply", "No such file");
    expect_error(adcgs_points_read(&points, folder, &error), ADCGS_ERR_IO, folder, "regular");
}

static void test_npy(void **state)
{
    static const float p[3] = {1.0f, -2.0f, 0.5f};
    static const uint8_t grey[3] = {128, 128, 128};
    expect_points(TEXT("\x93NUMPY\1\0\x3c\0"
                       "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n"
                       "............\0\0\x80\x3f\0\0\0\xc0\0\0\0\x3f"),
                  2, p, grey);
    /* Another order, other quotes, no comma at the end, blanks; formats 2.0 and 3.0 give the header's length in four bytes. */
    expect_points(TEXT("\x93NUMPY\2\0\x38\0\0\0"
                       "{\"shape\":(1,3,),\"descr\":\"<f8\",\"fortran_order\":False}   \n"
                       "\0\0\0\0\0\0\xf0\x3f\0\0\0\0\0\0\0\xc0\0\0\0\0\0\0\xe0\x3f"),
                  1, p, grey);
    expect_points(TEXT("\x93NUMPY\3\0\x3b\0\0\0"
                       "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3), }"
                       "\0\0\x80\x3f\0\0\0\xc0\0\0\0\x3f"),
                  1, p, grey);
}

static void expect_bad_header(const char *header, size_t bytes, const char *what)
{
    char text[256] = "\x93NUMPY\1\0";
    text[8] = (char)bytes;
    memcpy(text + 10, header, bytes);
    expect_bad(text, 10 + bytes, what);
}

#define F4 "'descr': '<f4'"
#define C_ORDER "'fortran_order': False"

static void test_bad_npy(void **state)
{
    adcgs_points points;
    expect_bad(TEXT("\x93NUMPY"), "ends early");
    expect_bad(TEXT("\x93NUMPY\1\0\x10\0{}"), "ends early");
    expect_bad(TEXT("\x93NUMPY\2\0\xff\xff\xff\xff{}"), "ends early");
    expect_error(read_text(&points, TEXT("\x93NUMPY\4\0\2\0{}")), ADCGS_ERR_UNSUPPORTED, "p.ply", "format 4.0");
    expect_bad_header(TEXT("{ "), "key in quotes");
    expect_bad_header(TEXT("  x"), "dictionary");
    expect_bad_header(TEXT("{'descr'}"), "descr: expected a colon");
    expect_bad_header(TEXT("{'descr': 4}"), "descr: expected a string");
    expect_bad_header(TEXT("{'descr': '<f4}"), "descr: expected a string");
    expect_bad_header(TEXT("{'descr': '>f4'}"), "descr: >f4");
    expect_bad_header(TEXT("{'descr': '<f2'}"), "descr: <f2");
    expect_bad_header(TEXT("{'descr': '|O'}"), "descr: |O");
    expect_bad_header(TEXT("{" F4 " " C_ORDER "}"), "comma");
    expect_bad_header(TEXT("{" F4 ", " F4 "}"), "descr: given twice");
    expect_bad_header(TEXT("{'colour': 1}"), "colour: unknown key");
    expect_bad_header(TEXT("{'a key of more than 16': 1}"), "key in quotes");
    expect_bad_header(TEXT("{'fortran_order': True}"), "True, expected False");
    expect_bad_header(TEXT("{'fortran_order': 0}"), "expected False");
    expect_bad_header(TEXT("{'shape': 3}"), "tuple");
    expect_bad_header(TEXT("{'shape': (3"), "tuple");
    expect_bad_header(TEXT("{'shape': (-1, 3)}"), "tuple");
    expect_bad_header(TEXT("{'shape': (99999999999999999999, 3)}"), "tuple");
    expect_bad_header(TEXT("{'shape': (1,1,1,1,1)}"), "tuple");
    expect_bad_header(TEXT("{'shape': (,)}"), "tuple");
    expect_bad_header(TEXT("{" F4 ", " C_ORDER "}"), "shape: missing");
    expect_bad_header(TEXT("{" C_ORDER ", 'shape': (0, 3)}"), "descr: missing");
    expect_bad_header(TEXT("{" F4 ", 'shape': (0, 3)}"), "fortran_order: missing");
    expect_bad_header(TEXT("{" F4 ", " C_ORDER ", 'shape': (3,)}"), "shape: expected (n, 3)");
    expect_bad_header(TEXT("{" F4 ", " C_ORDER ", 'shape': (0, 4)}"), "shape: expected (n, 3)");
    expect_bad_header(TEXT("{" F4 ", " C_ORDER ", 'shape': (0, 3)}, {"), "follows the dictionary");
    expect_bad_header(TEXT("{" F4 ", " C_ORDER ", 'shape': (1, 3)}"), "0 bytes behind the header, expected 12");
    expect_bad_header(TEXT("{" F4 ", " C_ORDER ", 'shape': (100000000000, 3)}"), "expected 1200000000000");
    expect_bad(TEXT("\x93NUMPY\1\0\x3b\0"
                    "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3), }"
                    "0123456789012"),
               "13 bytes");
    expect_bad(TEXT("\x93NUMPY\1\0\x3b\0"
                    "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3), }"
                    "........\0\0\x80\x7f"),
               "not a finite");
    expect_bad(TEXT("\x93NUMPY\1\0\x3b\0"
                    "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3), }"
                    "................\0\0\0\0\0\0\xf0\x7e"),
               "not a finite");
}

static void test_too_many_properties(void **state)
{
    char text[32768] = HEAD "1\n";
    for (int i = 0; i < 1100; i++)
        snprintf(text + strlen(text), 40, "property float p%d\n", i);
    expect_bad(text, strlen(text), "1024 properties");
}

static void test_round_trip(void **state)
{
    adcgs_points points, back;
    assert_int_equal(adcgs_points_alloc(&points, 1000, "points", &error), ADCGS_OK);
    for (uint32_t i = 0; i < points.n; i++)
        for (int a = 0; a < 3; a++) {
            points.position[i][a] = ldexp((double)i - 500.5, a * 10 - 20);
            points.colour[i][a] = (uint8_t)(i * 7 + (uint32_t)a);
        }
    assert_int_equal(adcgs_ply_write(&points, in("w.ply"), &error), ADCGS_OK);
    assert_int_equal(adcgs_points_read(&back, in("w.ply"), &error), ADCGS_OK);
    assert_int_equal(back.n, points.n);
    assert_memory_equal(back.position, points.position, points.n * sizeof *points.position);
    assert_memory_equal(back.colour, points.colour, points.n * sizeof *points.colour);
    adcgs_points_free(&points);
    adcgs_points_free(&back);
}

/** Points about a place, in binary64: kept exactly if they are far from the origin, else rounded to binary32. */
static void expect_places(double at, double size, int is_far)
{
    static uint8_t data[128 + 100 * 24];
    adcgs_points points;
    double x[100][3];
    static const char header[] = "\x93NUMPY\1\0\x76\0{'descr': '<f8', 'fortran_order': False, 'shape': (100, 3), }";
    memset(data, ' ', 128);
    memcpy(data, header, sizeof header - 1);
    data[127] = '\n';
    for (size_t i = 0; i < 100; i++)
        for (size_t a = 0; a < 3; a++) {
            x[i][a] = (a == 1 ? -at : at) + size * (double)(i * (a + 7) % 101) / 101;
            adcgs_store_le64(data + 128 + 8 * (3 * i + a), adcgs_double_bits(x[i][a]));
        }
    put_bytes("far.npy", data, sizeof data);
    assert_int_equal(adcgs_points_read(&points, in("far.npy"), &error), ADCGS_OK);
    for (size_t i = 0; i < 100; i++)
        for (size_t a = 0; a < 3; a++)
            if (points.position[i][a] != (is_far ? x[i][a] : (double)(float)x[i][a]))
                fail_msg("point %zu of a cloud at %g of size %g: %c is %.17g, written as %.17g", i, at, size, "xyz"[a],
                         points.position[i][a], x[i][a]);
    adcgs_points_free(&points);
}

static void test_far(void **state)
{
    expect_places(0.0, 3.0, 0);
    expect_places(10.0, 3.0, 0);
    expect_places(4.6e6, 3.0, 1);
    expect_places(4.6e-3, 3e-9, 1); /* no length is absolute */
    expect_places(5e5, 5e4, 0);
    expect_places(5.1, 0.0, 0);
}

/** Colours from 0 to 255 in wider types, MeshLab's former names, colours of splats, and an offset in a comment. */
static void test_others(void **state)
{
    static const float p[3] = {1.0f, -2.0f, 0.5f};
    static const uint8_t orange[3] = {255, 128, 0};
    static const char *const types[] = {"float", "double", "short", "ushort", "int", "uint"};
    char text[1000];
    for (size_t i = 0; i < ADCGS_COUNTOF(types); i++) {
        snprintf(text, sizeof text,
                 HEAD "2" XYZ "property %s red\nproperty %s green\nproperty %s blue\nend_header\n7 7 7 9 9 9\n"
                      "1 -2 .5 255 128 0\n",
                 types[i], types[i], types[i]);
        expect_points(text, strlen(text), 2, p, orange);
    }
    expect_points(TEXT(HEAD "1" XYZ "property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n"
                            "end_header\n1 -2 .5 255 128 0\n"),
                  1, p, orange);
    expect_points(TEXT(HEAD "1" XYZ "property float f_dc_0\nproperty float f_dc_1\nproperty float f_dc_2\n"
                            "end_header\n1 -2 .5 1.8 0.007 -1.9\n"),
                  1, p, orange);
    expect_points(TEXT("ply\nformat ascii 1.0\ncomment offset 1000000.5 -2 0\nelement vertex 1" XYZ "end_header\n-999999.5 0 .5"),
                  1, p, (const uint8_t[3]){128, 128, 128});
}

/** One byte of a good file at a time gets another value: any outcome but a crash. */
static void test_mutations(void **state)
{
    static const char good[] = "ply\nformat binary_little_endian 1.0\nelement a 2\nproperty list uchar int v\n"
                               "element vertex 3" XYZ "end_header\n\1\0\0\0\0\0"
                               "012345678901"
                               "012345678901"
                               "012345678901";
    char bytes[sizeof good];
    adcgs_points points;
    for (size_t i = 0; i < sizeof good - 1; i++)
        for (int v = 0; v < 256; v += 3) {
            memcpy(bytes, good, sizeof good);
            bytes[i] = (char)v;
            adcgs_ply_parse(&points, (const uint8_t *)bytes, sizeof good - 1, "mutant", &error);
            adcgs_points_free(&points);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_variants),   cmocka_unit_test(test_damage),    cmocka_unit_test(test_too_many_properties),
        cmocka_unit_test(test_round_trip), cmocka_unit_test(test_mutations), cmocka_unit_test(test_npy),
        cmocka_unit_test(test_bad_npy),    cmocka_unit_test(test_far),       cmocka_unit_test(test_others),
    };
    int failed = cmocka_run_group_tests(tests, make_folder, remove_folder);
    failed += adcgs_test_points_draco();
    return failed;
}
