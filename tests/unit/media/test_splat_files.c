/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Files of splats as other programs write them: headers, values at the ends of their ranges, antialiasing. */
#include "outside_files.h"
#include "random_splats.h"

#include "media/splats/offset.h"
#include "scene/layouts/open.h"
#include "scene/splat_views.h"

#define PROPERTIES                                                                                         \
    "property float x\nproperty float y\nproperty float z\nproperty float f_dc_0\nproperty float f_dc_1\n" \
    "property float f_dc_2\nproperty float opacity\nproperty float scale_0\nproperty float scale_1\n"
#define TURN "property float rot_0\nproperty float rot_1\nproperty float rot_2\nproperty float rot_3\n"
#define HEAD(comments) \
    "ply\nformat ascii 1.0\n" comments "element vertex 1\n" PROPERTIES "property float scale_2\n" TURN "end_header\n"
#define ONE "1 2 3 0 0.5 -1 2 -4 -3 -2 1 0 0 0\n"

static adcgs_splats parse(const void *data, size_t bytes)
{
    adcgs_splats s;
    char *const copy = malloc(bytes + 1);
    assert_non_null(copy);
    memcpy(copy, data, bytes);
    copy[bytes] = 0;
    expect_good(adcgs_splats_parse(&s, (const uint8_t *)copy, bytes, "t.ply", &error));
    free(copy);
    return s;
}

/** Parses the single splat of a text. */
static adcgs_splats parse_text(const char *text)
{
    const adcgs_splats s = parse(text, strlen(text));
    assert_int_equal(s.n, 1);
    return s;
}

/** Expects the text's splat to be ONE. */
static void expect_one(const char *text)
{
    adcgs_splats s = parse_text(text), one = parse_text(HEAD("") ONE);
    for (int a = 0; a < 3; a++)
        assert_true(s.mean[a][0] == one.mean[a][0] && s.scale[a][0] == one.scale[a][0] && s.colour[a][0] == one.colour[a][0]);
    assert_true(s.opacity[0] == one.opacity[0] && s.rotation[0][0] == 1.0f);
    adcgs_splats_free(&s);
    adcgs_splats_free(&one);
}

/* ---- Headers ---- */

/** Comments may hold any bytes and be of any length. Headers may have blanks, and three kinds of line ends. */
static void test_headers(void **state)
{
    char text[8192], lines[8192];
    expect_one(HEAD("comment gepr\xc3\xbc\x66t: ja \xff\x01\x7f\n") ONE);
    snprintf(text, sizeof text,
             "ply\nformat ascii 1.0\ncomment %05000d\nobj_info %01500d\nelement vertex 1\n" PROPERTIES
             "property float scale_2\n" TURN "end_header\n" ONE,
             0, 0);
    expect_one(text);
    expect_one("ply\ncomment before the format\nformat ascii 1.0 \n\n element vertex 1 \t\n" PROPERTIES
               "  property   float   scale_2\n" TURN "end_header \n" ONE);
    for (int alone = 0; alone < 2; alone++) { /* CR LF, CR */
        size_t n = 0;
        for (const char *c = HEAD("comment x\n") ONE; *c; c++) {
            if (*c == '\n')
                lines[n++] = '\r';
            if (*c != '\n' || !alone)
                lines[n++] = *c;
        }
        lines[n] = 0;
        expect_one(lines);
    }
    /* Elements before the vertices, lists in them and among their properties, another order, other types. */
    expect_one("ply\nformat ascii 1.0\nelement a 1\nproperty list uchar int b\nelement c 2\nproperty float d\nelement e 0\n"
               "property float f\nelement g 1\nproperty list int float h\nelement i 1\nproperty char j\nelement vertex 1\n"
               "property double rot_0\nproperty list uchar float k\nproperty float rot_1\nproperty float rot_2\n"
               "property float64 rot_3\nproperty float scale_2\nproperty float scale_1\nproperty double scale_0\n"
               "property float32 opacity\nproperty double f_dc_2\nproperty float f_dc_1\nproperty uchar l\n"
               "property float f_dc_0\n"
               "property float z\nproperty double y\nproperty float x\nelement face 1\nproperty list uchar int m\nend_header\n"
               "2 7 7 1 1 2 0 -5 1 3 3e0 9 9 9 0 0 0 -2 -3 -4 2 -1 0.5 77 0 3 2 1\n0\n");
}

