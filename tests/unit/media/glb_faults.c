/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Damaged and invalid GLB files of splats: each is refused with the fault named. */
#include "glb_files.h"
#include "second_sources.h"

/** A file of 4097 nodes is refused. */
static void test_too_many_nodes(void **state)
{
    const size_t room = 1 << 17;
    char *const text = malloc(room);
    uint8_t *const file = malloc(room), numbers[134];
    const char *const at = strstr(good, NODES);
    adcgs_splats s;
    size_t n = (size_t)(at - good);
    assert_true(text && file && at);
    memcpy(text, good, n);
    n += (size_t)snprintf(text + n, room - n, "\"nodes\":[{\"mesh\":1}");
    for (int i = 0; i < 4096; i++)
        n += (size_t)snprintf(text + n, room - n, ",{\"mesh\":1}");
    snprintf(text + n, room - n, "]%s", at + strlen(NODES));
    fill_numbers(numbers);
    const size_t bytes = make(file, text, numbers, sizeof numbers);
    expect_error(adcgs_splats_parse(&s, file, bytes, "n.glb", &error), ADCGS_ERR_UNSUPPORTED, "n.glb: ", "more than 4096 nodes");
    free(text);
    free(file);
}

static void expect_bad(const char *text, const uint8_t *numbers, size_t n, adcgs_status status, const char *what)
{
    uint8_t file[4096];
    adcgs_splats s;
    const size_t bytes = make(file, text, numbers, n);
    expect_error(adcgs_splats_parse(&s, file, bytes, "b.glb", &error), status, "b.glb: ", what);
    assert_true(!s.n && !s.block && !s.harmonics);
}

