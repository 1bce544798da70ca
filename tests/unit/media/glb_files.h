/* SPDX-License-Identifier: BSD-2-Clause */
/** \file GLB files of splats, made from a text and numbers. */
#ifndef ADCGS_TESTS_GLB_FILES_H
#define ADCGS_TESTS_GLB_FILES_H

#include "random_splats.h"

#define NAME "KHR_gaussian_splatting"
/** The nodes of the good text. */
#define NODES "\"nodes\":[{\"children\":[1]},{\"mesh\":1,\"scale\":[1,1,1],\"rotation\":[0,0,0,1]}]"

/** Builds a file from a text and numbers. Returns its number of bytes. */
static inline size_t make(uint8_t *to, const char *text, const uint8_t *numbers, size_t n)
{
    const size_t length = (strlen(text) + 3) / 4 * 4;
    memcpy(to, "glTF\2\0\0", 8);
    adcgs_store_le32(to + 8, (uint32_t)(28 + length + n));
    adcgs_store_le32(to + 12, (uint32_t)length);
    memcpy(to + 16, "JSON", 4);
    memset(to + 20, ' ', length);
    memcpy(to + 20, text, strlen(text));
    adcgs_store_le32(to + 20 + length, (uint32_t)n);
    memcpy(to + 24 + length, "BIN", 4);
    if (n)
        memcpy(to + 28 + length, numbers, n);
    to[28 + length + n] = 0;
    return 28 + length + n;
}

/*
 * Two splats: positions of floats in records of 16 bytes, rotations of int16, scales of uint8, opacities of uint16, colours of
 * floats; then coefficients of degree 1, all zero except the last.
 */
#define VIEW(at, bytes) "{\"buffer\":0,\"byteOffset\":" #at ",\"byteLength\":" #bytes "}"
#define ACCESSOR(view, kind, type) "{\"bufferView\":" #view ",\"componentType\":" #kind ",\"count\":2,\"type\":\"" type "\"}"
#define NORMAL(view, kind, type) \
    "{\"bufferView\":" #view ",\"componentType\":" #kind ",\"normalized\":true,\"count\":2,\"type\":\"" type "\"}"