/** Binary data may begin with a line feed. */
static void test_cr_alone(void **state)
{
    static const float values[14] = {0.0f, 2.0f, 3.0f, 0.0f, 0.5f, -1.0f, 2.0f, -4.0f, -3.0f, -2.0f, 1.0f, 0.0f, 0.0f, 0.0f};
    uint8_t file[1024];
    size_t n = 0;
    for (const char *c = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" PROPERTIES "property float scale_2\n" TURN
                         "end_header\n";
         *c; c++)
        file[n++] = (uint8_t)(*c == '\n' ? '\r' : *c);
    for (int i = 0; i < 14; i++)
        adcgs_store_le32(file + n + 4 * (size_t)i, i ? adcgs_float_bits(values[i]) : 0x3f80000au);
    adcgs_splats s = parse(file, n + 56);
    assert_true(s.mean[0][0] == adcgs_bits_float(0x3f80000au) && s.mean[1][0] == 2.0f);
    adcgs_splats_free(&s);
}

/** Properties that the renderer does not use. */
static void test_many_properties(void **state)
{
    char text[32768];
    int n = snprintf(text, sizeof text, "ply\nformat ascii 1.0\nelement vertex 1\n" PROPERTIES "property float scale_2\n" TURN);
    for (int i = 0; i < 512; i++)
        n += snprintf(text + n, sizeof text - (size_t)n, "property float semantic_%d\n", i);
    n += snprintf(text + n, sizeof text - (size_t)n, "end_header\n%.*s", (int)strlen(ONE) - 1, ONE);
    for (int i = 0; i < 512; i++)
        n += snprintf(text + n, sizeof text - (size_t)n, " 7");
    expect_one(text);
}

/* ---- Values ---- */

static void test_infinities(void **state)
{
    adcgs_splats s = parse_text(HEAD("") "1 2 3 0 0 0 inf -inf -99 -3e38 1 0 0 0\n");
    assert_true(s.opacity[0] == 1.0f);
    for (int a = 0; a < 3; a++)
        assert_true(s.scale[a][0] > 1e-35f && s.scale[a][0] < 2e-35f);
    adcgs_splats_free(&s);
    s = parse_text(HEAD("") "1 2 3 0 0 0 -inf 0 0 0 1 0 0 0\n");
    assert_true(s.opacity[0] == 0.0f && s.scale[1][0] == 1.0f);
    adcgs_splats_free(&s);
}

/** 2DGS has two scales: the third axis is flat. Without rotations, or without opacities, the splats are no surfels. */
static void test_surfels(void **state)
{
    adcgs_splats s = parse_text("ply\nformat ascii 1.0\ncomment SplatRenderMode: mip\nelement vertex 1\n" PROPERTIES TURN
                                "end_header\n1 2 3 0 0.5 -1 2 -4 -3 1 0 0 0\n");
    assert_true(s.scale[0][0] == (float)exp(-4.0) && s.scale[1][0] == (float)exp(-3.0) && !s.antialiased);
    assert_true(s.scale[2][0] > 1e-35f && s.scale[2][0] < 2e-35f);
    adcgs_splats_free(&s);
    put_text("t.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" PROPERTIES "end_header\n1 2 3 0 0 0 0 0 0\n");
    expect_error(adcgs_splats_read(&s, in("t.ply"), &error), ADCGS_ERR_DATA, "t.ply", "no property scale_2");
}