/** Changes of a good text, and the error that each causes. */
static const struct bad_text {
    const char *part, *instead;
    adcgs_status status;
    const char *what;
} bad_texts[] = {
    {"\"2.0\"", "\"1.0\"", ADCGS_ERR_DATA, "asset.version"},
    {"{\"asset\"", "[\"asset\"", ADCGS_ERR_DATA, "line 1: malformed JSON"},
    {"\"extensionsUsed\"", "\"extensionsRequired\":[\"EXT_odd\"],\"u\"", ADCGS_ERR_UNSUPPORTED, "extension EXT_odd"},
    {"\"byteLength\":134", "\"byteLength\":135", ADCGS_ERR_DATA, "a buffer of 135 bytes, but the binary chunk has 134"},
    {"\"byteLength\":134", "\"byteLength\":-1", ADCGS_ERR_DATA, "byteLength: expected a whole number"},
    {"\"byteLength\":134", "\"byteLength\":1e300", ADCGS_ERR_DATA, "byteLength: expected a whole number"},
    {"\"byteLength\":134", "\"byteLength\":9999999999999999", ADCGS_ERR_DATA, "byteLength: expected a whole number"},
    {"\"byteLength\":134", "\"byteLength\":134,\"uri\":\"a.bin\"", ADCGS_ERR_UNSUPPORTED, "a buffer outside of the file"},
    {"{\"buffer\":0", "{\"buffer\":1", ADCGS_ERR_DATA, "no buffers 1"},
    {"\"byteLength\":28", "\"byteLength\":27", ADCGS_ERR_DATA, "POSITION: an accessor extends beyond its view"},
    {"\"byteLength\":28", "\"byteLength\":1000", ADCGS_ERR_DATA, "POSITION: a view extends beyond its buffer"},
    {"\"byteStride\":16", "\"byteStride\":11", ADCGS_ERR_DATA, "byteStride"},
    {"\"byteStride\":16", "\"byteStride\":9007199254740992", ADCGS_ERR_DATA, "byteStride"},
    {"\"byteStride\":16", "\"byteStride\":16,\"extensions\":{}", ADCGS_ERR_UNSUPPORTED, "packed by another extension"},
    {"\"componentType\":5126", "\"componentType\":5125", ADCGS_ERR_DATA, "componentType"},
    {"\"count\":2", "\"count\":0", ADCGS_ERR_DATA, "POSITION: 0 elements, expected 1 to 16777216"},
    {"\"count\":2", "\"count\":16777217", ADCGS_ERR_DATA, "POSITION: 16777217 elements, expected 1 to"},
    {"\"count\":2", "\"count\":16777216", ADCGS_ERR_DATA, "POSITION: an accessor extends beyond its view"},
    {"\"count\":2", "\"count\":1", ADCGS_ERR_DATA, "ROTATION: 2 elements, expected 1"},
    {"\"VEC3\"", "\"VEC2\"", ADCGS_ERR_DATA, "POSITION: of type VEC2, expected VEC3"},
    {"\"VEC3\"", "\"VEC3\",\"sparse\":{}", ADCGS_ERR_UNSUPPORTED, "a sparse accessor"},
    {"\"bufferView\":0", "\"bufferView\":6", ADCGS_ERR_DATA, "POSITION: no bufferViews 6"},
    {"\"bufferView\":0,", "", ADCGS_ERR_DATA, "bufferView: expected a whole number"},
    {"\"POSITION\":0", "\"POSITION\":7", ADCGS_ERR_DATA, "POSITION: no accessors 7"},
    {NAME ":ROTATION", NAME ":ROT", ADCGS_ERR_DATA, "ROTATION: missing"},
    {NAME ":OPACITY", NAME ":O", ADCGS_ERR_DATA, "OPACITY: missing"},
    {NAME ":SH_DEGREE_0_COEF_0", NAME ":SH", ADCGS_ERR_DATA, "SH_DEGREE_0_COEF_0: missing"},
    {NAME ":SH_DEGREE_1_COEF_2", NAME ":SH", ADCGS_ERR_DATA, "SH_DEGREE_1_COEF_2: missing"},
    {"\"mode\":0,", "", ADCGS_ERR_DATA, "not 0 (points)"},
    {"\"extensions\":{\"" NAME "\"", "\"extensions\":{\"other\"", ADCGS_ERR_DATA, "no splats: no primitive with"},
    {"\"kernel\":\"ellipse\"", "\"kernel\":\"cube\"", ADCGS_ERR_UNSUPPORTED, "kernel: cube, expected ellipse"},
    {"srgb_rec709", "lin_rec709", ADCGS_ERR_UNSUPPORTED, "colorSpace: lin_rec709_display, expected srgb"},
    {"\"kernel\"", "\"extensions\":{\"EXT_packed\":{}},\"k\"", ADCGS_ERR_UNSUPPORTED, "by the extension EXT_packed"},
    {"\"scale\":[1,1,1]", "\"scale\":[1,0,1]", ADCGS_ERR_DATA, "a singular matrix"},
    {"\"scale\":[1,1,1]", "\"scale\":[1,1]", ADCGS_ERR_DATA, "a node's scale: expected 3 numbers"},
    {"\"scale\":[1,1,1]", "\"scale\":[1,\"a\",1]", ADCGS_ERR_DATA, "a node's scale: expected 3 numbers"},
    {"\"scale\":[1,1,1]", "\"scale\":[1e38,1e38,1e38]", ADCGS_ERR_DATA, "splat 0 is moved beyond"},
    {"\"rotation\":[0,0,0,1]", "\"rotation\":[0,0,0,0]", ADCGS_ERR_DATA, "a node's rotation: expected a quaternion"},
    {"{\"children\":[1]}", "{\"children\":[1],\"matrix\":[1]}", ADCGS_ERR_DATA, "a node's matrix: expected 16 numbers"},
    {"{\"children\":[1]}", "{\"children\":[1],\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]}", ADCGS_ERR_DATA, "a last row"},
    {NAME ":SH_DEGREE_1_COEF_0", NAME ":SH_DEGREE_4_COEF_0", ADCGS_ERR_UNSUPPORTED, "harmonics of degree 4"},
    {"{\"children\":[1]}", "{\"children\":[2]}", ADCGS_ERR_DATA, "a node lists a child that does not exist"},
    {"{\"mesh\":1,", "{\"children\":[0],\"mesh\":1,", ADCGS_ERR_DATA, "its own ancestor"},
    {"{\"primitives\":[", "{\"primitives\":[{\"mode\":0,\"extensions\":{\"" NAME "\":{}}},", ADCGS_ERR_DATA, "POSITION: missing"},
};