static const char good[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"" NAME "\"],\"buffers\":[{\"byteLength\":134}],\"bufferViews\":["
    "{\"buffer\":0,\"byteLength\":28,\"byteStride\":16}," VIEW(28, 16) "," VIEW(44, 6) "," VIEW(50, 4) "," VIEW(54, 32) "," VIEW(
        86,
        48) "],\"accessors\":[" ACCESSOR(0, 5126,
                                         "VEC3") "," NORMAL(1, 5122,
                                                            "VEC4") "," NORMAL(2, 5121,
                                                                               "VEC3") "," NORMAL(3, 5123,
                                                                                                  "SCALAR") ",{\"bufferView\":4,"
                                                                                                            "\"byteOffset\":8,"
                                                                                                            "\"componentType\":"
                                                                                                            "5126,\"count\":2,"
                                                                                                            "\"type\":\"VEC3\"}"
                                                                                                            "," ACCESSOR(
                                                                                                                5, 5126,
                                                                                                                "VEC3") ",{"
                                                                                                                        "\"buffer"
                                                                                                                        "View\":"
                                                                                                                        "5,"
                                                                                                                        "\"byteOf"
                                                                                                                        "fset\":"
                                                                                                                        "24,"
                                                                                                                        "\"compon"
                                                                                                                        "entType"
                                                                                                                        "\":5126,"
                                                                                                                        "\"count"
                                                                                                                        "\":2,"
                                                                                                                        "\"type\""
                                                                                                                        ":\"VEC3"
                                                                                                                        "\"}],"
                                                                                                                        "\"nodes"
                                                                                                                        "\":[{"
                                                                                                                        "\"childr"
                                                                                                                        "en\":[1]"
                                                                                                                        "},{"
                                                                                                                        "\"mesh\""
                                                                                                                        ":1,"
                                                                                                                        "\"scale"
                                                                                                                        "\":[1,1,"
                                                                                                                        "1],"
                                                                                                                        "\"rotati"
                                                                                                                        "on\":[0,"
                                                                                                                        "0,0,1]}]"
                                                                                                                        ","
                                                                                                                        "\"meshes"
                                                                                                                        "\":[{"
                                                                                                                        "\"primit"
                                                                                                                        "ives\":["
                                                                                                                        "{"
                                                                                                                        "\"attrib"
                                                                                                                        "utes\":{"
                                                                                                                        "\"POSITI"
                                                                                                                        "ON\":7}}"
                                                                                                                        "]},{"
                                                                                                                        "\"primit"
                                                                                                                        "ives\":["
                                                                                                                        "{"
                                                                                                                        "\"attrib"
                                                                                                                        "utes\":{"
                                                                                                                        "\"POSITI"
                                                                                                                        "ON\":0,"
                                                                                                                        "\"" NAME
                                                                                                                        ":ROTATIO"
                                                                                                                        "N\":1,"
                                                                                                                        "\"" NAME
                                                                                                                        ":SCALE\""
                                                                                                                        ":2,"
                                                                                                                        "\"" NAME
                                                                                                                        ":OPACITY"
                                                                                                                        "\":3,"
                                                                                                                        "\"" NAME
                                                                                                                        ":SH_"
                                                                                                                        "DEGREE_"
                                                                                                                        "0_COEF_"
                                                                                                                        "0\":4,"
                                                                                                                        "\"" NAME
                                                                                                                        ":SH_"
                                                                                                                        "DEGREE_"
                                                                                                                        "1_COEF_"
                                                                                                                        "0\":5,"
                                                                                                                        "\"" NAME
                                                                                                                        ":SH_"
                                                                                                                        "DEGREE_"
                                                                                                                        "1_COEF_"
                                                                                                                        "1\":5,"
                                                                                                                        "\"" NAME
                                                                                                                        ":SH_"
                                                                                                                        "DEGREE_"
                                                                                                                        "1_COEF_"
                                                                                                                        "2\":6},"
                                                                                                                        "\"mode\""
                                                                                                                        ":0,"
                                                                                                                        "\"extens"
                                                                                                                        "ions\":{"
                                                                                                                        "\"" NAME
                                                                                                                        "\":{"
                                                                                                                        "\"kernel"
                                                                                                                        "\":"
                                                                                                                        "\"ellips"
                                                                                                                        "e\","
                                                                                                                        "\"colorS"
                                                                                                                        "pace\":"
                                                                                                                        "\"srgb_"
                                                                                                                        "rec709_"
                                                                                                                        "display"
                                                                                                                        "\"}}}]}]"
                                                                                                                        "}";

static inline void put_floats(uint8_t *to, const float *values, size_t n)
{
    for (size_t i = 0; i < n; i++)
        adcgs_store_le32(to + 4 * i, adcgs_float_bits(values[i]));
}

static inline void fill_numbers(uint8_t numbers[134])
{
    static const float first[3] = {1, 2, 3}, second[3] = {-4, 5, 6}, dc[6] = {0, 1, -1, 2, 0.5f, 0}, last[6] = {1, 2, 3, 4, 5, 6};
    static const uint8_t rest[] = {0,   0,   0,  0, 0,   0, 255, 127, /* rotations: w is 1 */
                                   0,   128, 0,  0, 0,   0, 1,   0,   /* x is -1, rounded twice */
                                   255, 51,  1,  0, 128, 2,           /* scales */
                                   255, 255, 51, 51};                 /* opacities: 1, 0.2 */
    memset(numbers, 0, 134);
    put_floats(numbers, first, 3);
    put_floats(numbers + 16, second, 3);
    memcpy(numbers + 28, rest, sizeof rest);
    put_floats(numbers + 62, dc, 6);
    put_floats(numbers + 110, last, 6);
}

/** With harmonics of all degrees. */
static inline void make_splats(adcgs_splats *s)
{
    uint64_t seed = 9;
    *s = random_splats(40, 1.0, 0.0, 5);
    s->degree = 3;
    s->harmonics = malloc(40 * 45 * sizeof *s->harmonics);
    assert_non_null(s->harmonics);
    for (int i = 0; i < 40 * 45; i++)
        s->harmonics[i] = any(&seed, -1.0, 1.0);
}

/** The good text with the first occurrence of a part replaced. */
static inline size_t change(uint8_t file[4096], const char *part, const char *instead)
{
    uint8_t numbers[134];
    char text[4096];
    const char *const at = strstr(good, part);
    assert_non_null(at);
    fill_numbers(numbers);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - good), good, instead, at + strlen(part));
    return make(file, text, numbers, sizeof numbers);
}

#endif