/** Dynamic splats are not read as static ones. */
static void test_other_kinds(void **state)
{
    static const char *const others[] = {"trbf_center", "scale_t", "log_duration"};
    char text[1024];
    adcgs_splats s;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        snprintf(text, sizeof text,
                 "ply\nformat ascii 1.0\nelement vertex 1\n" PROPERTIES "property float scale_2\n" TURN
                 "property float %s\nend_header\n1 2 3 0 0 0 0 0 0 0 1 0 0 0 0.5\n",
                 others[i]);
        put_text("t.ply", text);
        expect_error(adcgs_splats_read(&s, in("t.ply"), &error), ADCGS_ERR_UNSUPPORTED, "t.ply", "splats over time");
    }
    put_text("t.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                      "property uchar red\nend_header\n1 2 3 4\n");
    expect_error(adcgs_splats_read(&s, in("t.ply"), &error), ADCGS_ERR_DATA, "t.ply",
                 "give a point cloud with a scene, by --points");
}

/** Harmonics above degree 3 are refused; coefficients of one channel would be read as those of another. */
static void test_degrees(void **state)
{
    static char text[8192];
    adcgs_splats s;
    int n = sprintf(text, "ply\nformat ascii 1.0\nelement vertex 1\n" PROPERTIES "property float scale_2\n" TURN);
    for (int i = 0; i < 72; i++)
        n += sprintf(text + n, "property float f_rest_%d\n", i);
    n += sprintf(text + n, "end_header\n1 2 3 0 0.5 -1 2 -4 -3 -2 1 0 0 0");
    for (int i = 0; i < 72; i++)
        n += sprintf(text + n, " 0.1");
    put_text("t.ply", text);
    expect_error(adcgs_splats_read(&s, in("t.ply"), &error), ADCGS_ERR_UNSUPPORTED, "t.ply: harmonics of degree 4", "f_rest_45");
}

/* ---- Far from the origin ---- */

/** A decoder's splats in earth-centred metres keep their shape in every format, and GLB and PLY store their place. */
static void test_far(void **state)
{
    static const char *const formats[] = {"f.ply", "f.glb", "f.spz"};
    static const double origin[3] = {4510731.25, -1512345.5, 4260123.125};
    adcgs_splats model = random_splats(500, 1.0, 0.0, 3), s, back;
    adcgs_primitives p;
    double nowhere[3];
    adcgs_splats_primitives(&model, &p);
    expect_good(adcgs_splats_take(&s, &p, origin, 10.0, NULL, "far", &error));
    assert_int_equal(s.n, model.n);
    for (int a = 0; a < 3; a++)
        assert_true(fabs(s.offset[a] - origin[a]) <= 4.0 && s.offset[a] == 8.0 * rint(s.offset[a] / 8.0));
    for (int k = 0; k < 3; k++) {
        size_t bytes;
        if (write_splats(&s, in(formats[k])) == ADCGS_ERR_UNSUPPORTED)
            continue;
        expect_good(adcgs_splats_read(&back, in(formats[k]), &error));
        for (uint32_t i = 0; i < s.n; i++)
            for (int a = 0; a < 3; a++) /* to a thousandth of the scene's scale and better */
                near(back.mean[a][i], (float)(origin[a] - s.offset[a] + 10.0 * (double)model.mean[a][i]), 1e-6,
                     k == 2 ? 1e-5 : 1e-6);
        for (int a = 0; a < 3; a++)
            assert_true(back.offset[a] == (k < 2 ? s.offset[a] : 0.0));
        adcgs_splats_free(&back);
        char *const text = (char *)load_file(formats[k], &bytes);
        assert_true(k || strstr(text, "\ncomment offset 4510728 -1512344 4260120\n"));
        free(text);
    }
    /* Near the origin nothing changes. */
    assert_int_equal(adcgs_offset_of(nowhere, (const double[3]){2500.0, 0.0, -1.0}, 10.0), 0);
    assert_true(nowhere[0] == 0.0 && !adcgs_offset_is(nowhere));
    adcgs_splats_free(&s);
    adcgs_splats_free(&model);
}