/** One part of the good text changed. */
static void test_bad_text(void **state)
{
    uint8_t file[4096], numbers[134];
    adcgs_splats s;
    fill_numbers(numbers);
    for (size_t i = 0; i < ADCGS_COUNTOF(bad_texts); i++) {
        const size_t bytes = change(file, bad_texts[i].part, bad_texts[i].instead);
        expect_error(adcgs_splats_parse(&s, file, bytes, "b.glb", &error), bad_texts[i].status, "b.glb: ", bad_texts[i].what);
        assert_true(!s.n && !s.block && !s.harmonics);
    }
    expect_bad(good, numbers, 0, ADCGS_ERR_DATA, "the binary chunk has 0");
}

static void test_bad_numbers(void **state)
{
    static const struct {
        size_t at;
        uint32_t value; /* a word */
        const char *what;
    } cases[] = {{4, 0x7f800000, "splat 0: POSITION: expected finite numbers"},
                 {24, 0x7fc00000, "splat 1: POSITION: expected finite numbers"},
                 {32, 0, "splat 0: " NAME ":ROTATION: expected a quaternion"},
                 {66, 0xff800000, "splat 0: " NAME ":SH_DEGREE_0_COEF_0: expected finite numbers"},
                 {126, 0x7f800000, "splat 1: " NAME ":SH_DEGREE_1_COEF_2: expected finite numbers"}};
    uint8_t numbers[134];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        fill_numbers(numbers);
        adcgs_store_le32(numbers + cases[i].at, cases[i].value);
        expect_bad(good, numbers, sizeof numbers, ADCGS_ERR_DATA, cases[i].what);
    }
    /* Floats instead of integers, which can be out of range. */
    static const float values[3][3] = {{1, -0.5f, 1}, {1e35f, 1, 1}, {1, 1, 1}};
    for (int k = 0; k < 3; k++) {
        adcgs_splats s = random_splats(1, 1.0, 0.0, 4);
        for (int a = 0; a < 3; a++)
            s.scale[a][0] = values[k][a];
        s.opacity[0] = 1.5f;
        expect_good(write_splats(&s, in("b.glb")));
        adcgs_splats_free(&s);
        expect_error(adcgs_splats_read(&s, in("b.glb"), &error), ADCGS_ERR_DATA,
                     "b.glb: ", k == 2 ? "OPACITY: expected a number from 0 to 1" : "SCALE: expected numbers from 0 to e^80");
    }
}

/** Headers and chunks; every cut; one byte at a time replaced. Any outcome is valid but a crash, and an error is one line. */
static void test_damage(void **state)
{
    static const struct {
        size_t at;
        uint8_t value;
        const char *what;
    } cases[] = {{4, 1, "the header of version 2"},
                 {8, 3, "bytes by its header"},
                 {11, 255, "bytes by its header"},
                 {14, 255, "a chunk of"},
                 {16, 'K', "the first chunk is not JSON"}};
    uint8_t numbers[134], file[4096], part[4096];
    adcgs_splats s;
    fill_numbers(numbers);
    const size_t bytes = make(file, good, numbers, sizeof numbers);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        memcpy(part, file, bytes + 1);
        if (cases[i].at == 8)
            part[9] = 0;
        part[cases[i].at] = cases[i].value;
        expect_error(adcgs_splats_parse(&s, part, bytes, "b.glb", &error), ADCGS_ERR_DATA, "b.glb: ", cases[i].what);
    }
    for (size_t cut = 0; cut < bytes; cut++) {
        uint8_t *const less = malloc(cut + 1);
        memcpy(less, file, cut);
        less[cut] = 0;
        for (int mend = 0; mend < (cut >= 12 ? 2 : 1); mend++) {
            if (mend)
                adcgs_store_le32(less + 8, (uint32_t)cut);
            expect_error(adcgs_splats_parse(&s, less, cut, "cut", &error), ADCGS_ERR_DATA, "cut: ", "");
        }
        free(less);
    }
    for (size_t i = 0; i < bytes; i++)
        for (int v = 0; v < 256; v += 5) {
            memcpy(part, file, bytes + 1);
            part[i] = (uint8_t)v;
            const adcgs_status status = adcgs_splats_parse(&s, part, bytes, "mutant", &error);
            assert_true(status == ADCGS_OK || !strncmp(error.text, "mutant: ", 8));
            adcgs_splats_free(&s);
        }
}

int adcgs_test_glb_faults(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bad_text),
        cmocka_unit_test(test_too_many_nodes),
        cmocka_unit_test(test_bad_numbers),
        cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests_name("glb faults", tests, make_folder, remove_folder);
}