/** Positions in binary64 keep millimetres. The scene of such a file, or of one with an offset, has the file's position. */
static void test_far_files(void **state)
{
    static const double place[3] = {4510731.0, -1512345.0, 4260123.0};
    static const char head[] = "ply\nformat ascii 1.0\n%selement vertex 27\nproperty %s x\nproperty %s y\nproperty %s z\n";
    for (int is_double = 0; is_double < 2; is_double++) {
        static char text[16384];
        const char *const type = is_double ? "double" : "float", *properties = strstr(PROPERTIES, "property float f_dc_0");
        adcgs_splats s;
        adcgs_scene *scene;
        double centre[3] = {0.0, 0.0, 0.0};
        int n = sprintf(text, head, is_double ? "" : "comment offset 4510731 -1512345 4260123\n", type, type, type);
        n += sprintf(text + n, "%sproperty float scale_2\n" TURN "end_header\n", properties);
        for (int i = 0; i < 27; i++) {
            const double x[3] = {0.001 * (i % 3 - 1), 0.002 * (i / 3 % 3 - 1), 0.003 * (i / 9 - 1)};
            for (int a = 0; a < 3; a++)
                n += sprintf(text + n, "%.17g ", x[a] + (is_double ? place[a] : 0.0));
            n += sprintf(text + n, "0 0.5 -1 2 -9 -9 -9 1 0 0 0\n");
        }
        put_text("f.ply", text);
        expect_good(adcgs_splats_read(&s, in("f.ply"), &error));
        for (int i = 0; i < 27; i++)
            near((float)(s.offset[0] - place[0] + (double)s.mean[0][i]), (float)(0.001 * (i % 3 - 1)), 0.0, 2e-9);
        adcgs_splats_free(&s);
        expect_good(adcgs_scene_open(&scene, in("f.ply"), NULL, &error));
        const uint32_t views = scene->n_views[ADCGS_SPLIT_TRAIN];
        for (uint32_t i = 0; i < views; i++)
            for (int a = 0; a < 3; a++)
                centre[a] += scene->views[ADCGS_SPLIT_TRAIN][i].camera.cam_to_world[4 * a + 3] / views;
        for (int a = 0; a < 3; a++)
            assert_true(fabs(centre[a] - place[a]) < 0.1 && fabs(scene->points.position[13][a] - place[a]) < 1e-6);
        adcgs_scene_free(&scene);
    }
}

/* ---- Antialiasing ---- */

static void test_comments(void **state)
{
    static const struct {
        const char *text;
        int antialiased;
    } cases[] = {{HEAD("comment SplatRenderMode: mip\n") ONE, 1},
                 {HEAD("comment Exported from Brush\ncomment  SPLATRENDERMODE:  Mip  \ncomment SH degree: 0\n") ONE, 1},
                 {HEAD("comment antialiased 1\n") ONE, 1},
                 {HEAD("comment SplatRenderMode: mip-like\n") ONE, 0},
                 {HEAD("comment SplatRenderMode: default\n") ONE, 0},
                 {HEAD("comment antialiased 0\n") ONE, 0},
                 {HEAD("obj_info SplatRenderMode: mip\n") ONE, 0},
                 {HEAD("comment antialiased 1\ncomment SplatRenderMode: default\n") ONE, 0}, /* the last one counts */
                 {HEAD("comment SplatRenderMode:\n") ONE, 0},
                 {HEAD("") ONE, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        adcgs_splats s = parse_text(cases[i].text);
        assert_int_equal(s.antialiased, cases[i].antialiased);
        adcgs_splats_free(&s);
    }
}

/** The flag is written and read back; a decoder's splats are not antialiased. */
static void test_written(void **state)
{
    static const char *const formats[] = {"w.ply", "w.spz"};
    for (int k = 0; k < 2; k++)
        for (uint8_t is = 0; is < 2; is++) {
            adcgs_splats s = random_splats(20, 1.0, 0.0, 3), back;
            s.antialiased = is;
            if (write_splats(&s, in(formats[k])) == ADCGS_ERR_UNSUPPORTED) /* this build has no SPZ */
                skip();
            expect_good(adcgs_splats_read(&back, in(formats[k]), &error));
            assert_int_equal(back.antialiased, is);
            adcgs_splats_free(&s);
            adcgs_splats_free(&back);
        }
}

/** The value at the middle of an image with a white splat of opacity 0.9; its standard deviations are in pixels. */
static double middle(int antialiased, double across, double down, double distance)
{
    static const float black[3] = {0.0f, 0.0f, 0.0f};
    const adcgs_camera camera = {.width = 33,
                                 .height = 33,
                                 .fx = 100.0,
                                 .fy = 100.0,
                                 .cx = 16.5,
                                 .cy = 16.5,
                                 .near_plane = 0.01,
                                 .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    adcgs_splat_scene scene = {.radius = 1.0};
    adcgs_image image;
    expect_good(adcgs_splats_alloc(&scene.splats, 1, "one", &error));
    scene.splats.antialiased = (uint8_t)antialiased;
    scene.splats.mean[2][0] = (float)distance;
    scene.splats.opacity[0] = 0.9f;
    for (int a = 0; a < 3; a++) {
        scene.splats.scale[a][0] = (float)((a ? down : across) * distance / 100.0);
        scene.splats.colour[a][0] = 1.0f;
    }
    expect_good(adcgs_splat_scene_render(&scene, black, &camera, 0.0, &image, "one", &error));
    const double value = (double)image.data[3 * (16 * 33 + 16)];
    adcgs_image_free(&image);
    adcgs_splats_free(&scene.splats);
    return value;
}

/** The filter makes no splat stronger. The scale of opacity follows from sizes in pixels, so it differs between views. */
static void test_antialiased(void **state)
{
    static const double sizes[][2] = {{0.2, 0.2}, {1.0, 1.0}, {0.1, 5.0}, {20.0, 30.0}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int near_by = 0; near_by < 2; near_by++) {
            const double u = pow(sizes[i][0] * (1 + near_by), 2), v = pow(sizes[i][1] * (1 + near_by), 2);
            const double share = sqrt(u * v / ((u + 0.3) * (v + 0.3)));
            assert_float_equal(middle(0, sqrt(u), sqrt(v), 5.0 - 2.0 * near_by), 0.9, 2e-3);
            assert_float_equal(middle(1, sqrt(u), sqrt(v), 5.0 - 2.0 * near_by), 0.9 * share, 2e-3);
        }
}

/** The views of a file with the comment are fainter. */
static void test_scenes(void **state)
{
    adcgs_splats s = random_splats(300, 1.0, 0.0, 9);
    double sums[2] = {0.0, 0.0};
    for (uint8_t is = 0; is < 2; is++) {
        adcgs_scene *scene;
        float *rgb;
        s.antialiased = is;
        for (uint32_t i = 0; i < s.n && !is; i++)
            for (int a = 0; a < 3; a++)
                s.scale[a][i] *= 0.02f;
        expect_good(write_splats(&s, in("a.ply")));
        expect_good(adcgs_scene_open(&scene, in("a.ply"), NULL, &error));
        expect_good(adcgs_scene_image(scene, &scene->views[0][0], 1, &rgb, NULL, &error));
        for (size_t i = 0; i < 3 * 400 * 400; i++)
            sums[is] += (double)rgb[i];
        free(rgb);
        adcgs_scene_free(&scene);
    }
    assert_true(sums[1] > 0.0 && sums[1] < 0.6 * sums[0]);
    adcgs_splats_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_headers),    cmocka_unit_test(test_cr_alone), cmocka_unit_test(test_many_properties),
        cmocka_unit_test(test_infinities), cmocka_unit_test(test_surfels),  cmocka_unit_test(test_other_kinds),
        cmocka_unit_test(test_comments),   cmocka_unit_test(test_written),  cmocka_unit_test(test_antialiased),
        cmocka_unit_test(test_scenes),     cmocka_unit_test(test_far),      cmocka_unit_test(test_far_files),
        cmocka_unit_test(test_degrees),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
